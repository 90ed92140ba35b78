//! Fronts of domains in several pieces: components, and regions that constraints separate.

use std::collections::BTreeSet;
use trigrade::background::Background;
use trigrade::domain::validate::{Plc, PlcInside, PlcSegment, validate};
use trigrade::domain::{Domain, Region};
use trigrade::front::{FrontError, FrontMesh, FrontOptions, Order, Rules, Start, advance};
use trigrade::improve::ImproveOptions;
use trigrade::mesh::Mesh;
use trigrade::mesher::{Gradation, MeshError, Meshed, Options, Unobserved, mesh_domain, mesh_plc};
use trigrade::point::Point2;
use trigrade::predicates::{Sign, orient2d};
use trigrade::size::{Expression, SizeField};
use trigrade::triangulation::{Across, TriangleId};

const THREADS: [usize; 4] = [1, 2, 3, 7];

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started").install(work)
}

/// A rectangle with so many segments a side, counterclockwise from its lower left corner.
fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], segments: u32) -> Vec<[f64; 2]> {
    let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    let side = |i: usize| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 4]);
        (0..segments).map(move |k| {
            let t = f64::from(k) / f64::from(segments);
            [ax + t * (bx - ax), ay + t * (by - ay)]
        })
    };
    (0..4).flat_map(side).collect()
}

/// Rectangles of different sizes, one inside the hole of another, none on top of another. No edge is so
/// coarse that it would be split off: that looks at distances, across gaps too.
fn rings() -> Vec<Vec<[f64; 2]>> {
    vec![
        rectangle([0.25, 0.0], [1.0, 1.0], 18),
        rectangle([-1.0, -0.9], [-0.25, 0.9], 23),
        rectangle([-0.8, -0.6], [-0.4, 0.7], 17),
        rectangle([-0.7, -0.3], [-0.5, 0.2], 7),
        rectangle([0.3, -0.9], [0.9, -0.2], 12),
    ]
}

fn pieces() -> Domain {
    Domain::of_rings(&rings())
}

/// A square cut by constraints into three regions with markers.
fn regions() -> Plc {
    let ring = rectangle([0.0, 0.0], [1.0, 1.0], 16);
    let count = ring.len() as u32;
    let segment = |vertices, in_loop| PlcSegment { vertices, marker: 1, in_loop };
    let mut segments: Vec<PlcSegment> =
        (0..count).map(|i| segment([i, (i + 1) % count], true)).collect();
    // From the bottom to the top at 5/16 and at 11/16, in sixteen pieces each.
    let mut points: Vec<Point2> = ring.into_iter().map(Point2::from).collect();
    for (x, low, high) in [(5.0 / 16.0, 5, 43), (11.0 / 16.0, 11, 37)] {
        let mut before = low;
        for k in 1..16 {
            points.push(Point2::new(x, f64::from(k) / 16.0));
            let here = points.len() as u32 - 1;
            segments.push(segment([before, here], false));
            before = here;
        }
        segments.push(segment([before, high], false));
    }
    let region = |x: f64, marker: i32| Region { seed: Point2::new(x, 0.5), marker, area_max: None };
    let vertex_of = (0..points.len() as u32).collect();
    let regions = vec![region(0.1, 7), region(0.5, 8), region(0.9, 9)];
    let inside = PlcInside::EvenOdd;
    Plc { points, point_markers: Vec::new(), segments, inside, regions, vertex_of }
}

/// The bits of a mesh.
fn bits(mesh: &Mesh) -> (Vec<[u64; 2]>, Vec<[u32; 3]>, Vec<i32>) {
    let points = mesh.points.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]).collect();
    (points, mesh.triangles.clone(), mesh.regions.clone())
}

/// Triangles by their corners' bits, from the smallest corner, whatever their numbers.
fn shapes(mesh: &Mesh) -> BTreeSet<[[u64; 2]; 3]> {
    let shape = |t: &[u32; 3]| {
        let corners = t.map(|v| mesh.points[v as usize]).map(|p| [p.x.to_bits(), p.y.to_bits()]);
        let first = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
        [0, 1, 2].map(|i| corners[(first + i) % 3])
    };
    mesh.triangles.iter().map(shape).collect()
}

fn uniform() -> Options {
    Options {
        gradation: Gradation::Uniform,
        spacing: Some(0.05),
        improve: ImproveOptions::NONE,
        ..Options::default()
    }
}

