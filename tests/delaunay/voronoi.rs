//! Voronoi tessellations: their shape, their rounding, and what clipping leaves of them.

use crate::clouds;
use num_rational::BigRational;
use num_traits::Zero;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use trigrade::delaunay::{Options, delaunay};
use trigrade::domain::validate::{Plc, validate};
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Segment};
use trigrade::format::{MeshForm, ReadOptions, read_mesh, voronoi_json, voronoi_obj};
use trigrade::point::Point2;
use trigrade::predicates::{Sign, incircle, nearer, orient2d};
use trigrade::voronoi::{ClipBox, Clipped, DomainClipError, Voronoi, voronoi};

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

/// The tessellation, after checks of everything that holds for any sites.
fn tessellation(points: &[Point2]) -> Voronoi {
    let result = voronoi(points, false).expect("finite points");
    assert_eq!(voronoi(points, true).as_ref(), Ok(&result), "threads do not matter");
    let cells = points.len() - result.repeated.len();
    if cells > 0 {
        let euler = result.vertices.len() as i64 - result.edges.len() as i64 + cells as i64;
        assert_eq!(euler, 1, "V - E + F = 1 without the vertex at infinity");
    }
    let mut sides = vec![0; result.edges.len()];
    for site in 0..points.len() as u32 {
        let around: Vec<_> = result.cell(site).collect();
        assert!(around.is_empty() || result.has_cell(site));
        for (i, side) in around.iter().enumerate() {
            sides[side.edge as usize] += 1;
            let next = &around[(i + 1) % around.len()];
            assert!(around.len() == 1 || side.ends[1] == next.ends[0], "sides follow each other");
            let back = result.cell(side.neighbour).find(|other| other.edge == side.edge);
            let back = back.expect("an edge has two sides");
            assert_eq!((back.neighbour, back.ends), (site, [side.ends[1], side.ends[0]]));
        }
    }
    assert!(sides.iter().all(|&count| count == 2));
    assert!(result.vertices.iter().all(|v| v.is_finite()));
    result
}

// spec: V1 V2 V5
#[test]
fn hard_clouds_have_tessellations() {
    for n in [1, 2, 3, 4, 5, 20, 400] {
        for (_, points) in clouds::all(n) {
            tessellation(&points);
        }
    }
}

// spec: V1
#[test]
fn neighbours_are_delaunay_neighbours_but_across_a_common_circle() {
    for (name, points) in clouds::all(150) {
        let cells = tessellation(&points);
        let triangles = delaunay(&points, Options::default()).unwrap().triangles();
        let mut beside: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for t in &triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                beside.entry([a.min(b), a.max(b)]).or_default().push(t[(i + 2) % 3]);
            }
        }
        let at = |v: u32| points[v as usize];
        let has_length = |([a, b], apexes): (&[u32; 2], &Vec<u32>)| match apexes[..] {
            [c, d] => incircle(at(*a), at(*b), at(c), at(d)) != Sign::Zero,
            _ => true,
        };
        let expected: BTreeSet<[u32; 2]> =
            beside.iter().filter(|&entry| has_length(entry)).map(|entry| *entry.0).collect();
        let found: BTreeSet<[u32; 2]> = cells
            .edges
            .iter()
            .map(|e| [e.sites[0].min(e.sites[1]), e.sites[0].max(e.sites[1])])
            .collect();
        assert_eq!(found.len(), cells.edges.len(), "{name}: an edge twice");
        if !triangles.is_empty() {
            assert_eq!(found, expected, "{name}");
        }
    }
}

// spec: V2
#[test]
fn vertices_are_the_empty_circles_each_once() {
    for (name, points) in clouds::all(40) {
        let cells = tessellation(&points);
        let circle = |v: usize| {
            let [a, b, c] = cells.circles[v].map(|site| points[site as usize]);
            if orient2d(a, b, c) == Sign::Positive { [a, b, c] } else { [a, c, b] }
        };
        for v in 0..cells.vertices.len() {
            let [a, b, c] = circle(v);
            assert!(points.iter().all(|&d| incircle(a, b, c, d) != Sign::Positive), "{name}");
            for u in 0..v {
                let same = circle(u).iter().all(|&d| incircle(a, b, c, d) == Sign::Zero);
                assert!(!same, "{name}: one circle, two vertices");
            }
        }
    }
}

