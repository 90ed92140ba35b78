//! A surface in space, seen in perspective and shaded.
//!
//! Triangles are painted from the farthest to the nearest, by the depth of their centres; ties go by
//! index. Faces are lit by the cosine between their normal and the light, either side alike, so that
//! a surface that faces the wrong way can still be seen.

use super::{DrawError, Options};
use crate::mesh::MeshData;
use crate::vector::{Vector, add, along, cross, distance, dot, scale, sub, unit};
use std::fmt::Write as _;

/// From the middle of the surface to the eye.
const TOWARDS_EYE: Vector = [0.52, -0.74, 0.43];
/// From the surface to the light.
const TOWARDS_LIGHT: Vector = [0.15, -0.55, 0.82];
/// The eye is this many radii away from the middle.
const AWAY: f64 = 4.0;
/// Colour of a face in full light, and the part of it that a face has without any.
const FACE: [f64; 3] = [158.0, 202.0, 225.0];
const AMBIENT: f64 = 0.35;
/// Room for the title, and around the picture, in CSS pixels.
const MARGIN: f64 = 24.0;

/// Whether a mesh is a surface in space: its finite points differ in z.
#[must_use]
pub fn is_in_space(mesh: &MeshData) -> bool {
    let mut heights = mesh.points.iter().map(|p| p[2]).filter(|z| z.is_finite());
    heights.next().is_some_and(|first| heights.any(|z| z != first))
}

/// Where things are on the page.
struct Camera {
    eye: Vector,
    right: Vector,
    up: Vector,
    forward: Vector,
    scale: f64,
    middle: [f64; 2],
}

impl Camera {
    /// Looks at all finite points, in a square of this side.
    fn on(mesh: &MeshData, side: f64) -> Self {
        let finite = || mesh.points.iter().filter(|p| p.iter().all(|x| x.is_finite()));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in finite() {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let middle = scale(0.5, add(low, high));
        let radius = finite().map(|&p| distance(p, middle)).fold(0.0, f64::max);
        let towards = unit(TOWARDS_EYE).expect("a direction");
        let forward = scale(-1.0, towards);
        let right = unit(cross(forward, [0.0, 0.0, 1.0])).expect("the eye is not above");
        let up = cross(right, forward);
        let eye = along(middle, AWAY * radius, towards);
        // The ball around the surface touches the rim of the picture.
        let scale = 0.5 * side * (AWAY * AWAY - 1.0).sqrt();
        Self { eye, right, up, forward, scale, middle: [0.5 * side; 2] }
    }

    /// Place on the page and depth.
    fn see(&self, p: Vector) -> ([f64; 2], f64) {
        let arm = sub(p, self.eye);
        let depth = dot(arm, self.forward);
        let [x, y] = [self.right, self.up].map(|axis| self.scale * dot(arm, axis) / depth);
        ([self.middle[0] + x, self.middle[1] - y], depth)
    }
}

/// A triangle on the page.
struct Face {
    at: [[f64; 2]; 3],
    depth: f64,
    light: f64,
}

/// Draws a surface as an SVG document, and gives its height.
///
/// # Errors
/// [`DrawError::PageSize`] for a page that cannot be drawn.
///
/// # Complexity
/// O(n log n) in triangles.
pub fn perspective(
    mesh: &MeshData,
    title: &str,
    options: &Options,
) -> Result<(String, f64), DrawError> {
    super::check_input(&[super::Panel::new(mesh, title)], options)?;
    let side = options.width - 2.0 * MARGIN;
    let height = options.width + if title.is_empty() { 0.0 } else { MARGIN };
    let faces = faces(mesh, &Camera::on(mesh, side));
    let top = height - side - MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{height}\" viewBox=\"0 0 {w} {height}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        w = options.width
    );
    if !title.is_empty() {
        let title = title.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"{MARGIN}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"14\">{title}</text>"
        );
    }
    // Lines as wide as the triangles allow.
    let width =
        if options.wireframe { (0.02 * side / (faces.len() as f64).sqrt()).min(0.6) } else { 0.0 };
    let _ = writeln!(
        svg,
        "<g transform=\"translate({MARGIN} {top})\" stroke-width=\"{width:.3}\" stroke-linejoin=\"round\">"
    );
    for face in &faces {
        let [r, g, b] = FACE.map(|channel| (channel * face.light).round() as u8);
        let [p, q, s] = face.at;
        let line = if options.wireframe {
            "#08306b".to_owned()
        } else {
            format!("#{r:02x}{g:02x}{b:02x}")
        };
        let _ = writeln!(
            svg,
            "<path d=\"M{:.2} {:.2}L{:.2} {:.2}L{:.2} {:.2}Z\" fill=\"#{r:02x}{g:02x}{b:02x}\" stroke=\"{line}\"/>",
            p[0], p[1], q[0], q[1], s[0], s[1]
        );
    }
    svg.push_str("</g>\n</svg>\n");
    Ok((svg, height))
}