fn mesh_of_rings(rings: &[Vec<[f64; 2]>], options: &Options) -> Meshed {
    mesh_domain(&Domain::of_rings(rings), options, &mut Unobserved).expect("it can be meshed")
}

// spec: F10
#[test]
fn a_piece_has_the_mesh_that_it_has_alone() {
    let rings = rings();
    let together = mesh_of_rings(&rings, &uniform()).mesh;
    let alone = [vec![0], vec![1, 2], vec![3], vec![4]];
    // The scale comes from the largest coordinate: a far triangle keeps it the same.
    let mut all = BTreeSet::new();
    for members in alone {
        let far = vec![[0.95, -0.99], [1.0, -0.99], [1.0, -0.94]];
        let mut some: Vec<Vec<[f64; 2]>> = members.iter().map(|&i| rings[i].clone()).collect();
        some.push(far);
        let mesh = mesh_of_rings(&some, &uniform()).mesh;
        all.extend(shapes(&mesh).into_iter().filter(|shape| !shape.iter().all(is_far)));
    }
    assert!(all.len() > 1000, "{}", all.len());
    assert!(shapes(&together) == all, "a piece is not what it is alone");
}

fn is_far(&[x, y]: &[u64; 2]) -> bool {
    f64::from_bits(x) >= 0.9 && f64::from_bits(y) <= -0.9
}

// spec: F10 F5
#[test]
fn the_order_of_the_loops_does_not_matter() {
    let (mut rings, options) = (rings(), uniform());
    let straight = shapes(&mesh_of_rings(&rings, &options).mesh);
    rings.reverse();
    assert_eq!(shapes(&mesh_of_rings(&rings, &options).mesh), straight);
    rings[1].rotate_left(5);
    assert_eq!(shapes(&mesh_of_rings(&rings, &options).mesh), straight);
}

// spec: F11 K6
#[test]
fn pieces_have_the_same_bytes_at_any_number_of_threads() {
    let graded = Options::default();
    for options in [uniform(), graded, Options { order: Order::Shortest, ..uniform() }] {
        let runs = THREADS.map(|threads| {
            with_threads(threads, || {
                let apart = mesh_domain(&pieces(), &options, &mut Unobserved).expect("pieces");
                let joined = mesh_plc(regions(), &options, &mut Unobserved).expect("regions");
                (bits(&apart.mesh), bits(&joined.mesh), apart.front, joined.front)
            })
        });
        assert!(runs[0].1.0.len() > 200, "the regions are meshed, not only triangulated");
        for (threads, run) in THREADS.iter().zip(&runs) {
            assert!(*run == runs[0], "{threads} threads");
        }
    }
}

// spec: F10
#[test]
fn regions_meet_at_their_constraints_only() {
    let meshed = mesh_plc(regions(), &uniform(), &mut Unobserved).expect("regions");
    let mesh = meshed.mesh;
    for (t, &region) in mesh.triangles.iter().zip(&mesh.regions) {
        let xs = t.map(|v| mesh.points[v as usize].x);
        let [low, high] = match region {
            7 => [0.0, 5.0 / 16.0],
            8 => [5.0 / 16.0, 11.0 / 16.0],
            9 => [11.0 / 16.0, 1.0],
            other => panic!("no region has the marker {other}"),
        };
        assert!(xs.iter().all(|x| (low..=high).contains(x)), "{xs:?} in region {region}");
    }
    for marker in [7, 8, 9] {
        assert!(mesh.regions.iter().filter(|&&r| r == marker).count() > 100);
    }
}

/// The start of a front on a domain with a uniform spacing.
fn start(domain: &Domain, spacing: f64) -> Start {
    let plc = validate(domain).expect("sound");
    let background = Background::new(&plc).expect("sound");
    let (region, edges) = background.open_region();
    let edges = edges.iter().map(|e| e.half_edge).collect();
    let spacing = vec![spacing; background.points.len()];
    Start { points: background.points, region, edges, spacing }
}

const FRONT: FrontOptions = FrontOptions {
    order: Order::Depth,
    rules: Rules::Scored,
    clamp: 2.0,
    vertices_max: 100_000,
    quantum: None,
};