// spec: V2
#[test]
fn cocircular_sites_share_one_vertex() {
    let on = |&(x, y): &(i32, i32)| x * x + y * y == 25 * 25;
    let all = (-25..=25).flat_map(|x| (-25..=25).map(move |y| (x, y)));
    let mut sites: Vec<_> = all.filter(on).map(|(x, y)| p(f64::from(x), f64::from(y))).collect();
    assert_eq!(sites.len(), 20);
    let cells = tessellation(&sites);
    assert_eq!((cells.vertices.len(), cells.edges.len()), (1, 20));
    assert_eq!(cells.vertices[0], p(0.0, 0.0));
    sites.push(p(0.0, 0.0));
    let cells = tessellation(&sites);
    assert_eq!((cells.vertices.len(), cells.edges.len()), (20, 40));
    assert!(!cells.is_unbounded(20) && cells.cell(20).count() == 20);
}

// spec: V3
#[test]
fn vertices_are_rounded_to_nearest() {
    let cells = tessellation(&[p(0.1, 0.2), p(0.7, 0.3), p(0.4, 0.9)]);
    // In rational arithmetic, of the doubles that stand for these decimals.
    let exact = |v: f64| BigRational::from_float(v).unwrap();
    let [x, y] = [cells.vertices[0].x, cells.vertices[0].y];
    let distance = |q: Point2, x: f64, y: f64| {
        let (dx, dy) = (exact(q.x) - exact(x), exact(q.y) - exact(y));
        &dx * &dx + &dy * &dy
    };
    let spread = |x: f64, y: f64| {
        let all = cells.sites.iter().map(|&q| distance(q, x, y)).collect::<Vec<_>>();
        all.iter().max().unwrap() - all.iter().min().unwrap()
    };
    for (other_x, other_y) in
        [(x.next_up(), y), (x.next_down(), y), (x, y.next_up()), (x, y.next_down())]
    {
        assert!(spread(x, y) < spread(other_x, other_y));
    }
}

// spec: V4
#[test]
fn few_sites_and_sites_on_a_line_have_cells() {
    let none = tessellation(&[]);
    assert!(none.sites.is_empty() && none.edges.is_empty() && none.vertices.is_empty());
    let lone = tessellation(&[p(3.0, 4.0)]);
    assert!(lone.is_unbounded(0) && lone.cell(0).next().is_none() && lone.edges.is_empty());
    let two = tessellation(&[p(0.0, 0.0), p(2.0, 0.0)]);
    assert_eq!(two.edges.len(), 1);
    let edge = two.edges[0];
    assert_eq!((edge.sites, edge.ends), ([0, 1], [None, None]));
    assert_eq!(two.direction(&edge), [0.0, 2.0], "the first site is on the left of it");
    let line = tessellation(&clouds::line(7));
    assert_eq!((line.vertices.len(), line.edges.len()), (0, 6));
    assert!(line.edges.iter().all(|edge| edge.ends == [None, None]));
    let repeated = tessellation(&[p(1.0, 1.0), p(0.0, 0.0), p(1.0, 1.0)]);
    assert_eq!(repeated.repeated, [[2, 0]]);
    assert!(!repeated.has_cell(2) && repeated.has_cell(0));
    assert_eq!(repeated.edges.len(), 1);
}

// spec: V4 !V4
#[test]
fn sites_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(voronoi(&[p(0.0, 0.0), p(bad, 1.0)], false).is_err());
    }
}

// spec: V5
#[test]
fn rays_run_square_to_their_sites_with_the_first_on_their_left() {
    let cells = tessellation(&clouds::uniform(60, 5));
    let mut rays = 0;
    for edge in cells.edges.iter().filter(|edge| edge.ends.contains(&None)) {
        let [a, b] = edge.sites.map(|site| cells.sites[site as usize]);
        let [dx, dy] = cells.direction(edge);
        let along = dx * (b.x - a.x) + dy * (b.y - a.y);
        assert!(along.abs() <= 1e-15 && dx * (a.y - b.y) - dy * (a.x - b.x) > 0.0);
        rays += 1;
    }
    let hull = (0..60).filter(|&site| cells.is_unbounded(site)).count();
    assert_eq!(rays, hull, "as many rays as unbounded cells");
}

