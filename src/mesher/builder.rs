//! The mesher's options, said one by one.

use super::{
    AreaMax, Count, Gradation, MeshError, Meshed, Method, Observer, Options, Unobserved,
    mesh_domain,
};
use crate::domain::Domain;
use crate::improve::ImproveOptions;
use crate::size::{Density, SizeSource, SpacingTable};
use std::sync::Arc;

/// A mesher: what is wanted is said first, then domains are meshed.
///
/// ```
/// use trigrade::domain::Domain;
/// use trigrade::mesh::MeshData;
/// use trigrade::mesher::Mesher;
///
/// // A square with ten edges a side, and spacing 0.02 at its centre.
/// let side = |k: u32| f64::from(k) / 10.0;
/// let mut ring: Vec<[f64; 2]> = (0..10).map(|k| [side(k), 0.0]).collect();
/// ring.extend((0..10).map(|k| [1.0, side(k)]));
/// ring.extend((0..10).map(|k| [1.0 - side(k), 1.0]));
/// ring.extend((0..10).map(|k| [0.0, 1.0 - side(k)]));
/// let square = Domain::of_rings(&[ring]);
///
/// let meshed = Mesher::new().growth(0.2).spacing_at_point([0.5, 0.5], 0.02).mesh(&square)?;
/// assert!(meshed.mesh.triangles.len() > 300);
///
/// // Nobody needs to believe it.
/// let report = trigrade::check::check(&MeshData::from(&meshed.mesh), Some(&square), &Default::default());
/// assert!(report.passed());
/// # Ok::<(), trigrade::mesher::MeshError>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "a mesher does nothing until it is asked to mesh"]
pub struct Mesher {
    options: Options,
}

impl From<Options> for Mesher {
    fn from(options: Options) -> Self {
        Self { options }
    }
}

impl Mesher {
    /// Graded triangulation with spacings that grow by 0.25, as [`Options::default`].
    pub fn new() -> Self {
        Self::default()
    }

    /// How triangles are laid.
    pub fn method(mut self, method: Method) -> Self {
        self.options.method = method;
        self
    }

    /// How spacing spreads from the boundary.
    pub fn gradation(mut self, gradation: Gradation) -> Self {
        self.options.gradation = gradation;
        self
    }

    /// Which edges make the spacing at a boundary node.
    pub fn density(mut self, density: Density) -> Self {
        self.options.density = density;
        self
    }

    /// Largest slope of the spacing, from 0 to 10.
    pub fn growth(mut self, slope: f64) -> Self {
        self.options.growth = slope;
        self
    }

    /// Largest spacing anywhere.
    pub fn spacing(mut self, length: f64) -> Self {
        self.options.spacing = Some(length);
        self
    }

    /// Spacing at the edges with a marker, growing from there; may be said again for others.
    pub fn spacing_at_marker(mut self, marker: i32, length: f64) -> Self {
        self.options.spacing_at.push((marker, length));
        self
    }

    /// Spacing at a point, growing from there; may be said again for others.
    pub fn spacing_at_point(self, [x, y]: [f64; 2], length: f64) -> Self {
        self.source(SizeSource::point([x, y].into(), length, 0.0))
    }

    /// A point, disc or line with a spacing of its own; may be said again for others.
    pub fn source(mut self, source: SizeSource) -> Self {
        self.options.sources.push(source);
        self
    }

    /// A background mesh with a spacing at each node.
    pub fn size_field(mut self, table: SpacingTable) -> Self {
        self.options.table = Some(Arc::new(table));
        self
    }

    /// About so many triangles: the field becomes coarser or finer until they come out.
    pub fn target(mut self, triangles: usize) -> Self {
        self.options.count = Count::Target(triangles);
        self
    }

    /// Refuse, before any work, to make more triangles than this.
    pub fn triangles_max(mut self, triangles: usize) -> Self {
        self.options.triangles_max = triangles;
        self
    }

    /// Effort after the front, from 0 to 3; higher ones count as 3.
    pub fn effort(mut self, level: u8) -> Self {
        self.options.improve = ImproveOptions::level(level.min(3));
        self
    }

    /// No improvement after the front.
    pub fn unimproved(mut self) -> Self {
        self.options.improve = ImproveOptions::NONE;
        self
    }

    /// Delaunay refinement in place of the front: to a least angle in degrees, up to 34, and areas.
    pub fn refined(mut self, angle_min_deg: f64, area_max: AreaMax) -> Self {
        self.options.method = Method::Delaunay;
        (self.options.angle_min_deg, self.options.area_max) = (angle_min_deg, area_max);
        self
    }

    /// Allow new points on the boundary and on constraints.
    pub fn split_boundary(mut self) -> Self {
        self.options.split_boundary = true;
        self
    }

    /// What has been said so far.
    #[must_use]
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Meshes a domain. See [`mesh_domain`].
    ///
    /// # Errors
    /// [`MeshError`]: an invalid domain with all its faults, options out of range, a limit.
    pub fn mesh(&self, domain: &Domain) -> Result<Meshed, MeshError> {
        self.mesh_observed(domain, &mut Unobserved)
    }

    /// [`Mesher::mesh`] with someone watching, who may stop it.
    ///
    /// # Errors
    /// As [`Mesher::mesh`].
    pub fn mesh_observed(
        &self,
        domain: &Domain,
        observer: &mut dyn Observer,
    ) -> Result<Meshed, MeshError> {
        mesh_domain(domain, &self.options, observer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::naca::naca0012;

    // spec: H6
    #[test]
    fn what_is_said_is_what_the_options_hold() {
        let mesher = Mesher::new()
            .gradation(Gradation::Mean)
            .density(Density::AllEdges)
            .growth(0.3)
            .spacing(2.0)
            .spacing_at_marker(3, 0.1)
            .spacing_at_point([1.0, 2.0], 0.2)
            .triangles_max(5000)
            .target(900)
            .split_boundary()
            .unimproved();
        let expected = Options {
            gradation: Gradation::Mean,
            density: Density::AllEdges,
            growth: 0.3,
            spacing: Some(2.0),
            spacing_at: vec![(3, 0.1)],
            sources: vec![SizeSource::point([1.0, 2.0].into(), 0.2, 0.0)],
            triangles_max: 5000,
            count: Count::Target(900),
            split_boundary: true,
            improve: ImproveOptions::NONE,
            ..Options::default()
        };
        assert_eq!(mesher.options(), &expected);
        assert_eq!(Mesher::new().options(), &Options::default());
        assert_eq!(Mesher::from(expected.clone()).options(), &expected);
        let refined = Mesher::new().refined(25.0, AreaMax::Unbounded);
        assert_eq!(refined.options().method, Method::Delaunay);
        assert_eq!(Mesher::new().effort(9).options().improve, ImproveOptions::level(3));
    }

    #[test]
    fn the_builder_makes_the_mesh_of_its_options_and_refuses_what_they_refuse() {
        let domain = naca0012();
        let built = Mesher::new().effort(0).mesh(&domain).expect("sound");
        let options = Options { improve: ImproveOptions::level(0), ..Options::default() };
        let plain = mesh_domain(&domain, &options, &mut Unobserved).expect("sound");
        assert_eq!(built.mesh, plain.mesh);
        for wrong in [Mesher::new().growth(-1.0), Mesher::new().spacing(f64::NAN)] {
            assert!(matches!(wrong.mesh(&domain), Err(MeshError::Options(_))));
        }
        let small = Mesher::new().triangles_max(10).mesh(&domain);
        assert!(matches!(small, Err(MeshError::TooMany { .. })));
    }
}