fn lay(threads: usize, options: FrontOptions) -> Result<FrontMesh, FrontError> {
    let field = SizeField::Uniform(0.05);
    with_threads(threads, || advance(start(&pieces(), 0.05), &field, options, &mut |_| true))
}

// spec: F1 F2 F10
#[test]
fn the_pieces_together_are_conforming() {
    let start = start(&pieces(), 0.05);
    let FrontMesh { points, mesh, spacing, stats } = lay(2, FRONT).expect("laid");
    assert_eq!(points.len(), spacing.len());
    assert_eq!(points[..start.points.len()], start.points, "the domain's points come first");
    assert_eq!((points.len() - start.points.len()) as u64, stats.inserted);
    assert_eq!(mesh.live_count() as u64, stats.inserted + stats.accepted_existing);
    let mut borders = BTreeSet::new();
    for t in mesh.triangles() {
        let [a, b, c] = mesh.corners(t).map(|v| points[v.index()]);
        assert_eq!(orient2d(a, b, c), Sign::Positive);
        for e in t.half_edges() {
            match mesh.across(e) {
                Across::Twin(twin) => {
                    assert_eq!(mesh.twin(twin), Some(e));
                    assert_eq!(mesh.origin(twin), mesh.dest(e));
                }
                Across::Border(i) => {
                    let front = start.edges[i as usize];
                    let ends = [start.region.origin(front), start.region.dest(front)];
                    assert_eq!([mesh.origin(e), mesh.dest(e)], ends);
                    assert!(borders.insert(i), "front edge {i} twice");
                }
            }
        }
    }
    assert_eq!(borders.len(), start.edges.len());
}

// spec: F10
#[test]
fn triangles_are_piece_by_piece_in_the_order_of_their_smallest_edges() {
    let FrontMesh { points, mesh, .. } = lay(3, FRONT).expect("laid");
    // The frame at the left has the smallest edge, then the rectangle in it, then the two at the right.
    let piece = |t: TriangleId| {
        let [x, y] = [mesh.corners(t)[0], mesh.corners(t)[1]].iter().fold([0.0, 0.0], |sum, v| {
            let p = points[v.index()];
            [sum[0] + 0.5 * p.x, sum[1] + 0.5 * p.y]
        });
        let is_inner = (-0.7..=-0.5).contains(&x) && (-0.3..=0.2).contains(&y);
        match (x < 0.0, is_inner, y < -0.1) {
            (true, false, _) => 0,
            (true, true, _) => 1,
            (false, _, false) => 2,
            (false, _, true) => 3,
        }
    };
    let order: Vec<u32> = mesh.triangles().map(piece).collect();
    assert!(order.is_sorted(), "the pieces are mixed");
    assert_eq!(order.last(), Some(&3));
}

// spec: !F6 F11
#[test]
fn the_budget_counts_all_pieces_whatever_the_threads() {
    let needed = lay(1, FRONT).expect("laid").stats.inserted as usize;
    for threads in THREADS {
        assert!(lay(threads, FrontOptions { vertices_max: needed, ..FRONT }).is_ok());
        let short = FrontOptions { vertices_max: needed - 1, ..FRONT };
        assert_eq!(lay(threads, short).err(), Some(FrontError::Budget(needed - 1)));
    }
}

// spec: !F11
#[test]
fn an_observer_stops_all_pieces() {
    let field = SizeField::Uniform(0.05);
    let mut heard = 0;
    let stopped = advance(start(&pieces(), 0.05), &field, FRONT, &mut |triangles| {
        heard = triangles;
        false
    });
    assert_eq!(stopped.err(), Some(FrontError::Stopped));
    assert!(heard > 0);
}

// spec: !F11
#[test]
fn which_fault_of_a_function_is_named_does_not_depend_on_the_threads() {
    let expression = Expression::parse("0.1 - x * x").expect("a function");
    let gradation = Gradation::Expression(expression);
    let options = Options { gradation, ..Options::default() };
    let faults = THREADS.map(|threads| {
        let run = with_threads(threads, || mesh_domain(&pieces(), &options, &mut Unobserved));
        match run {
            Err(MeshError::BadSpacing { at, value }) => (at, value.to_bits()),
            other => panic!("a negative spacing is refused, got {:?}", other.map(|m| m.front)),
        }
    });
    assert!(faults.iter().all(|fault| *fault == faults[0]), "{faults:?}");
}