/// Twice the exact area of all pieces.
fn doubled_area(clipped: &Clipped) -> BigRational {
    let exact = |v: f64| BigRational::from_float(v).expect("finite");
    let mut sum = BigRational::zero();
    for ring in clipped.pieces.iter().flat_map(|piece| &piece.rings) {
        for i in 0..ring.len() {
            let [a, b] = [ring[i], ring[(i + 1) % ring.len()]].map(|v| clipped.points[v as usize]);
            sum += exact(a.x) * exact(b.y) - exact(a.y) * exact(b.x);
        }
    }
    sum
}

fn doubled_box(bounds: ClipBox) -> BigRational {
    let [min, max] = bounds.corners();
    let side = |low: f64, high: f64| {
        BigRational::from_float(high).unwrap() - BigRational::from_float(low).unwrap()
    };
    side(min.x, max.x) * side(min.y, max.y) * BigRational::from_float(2.0).unwrap()
}

/// Clips, and checks that the pieces cover the box: each directed edge once, its reverse once unless
/// it is on the box, and the exact areas add up.
fn clipped(cells: &Voronoi, bounds: ClipBox) -> Clipped {
    let clipped = cells.clip_to_box(bounds);
    assert_eq!(doubled_area(&clipped), doubled_box(bounds));
    let [min, max] = bounds.corners();
    let mut edges = BTreeSet::new();
    for piece in &clipped.pieces {
        assert_eq!(piece.rings.len(), 1, "a convex cell in a box has one ring");
        let ring = &piece.rings[0];
        for i in 0..ring.len() {
            assert!(edges.insert([ring[i], ring[(i + 1) % ring.len()]]), "an edge twice");
        }
    }
    let places: BTreeSet<_> = clipped.points.iter().map(|q| q.key()).collect();
    assert_eq!(places.len(), clipped.points.len(), "corners are different");
    for &[a, b] in &edges {
        let [q, r] = [a, b].map(|v| clipped.points[v as usize]);
        let along = |v: f64, f: fn(Point2) -> f64| f(q) == v && f(r) == v;
        let on_box = along(min.x, |p| p.x)
            || along(max.x, |p| p.x)
            || along(min.y, |p| p.y)
            || along(max.y, |p| p.y);
        assert!(on_box || edges.contains(&[b, a]), "an edge inside has two sides");
    }
    clipped
}

// spec: V6
#[test]
fn clipped_cells_cover_the_box() {
    for n in [1, 2, 3, 5, 30, 200] {
        for (name, points) in clouds::all(n) {
            if name == "extremes" {
                continue;
            }
            let cells = tessellation(&points);
            let around = ClipBox::around(&points).expect("there are points");
            clipped(&cells, around);
            let [min, max] = around.corners();
            // One that cuts through the points, and one beside them.
            let middle = p(min.x / 2.0 + max.x / 2.0, min.y / 2.0 + max.y / 2.0);
            if let Some(quarter) = ClipBox::new(min, middle) {
                clipped(&cells, quarter);
            }
            let beside = ClipBox::new(p(max.x + 1.0, min.y), p(max.x + 2.0, min.y + 1.0));
            clipped(&cells, beside.expect("a box"));
        }
    }
}

// spec: V6
#[test]
fn a_box_through_vertices_and_along_edges_is_no_special_case() {
    let sites = clouds::grid(5, 1.0);
    let cells = tessellation(&sites);
    for (low, high) in [(0.5, 3.5), (-0.5, 4.5), (1.0, 3.0), (0.5, 1.5), (1.5, 1.75), (-9.0, -0.5)]
    {
        let bounds = ClipBox::new(p(low, low), p(high, high)).unwrap();
        let clipped = clipped(&cells, bounds);
        for piece in &clipped.pieces {
            assert!(clipped.area(piece) > 0.0, "{low} {high}: {piece:?}");
        }
    }
    let diagonal = tessellation(&[p(0.0, 0.0), p(2.0, 2.0), p(0.0, 2.0), p(2.0, 0.0), p(5.0, 5.0)]);
    // The bisectors run through corners of this box.
    clipped(&diagonal, ClipBox::new(p(0.0, 0.0), p(2.0, 2.0)).unwrap());
    clipped(&diagonal, ClipBox::new(p(1.0, 1.0), p(6.0, 6.0)).unwrap());
}

