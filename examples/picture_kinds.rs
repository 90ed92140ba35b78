//! Draws one picture of each kind: panels side by side, a close-up, findings, a broken mesh.
//!
//! ```text
//! cargo run --example picture_kinds -- OUT_DIR
//! ```

use std::path::{Path, PathBuf};
use trigrade::draw::{self, Background, Highlight, Layer, Options, Palette, Panel, View, Viewer};
use trigrade::mesh::{MarkedEdge, MeshData};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = PathBuf::from(std::env::args().nth(1).unwrap_or("target/pictures".into()));
    std::fs::create_dir_all(&directory)?;
    side_by_side(&directory)?;
    findings(&directory)?;
    palettes(&directory)?;
    viewers(&directory)
}

fn viewers(directory: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let (mesh, coarse) = (ring(96, 40, 2.0), ring(12, 3, 1.0));
    let spacing: Vec<f64> = coarse.points.iter().map(|p| 0.3 * p[0].hypot(p[1])).collect();
    let background = Some(Background { mesh: &coarse, spacing: &spacing });
    let highlights = [
        Highlight {
            label: "C7: triangle 100 is a needle <b>".into(),
            triangles: vec![100, 101],
            ..Highlight::default()
        },
        Highlight {
            label: "C9: vertex 5 is used twice".into(),
            vertices: vec![5],
            ..Highlight::default()
        },
        Highlight {
            label: "C4: edge 960-961 is lost".into(),
            edges: vec![[960, 961]],
            ..Highlight::default()
        },
    ];
    let layer = Layer::radius_ratio(&mesh);
    let layers = [Layer { name: "my own values".into(), ..layer }];
    let viewer = Viewer {
        highlights: &highlights,
        background,
        layers: &layers,
        ..Viewer::new("ring.msh", &mesh)
    };
    std::fs::write(directory.join("ring.html"), draw::html(&viewer)?)?;
    let torus = torus(120, 60);
    std::fs::write(directory.join("torus.html"), draw::html(&Viewer::new("torus", &torus))?)?;
    Ok(())
}

/// A torus in space.
fn torus(around: u32, through: u32) -> MeshData {
    let mut mesh = MeshData::default();
    let turn = |k: u32, n: u32| f64::from(k) / f64::from(n) * std::f64::consts::TAU;
    for i in 0..around {
        for j in 0..through {
            let (u, v) = (turn(i, around), turn(j, through));
            let r = 2.0 + 0.8 * v.cos();
            mesh.points.push([r * u.cos(), r * u.sin(), 0.8 * v.sin()]);
        }
    }
    for i in 0..around {
        for j in 0..through {
            let at = |i: u32, j: u32| (i % around) * through + j % through;
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn side_by_side(directory: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let (coarse, fine) = (ring(24, 6, 1.0), ring(96, 40, 3.0));
    let (a, b) = (Layer::radius_ratio(&coarse), Layer::radius_ratio(&fine));
    let view = View { x0: 0.1, y0: -0.15, x1: 0.4, y1: 0.15 };
    let mut whole = Panel::new(&fine, "graded rings").coloured(&b);
    whole.outline = Some(view);
    let close_up = Panel::new(&fine, "close-up of the hole").coloured(&b).cropped(view);
    let panels = [Panel::new(&coarse, "even rings").coloured(&a), whole, close_up];
    save(directory, "side-by-side", &panels, &options("Two meshes of a ring"))
}

fn findings(directory: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut mesh = ring(48, 16, 1.0);
    mesh.edges = (0..48)
        .map(|k| MarkedEdge { vertices: [8 * 48 + k, 8 * 48 + (k + 1) % 48], marker: 7 })
        .collect();
    mesh.triangles.remove(700);
    mesh.triangles.push([0, 1, u32::MAX]);
    let highlights = [
        Highlight {
            label: "missing triangle".into(),
            edges: vec![[360, 361]],
            ..Highlight::default()
        },
        Highlight {
            label: "triangle 100 is needle-like <R/2r = 3>".into(),
            triangles: vec![100, 101],
            ..Highlight::default()
        },
        Highlight {
            label: "vertex 5 is used twice".into(),
            vertices: vec![5],
            ..Highlight::default()
        },
    ];
    let layer = Layer::radius_ratio(&mesh);
    let mut panel = Panel::new(&mesh, "ring.msh").coloured(&layer);
    panel.highlights = &highlights;
    let mut plain = Panel::new(&mesh, "no colours, coarse background");
    let background = ring(12, 3, 1.0);
    plain.background = Some(&background);
    save(directory, "findings", &[panel, plain], &options("Findings"))
}

fn palettes(directory: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mesh = ring(60, 20, 2.0);
    let layer = Layer::radius_ratio(&mesh);
    for palette in [Palette::YlGnBu, Palette::Viridis, Palette::Cividis, Palette::Grey] {
        let options = Options { palette, width: 500.0, ..Options::default() };
        let panels = [Panel::new(&mesh, format!("{palette:?}")).coloured(&layer)];
        save(directory, &format!("palette-{palette:?}"), &panels, &options)?;
    }
    Ok(())
}

fn options(title: &str) -> Options {
    Options { title: title.into(), width: 1200.0, ..Options::default() }
}

fn save(
    directory: &Path,
    name: &str,
    panels: &[Panel<'_>],
    options: &Options,
) -> Result<(), Box<dyn std::error::Error>> {
    std::fs::write(directory.join(format!("{name}.svg")), draw::svg(panels, options)?)?;
    std::fs::write(directory.join(format!("{name}.png")), draw::png(panels, options)?)?;
    Ok(())
}

/// Rings of `around` quadrilaterals, each cut in two, between radius 0.2 and 1; `power` > 1 packs
/// them towards the inside.
fn ring(around: u32, layers: u32, power: f64) -> MeshData {
    let mut mesh = MeshData::default();
    for i in 0..=layers {
        let radius = 0.2 + 0.8 * (f64::from(i) / f64::from(layers)).powf(power);
        for k in 0..around {
            let angle = f64::from(k) / f64::from(around) * std::f64::consts::TAU;
            mesh.points.push([radius * angle.cos(), radius * angle.sin(), 0.0]);
        }
    }
    for i in 0..layers {
        for k in 0..around {
            let [a, b] = [i * around + k, i * around + (k + 1) % around];
            let (c, d) = (a + around, b + around);
            mesh.triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    mesh
}