/// The triangles that can be drawn, farthest first.
fn faces(mesh: &MeshData, camera: &Camera) -> Vec<Face> {
    let light = unit(TOWARDS_LIGHT).expect("a direction");
    let face = |corners: &[u32; 3]| {
        let points = corners.map(|v| mesh.points.get(v as usize).copied());
        let [a, b, c] = [points[0]?, points[1]?, points[2]?];
        let normal = unit(cross(sub(b, a), sub(c, a)))?;
        let seen = [a, b, c].map(|p| camera.see(p));
        let shine = AMBIENT + (1.0 - AMBIENT) * dot(normal, light).abs();
        let at = seen.map(|(at, _)| at);
        let depth = seen.iter().map(|(_, depth)| depth).sum::<f64>();
        (depth.is_finite() && at.iter().flatten().all(|x| x.is_finite())).then_some(Face {
            at,
            depth,
            light: shine.min(1.0),
        })
    };
    let mut faces: Vec<Face> = mesh.triangles.iter().filter_map(face).collect();
    faces.sort_by(|f, g| g.depth.total_cmp(&f.depth));
    faces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> MeshData {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        MeshData { points, triangles, ..MeshData::default() }
    }

    // spec: S12
    #[test]
    fn faces_are_painted_from_far_to_near_within_the_page() {
        let mesh = tetrahedron();
        let (svg, height) = perspective(&mesh, "a < b", &Options::default()).expect("drawn");
        assert_eq!(svg.matches("<path").count(), 4);
        assert!(svg.contains("a &lt; b"));
        let faces = faces(&mesh, &Camera::on(&mesh, 100.0));
        assert!(faces.windows(2).all(|pair| pair[0].depth >= pair[1].depth));
        assert!(faces.iter().flat_map(|f| f.at).flatten().all(|x| (0.0..=100.0).contains(&x)));
        assert!(height > 900.0);
        assert_eq!(perspective(&mesh, "a < b", &Options::default()).expect("drawn").0, svg);
    }

    // spec: S12
    #[test]
    fn broken_triangles_are_left_out() {
        let mut mesh = tetrahedron();
        mesh.triangles[0] = [0, 1, 99];
        mesh.points[3][2] = f64::NAN;
        let (svg, _) = perspective(&mesh, "", &Options::default()).expect("drawn");
        assert_eq!(svg.matches("<path").count(), 0);
        let wide = Options { width: 1e9, ..Options::default() };
        assert!(perspective(&mesh, "", &wide).is_err());
    }

    // spec: S12
    #[test]
    fn a_mesh_with_one_height_is_no_surface_in_space() {
        let mut mesh = tetrahedron();
        assert!(is_in_space(&mesh));
        mesh.points.iter_mut().for_each(|p| p[2] = 5.0);
        assert!(!is_in_space(&mesh));
        assert!(!is_in_space(&MeshData::default()));
    }
}