// spec: V6
#[test]
fn a_grid_has_square_cells() {
    let sites = clouds::grid(6, 1.0);
    let bounds = ClipBox::new(p(-0.5, -0.5), p(5.5, 5.5)).unwrap();
    let clipped = clipped(&tessellation(&sites), bounds);
    assert_eq!((clipped.pieces.len(), clipped.points.len()), (36, 49));
    for piece in &clipped.pieces {
        assert_eq!(piece.rings[0].len(), 4);
        let at = sites[piece.site as usize];
        for &corner in &piece.rings[0] {
            let corner = clipped.points[corner as usize];
            assert_eq!([(corner.x - at.x).abs(), (corner.y - at.y).abs()], [0.5, 0.5]);
        }
    }
}

// spec: V6
#[test]
fn sites_are_in_their_cells_and_cells_are_nearest_their_sites() {
    for (name, points) in clouds::all(200) {
        if !["uniform", "clusters", "grid", "grid times 0.1", "spiral"].contains(&name) {
            continue;
        }
        let cells = tessellation(&points);
        let clipped = clipped(&cells, ClipBox::around(&points).unwrap());
        assert_eq!(clipped.pieces.len(), points.len(), "{name}");
        for piece in &clipped.pieces {
            let ring: Vec<Point2> =
                piece.rings[0].iter().map(|&i| clipped.points[i as usize]).collect();
            let site = points[piece.site as usize];
            for i in 0..ring.len() {
                let side = orient2d(ring[i], ring[(i + 1) % ring.len()], site);
                assert_eq!(side, Sign::Positive, "{name} {}", piece.site);
            }
            let n = ring.len() as f64;
            let middle = p(
                ring.iter().map(|q| q.x).sum::<f64>() / n,
                ring.iter().map(|q| q.y).sum::<f64>() / n,
            );
            let is_nearest =
                points.iter().all(|&other| nearer(middle, site, other) != Sign::Negative);
            assert!(is_nearest, "{name} {}", piece.site);
        }
    }
}

// spec: V6
#[test]
fn few_sites_share_a_box() {
    let bounds = ClipBox::new(p(0.0, 0.0), p(4.0, 2.0)).unwrap();
    let areas = |sites: &[Point2]| {
        let clipped = clipped(&tessellation(sites), bounds);
        clipped.pieces.iter().map(|piece| (piece.site, clipped.area(piece))).collect::<Vec<_>>()
    };
    assert_eq!(areas(&[p(9.0, 9.0)]), [(0, 8.0)]);
    assert_eq!(areas(&[p(1.0, 1.0), p(3.0, 1.0)]), [(0, 4.0), (1, 4.0)]);
    assert_eq!(areas(&[p(1.0, 1.0), p(99.0, 1.0)]), [(0, 8.0)]);
    assert_eq!(areas(&[p(-5.0, 0.0), p(1.0, 0.0), p(3.0, 0.0), p(9.0, 0.0)]), [(1, 4.0), (2, 4.0)]);
    assert_eq!(tessellation(&[]).clip_to_box(bounds), Clipped::default());
}

#[test]
fn boxes_are_read_from_four_numbers() {
    assert_eq!("0,-1, 2.5,1e3".parse(), Ok(ClipBox::new(p(0.0, -1.0), p(2.5, 1e3)).unwrap()));
    for wrong in ["", "1,2,3", "0,0,0,1", "1,0,0,1", "0,0,nan,1", "0,0,inf,1", "a,b,c,d"] {
        assert!(wrong.parse::<ClipBox>().unwrap_err().contains("XMIN"), "{wrong}");
    }
    assert_eq!(ClipBox::around(&[]), None);
    assert!(ClipBox::around(&[p(f64::MAX, f64::MIN)]).is_some());
}

