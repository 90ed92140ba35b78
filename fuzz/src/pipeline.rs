//! Target: the whole pipeline with `check` as judge. A domain is refused with faults, or meshed,
//! and then the mesh is what the checker demands.

use super::decode::Decoder;
use trigrade::check::{CheckOptions, check};
use trigrade::domain::{Domain, Loop, LoopRole, Segment};
use trigrade::front::{Order, Rules};
use trigrade::improve::ImproveOptions;
use trigrade::mesh::MeshData;
use trigrade::mesher::{AreaMax, Gradation, MeshError, Method, Options, Unobserved, mesh_domain};
use trigrade::point::Point2;
use trigrade::size::Density;

/// One input.
pub fn run(bytes: &[u8]) {
    let mut decoder = Decoder::new(bytes);
    let options = options(&mut decoder);
    let domain = domain(&mut decoder);
    match mesh_domain(&domain, &options, &mut Unobserved) {
        Ok(meshed) => {
            let report =
                check(&MeshData::from(&meshed.mesh), Some(&domain), &CheckOptions::default());
            assert!(
                report.passed(),
                "{:?} {:?}\n{options:?}\n{domain:?}",
                report.findings,
                report.could_not_run
            );
        }
        Err(MeshError::Invalid(faults)) => assert!(!faults.is_empty(), "{domain:?}"),
        Err(MeshError::Front(error)) => panic!("{error}\n{options:?}\n{domain:?}"),
        // Refinement has no prediction of angles: its limit may come late.
        Err(
            MeshError::Background(_)
            | MeshError::TooMany { .. }
            | MeshError::Refine(_)
            | MeshError::Split(_)
            | MeshError::Grid(_)
            | MeshError::Options(_),
        ) => {}
        Err(
            error @ (MeshError::Gradation(_) | MeshError::Table(_) | MeshError::BadSpacing { .. }),
        ) => panic!("nothing here is of the user's making: {error}\n{options:?}"),
    }
}

/// Options of every kind.
pub(crate) fn options(decoder: &mut Decoder<'_>) -> Options {
    let mut pick = |count| decoder.below(count);
    Options {
        method: [
            Method::Graded,
            Method::Graded,
            Method::Afm,
            Method::Direct,
            Method::DelaunayInitial,
            Method::Delaunay,
        ][pick(6) as usize],
        density: [Density::BoundaryEdges, Density::AllEdges][pick(2) as usize],
        gradation: [Gradation::Growth, Gradation::Mean, Gradation::Third, Gradation::Uniform]
            [pick(4) as usize]
            .clone(),
        limit_growth: pick(4) == 0,
        improve: ImproveOptions::level([1, 0, 2][pick(3) as usize]),
        order: [Order::Depth, Order::Shortest][pick(2) as usize],
        rules: [Rules::Scored, Rules::Hard][pick(2) as usize],
        growth: [0.25, 0.1, 1.0][pick(3) as usize],
        area_max: [AreaMax::Field, AreaMax::Unbounded, AreaMax::Constant(1.0)][pick(3) as usize],
        angle_min_deg: [0.0, 20.0, 33.0][pick(3) as usize],
        split_boundary: pick(3) == 0,
        // More would only be slow.
        triangles_max: 3000,
        ..Options::default()
    }
}

/// Up to four loops around different centres, each around its centre so that it is often simple;
/// constraints and isolated points; all of it scaled by a power of two and moved.
fn domain(decoder: &mut Decoder<'_>) -> Domain {
    let scale = libm::ldexp(1.0, [0, 0, 0, 40, -40, 300, -300, 900][decoder.below(8) as usize]);
    let shift = [0.0, 0.0, 1e9, 0.1][decoder.below(4) as usize];
    let mut domain = Domain::new(Vec::new());
    for _ in 0..=decoder.below(3) {
        let centre = [decoder.below(24), decoder.below(24)].map(f64::from);
        let ring = ring(decoder, centre);
        let first = domain.points.len() as u32;
        domain.points.extend(ring);
        let vertices = (first..domain.points.len() as u32).collect();
        domain.loops.push(Loop::new(vertices, 1, LoopRole::Any));
    }
    for _ in 0..decoder.below(3) {
        let first = domain.points.len() as u32;
        for _ in 0..2 {
            let [x, y] = [decoder.below(32), decoder.below(32)].map(f64::from);
            domain.points.push(Point2::new(x, y));
        }
        domain.segments.push(Segment { vertices: [first, first + 1], marker: 2 });
    }
    for _ in 0..decoder.below(3) {
        let [x, y] = [decoder.below(32), decoder.below(32)].map(f64::from);
        domain.points.push(Point2::new(x, y));
    }
    for point in &mut domain.points {
        *point = Point2::new(scale * (point.x + shift), scale * (point.y + shift));
    }
    domain
}

/// Points around `centre`, on a lattice or not, in the order of their angles.
fn ring(decoder: &mut Decoder<'_>, centre: [f64; 2]) -> Vec<Point2> {
    let radius = [4.0, 8.0, 16.0][decoder.below(3) as usize];
    let on_lattice = decoder.below(2) == 0;
    let count = 3 + decoder.below(10);
    let place = |i: u32, decoder: &mut Decoder<'_>| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let r = radius * (0.25 + 0.75 * f64::from(decoder.byte()) / 255.0);
        let [x, y] = [centre[0] + r * libm::cos(angle), centre[1] + r * libm::sin(angle)];
        if on_lattice { Point2::new(x.round(), y.round()) } else { Point2::new(x, y) }
    };
    (0..count).map(|i| place(i, decoder)).collect()
}