fn domain(loops: &[&[[f64; 2]]]) -> Plc {
    let mut domain = Domain::new(Vec::new());
    for (i, corners) in loops.iter().enumerate() {
        let first = domain.points.len() as u32;
        domain.points.extend(corners.iter().map(|&c| Point2::from(c)));
        let vertices = (first..domain.points.len() as u32).collect();
        domain.loops.push(Loop::new(vertices, i as i32, LoopRole::Any));
    }
    validate(&domain).expect("sound")
}

fn pieces_of(clipped: &Clipped) -> Vec<(u32, usize, f64)> {
    let told =
        |piece: &trigrade::voronoi::Piece| (piece.site, piece.rings.len(), clipped.area(piece));
    clipped.pieces.iter().map(told).collect()
}

// spec: V7
#[test]
fn a_cell_may_fall_in_pieces_and_have_holes() {
    let arch: &[[f64; 2]] = &[
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 3.0],
        [3.0, 3.0],
        [3.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
    ];
    let arch = domain(&[arch]);
    let sites = [p(2.0, -1.0), p(2.0, 5.0)];
    let clipped = tessellation(&sites).clip_to_domain(&arch).unwrap();
    // The bisector is y = 2: two legs below, the rest above.
    assert_eq!(pieces_of(&clipped), [(0, 1, 2.0), (0, 1, 2.0), (1, 1, 6.0)]);
    let frame: &[[f64; 2]] = &[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let hole: &[[f64; 2]] = &[[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 6.0]];
    let frame = domain(&[frame, hole]);
    let clipped = tessellation(&[p(4.0, 4.0)]).clip_to_domain(&frame).unwrap();
    assert_eq!(pieces_of(&clipped), [(0, 2, 48.0)]);
    let clipped = tessellation(&[p(4.0, 4.0), p(400.0, 4.0)]).clip_to_domain(&frame).unwrap();
    assert_eq!(pieces_of(&clipped), [(0, 2, 48.0)], "far sites have no part");
    let none = tessellation(&[]).clip_to_domain(&frame);
    assert_eq!(none, Err(DomainClipError::NoSites));
}

// spec: V7
#[test]
fn pieces_cover_the_domain_exactly() {
    let outer: &[[f64; 2]] = &[
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 0.75],
        [0.5, 0.75],
        [0.5, 0.5],
        [0.25, 0.5],
        [0.25, 1.0],
        [0.0, 1.0],
    ];
    let hole: &[[f64; 2]] = &[[0.5, 0.125], [0.75, 0.125], [0.75, 0.25], [0.5, 0.25]];
    let plc = domain(&[outer, hole]);
    let area = 2.0 * (0.25 * 1.0 + 0.25 * 0.5 + 0.5 * 0.75 - 0.25 * 0.125);
    for (name, points) in clouds::all(300) {
        if name == "extremes" {
            continue;
        }
        let clipped = tessellation(&points).clip_to_domain(&plc).expect(name);
        // Sides along the axes keep their place when they are cut, so the sum is exact.
        let sum = doubled_area(&clipped);
        assert_eq!(sum, BigRational::from_float(area).unwrap(), "{name}");
    }
}

// spec: V7
#[test]
fn pieces_belong_to_the_nearest_site() {
    let star: Vec<[f64; 2]> = (0..14)
        .map(|i| {
            let (r, angle) =
                (if i % 2 == 0 { 1.0 } else { 0.4 }, f64::from(i) * std::f64::consts::TAU / 14.0);
            [0.5 + r * libm::cos(angle), 0.5 + r * libm::sin(angle)]
        })
        .collect();
    let sites = clouds::uniform(120, 3);
    let clipped = tessellation(&sites).clip_to_domain(&domain(&[&star])).unwrap();
    for piece in &clipped.pieces {
        // The middle of an ear of the outer ring, which is inside the piece.
        let ring: Vec<Point2> =
            piece.rings[0].iter().map(|&i| clipped.points[i as usize]).collect();
        let n = ring.len();
        let ear = (0..n).find_map(|i| {
            let [a, b, c] = [ring[i], ring[(i + 1) % n], ring[(i + 2) % n]];
            let inside = |q: &Point2| {
                [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orient2d(u, v, *q) != Sign::Negative)
            };
            let is_ear = orient2d(a, b, c) == Sign::Positive
                && !ring.iter().any(|q| ![a, b, c].contains(q) && inside(q));
            is_ear.then(|| p((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0))
        });
        let middle = ear.expect("a polygon has an ear");
        let site = sites[piece.site as usize];
        // A sliver's middle may be off by a rounding.
        let off =
            site.distance(middle) - sites.iter().map(|q| q.distance(middle)).fold(9.0, f64::min);
        assert!(off < 1e-12, "{} {off}", piece.site);
    }
    let total: f64 = clipped.pieces.iter().map(|piece| clipped.area(piece)).sum();
    let star_area = 14.0 * 0.5 * 0.4 * libm::sin(std::f64::consts::TAU / 14.0);
    assert!((total - star_area).abs() < 1e-12, "{total} {star_area}");
}

// spec: V7
#[test]
fn holes_of_carved_domains_are_left_out() {
    let corners = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [1.0, 1.0],
        [3.0, 1.0],
        [3.0, 3.0],
        [1.0, 3.0],
    ];
    let mut carved = Domain::new(corners.map(Point2::from).to_vec());
    let ring = |first: u32| (0..4).map(move |i| [first + i, first + (i + 1) % 4]);
    let segments = ring(0).chain(ring(4)).map(|vertices| Segment { vertices, marker: 1 });
    carved.segments = segments.collect();
    carved.inside = Inside::Carve(vec![p(2.0, 2.0)]);
    let plc = validate(&carved).unwrap();
    let clipped = tessellation(&[p(0.0, 2.0), p(4.0, 2.0)]).clip_to_domain(&plc).unwrap();
    assert_eq!(pieces_of(&clipped), [(0, 1, 6.0), (1, 1, 6.0)]);
}

// spec: X47
#[test]
fn json_meets_its_schema_and_keeps_every_bit() {
    let schema = include_str!("../../schemas/voronoi-1.schema.json");
    let schema: Value = serde_json::from_str(schema).expect("JSON");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    for (name, points) in clouds::all(30) {
        let cells = tessellation(&points);
        let clipped = cells.clip_to_box(ClipBox::around(&points).unwrap());
        for clipped in [None, Some(&clipped)] {
            let mut bytes = Vec::new();
            voronoi_json::write(&cells, clipped, &mut bytes).unwrap();
            let value: Value = serde_json::from_slice(&bytes).expect("JSON");
            let errors: Vec<String> = schema.iter_errors(&value).map(|e| e.to_string()).collect();
            assert!(errors.is_empty(), "{name}: {errors:?}");
            let written: Vec<Point2> = serde_json::from_value(value["vertices"].clone()).unwrap();
            assert_eq!(written, cells.vertices, "{name}");
            assert_eq!(value["cells"].as_array().map(Vec::len), Some(points.len()));
            assert_eq!(value.get("clipped").is_some(), clipped.is_some());
        }
    }
}

// spec: X48
#[test]
fn obj_has_a_face_for_each_piece() {
    let sites = clouds::uniform(50, 1);
    let cells = tessellation(&sites);
    let clipped = cells.clip_to_box(ClipBox::around(&sites).unwrap());
    let mut bytes = Vec::new();
    voronoi_obj::write(&clipped, &mut bytes).unwrap();
    let mesh = read_mesh(&bytes, MeshForm::Obj, &ReadOptions::default()).unwrap();
    let faces = mesh.triangles.len() as u64 + mesh.other_cells.iter().map(|c| c.count).sum::<u64>();
    assert_eq!((mesh.points.len(), faces), (clipped.points.len(), 50));
    let text = String::from_utf8(bytes).unwrap();
    assert!((0..50).all(|site| text.contains(&format!("g cell_{site}\n"))));
    let frame: &[[f64; 2]] = &[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let hole: &[[f64; 2]] = &[[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [2.0, 6.0]];
    let holed = tessellation(&[p(4.0, 4.0)]).clip_to_domain(&domain(&[frame, hole])).unwrap();
    let mut bytes = Vec::new();
    voronoi_obj::write(&holed, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    assert_eq!((text.matches("\nl ").count(), text.matches("\nf ").count()), (2, 0));
}
