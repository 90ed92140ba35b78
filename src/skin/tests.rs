//! Skins on a sphere and a plane: operations keep the topology, whatever is asked of them.

use super::*;
use crate::vector::norm;

/// The unit sphere, or the plane z = 0.
struct Round {
    is_sphere: bool,
    spacing: f64,
}

impl Ground for Round {
    type Place = ();

    fn foot(&self, p: Vector, _: u32, _: Vector, _: Option<()>) -> Option<Foot<()>> {
        if !self.is_sphere {
            return Some(Foot { point: [p[0], p[1], 0.0], normal: [0.0, 0.0, 1.0], place: () });
        }
        let normal = unit(p)?;
        Some(Foot { point: normal, normal, place: () })
    }

    fn spacing(&self, _: Vector) -> f64 {
        self.spacing
    }
}

fn octahedron() -> (Vec<Vector>, Vec<[u32; 3]>) {
    let points = (0..6).map(|k| {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        std::array::from_fn(|i| if i == k / 2 { sign } else { 0.0 })
    });
    let triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    (points.collect(), triangles)
}

/// A square of `n` times `n` cells.
fn square(n: u32) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let at = |k: u32| {
        [f64::from(k % (n + 1)) / f64::from(n), f64::from(k / (n + 1)) / f64::from(n), 0.0]
    };
    let points = (0..(n + 1) * (n + 1)).map(at).collect();
    let cell = |k: u32| {
        let a = k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    (points, (0..n * n).flat_map(cell).collect())
}

fn skin<'a>(
    ground: &'a Round,
    (points, triangles): (Vec<Vector>, Vec<[u32; 3]>),
    rank: impl Fn(Vector) -> Rank,
) -> Skin<'a, Round> {
    let ranks = points.iter().map(|&p| rank(p)).collect();
    Skin::new(ground, linked(&triangles).expect("a surface"), points, ranks)
}

/// Links are mutual, stars are whole, triangles have three corners; gives the Euler number.
fn assert_sound(skin: &Skin<'_, Round>) -> i64 {
    let mut corners = vec![0; skin.points.len()];
    let mut open = 0;
    for t in skin.mesh.triangles() {
        let [a, b, c] = skin.mesh.corners(t);
        assert!(a != b && b != c && c != a);
        for e in t.half_edges() {
            corners[skin.mesh.origin(e).index()] += 1;
            match skin.mesh.twin(e) {
                None => open += 1,
                Some(f) => {
                    assert_eq!(skin.mesh.twin(f), Some(e));
                    assert_eq!(skin.mesh.origin(f), skin.mesh.dest(e));
                    assert_eq!(skin.mesh.is_constrained(e), skin.mesh.is_constrained(f));
                }
            }
        }
    }
    let mut vertices = 0;
    for v in (0..skin.points.len()).filter(|&v| skin.is_there(v)) {
        let out = skin.out(VertexId(v as u32));
        assert_eq!(skin.mesh.origin(out).index(), v);
        assert_eq!(skin.mesh.star(out).count(), corners[v], "one fan at {v}");
        vertices += 1;
    }
    let triangles = skin.mesh.live_count() as i64;
    vertices - (3 * triangles + open) / 2 + triangles
}

// spec: U3
#[test]
fn a_sphere_is_refined_and_coarsened_and_stays_one() {
    let fine = Round { is_sphere: true, spacing: 0.2 };
    let mut skin = skin(&fine, octahedron(), |_| Rank::Free);
    let passes = skin.remesh(Effort::default(), 100_000).expect("within limits");
    assert_eq!(assert_sound(&skin), 2);
    assert!(passes.splits > 100 && passes.moves > 100, "{passes:?}");
    let collected = skin.collect();
    assert!(collected.points.iter().all(|p| (norm(*p) - 1.0).abs() < 1e-14));
    for t in &collected.triangles {
        let [a, b, c] = t.map(|v| collected.points[v as usize]);
        assert!(shape([a, b, c]) > 0.6);
        assert!(faces([a, b, c], a), "all face outwards");
    }
    let coarse = Round { is_sphere: true, spacing: 0.7 };
    let (points, triangles) = (collected.points, collected.triangles);
    let mut skin = self::skin(&coarse, (points, triangles), |_| Rank::Free);
    let passes = skin.remesh(Effort::default(), 100_000).expect("within limits");
    assert_eq!(assert_sound(&skin), 2);
    assert!(passes.collapses > 100 && skin.mesh.live_count() < 120, "{}", skin.mesh.live_count());
}

// spec: U3
#[test]
fn nothing_is_collapsed_below_a_tetrahedron() {
    let huge = Round { is_sphere: true, spacing: 100.0 };
    let mut skin = skin(&huge, octahedron(), |_| Rank::Free);
    let _ = skin.remesh(Effort::default(), 1000).expect("within limits");
    assert_eq!(assert_sound(&skin), 2);
    assert!(skin.mesh.live_count() >= 4);
}

// spec: U2 U3
#[test]
fn removable_vertices_vanish_along_their_border_and_fixed_ones_stay() {
    let ground = Round { is_sphere: false, spacing: 0.5 };
    let rank = |p: Vector| {
        let on = |x: f64| x == 0.0 || x == 1.0;
        match (on(p[0]), on(p[1])) {
            (true, true) => Rank::Fixed,
            (false, false) => Rank::Free,
            _ => Rank::Removable,
        }
    };
    let mut skin = skin(&ground, square(8), rank);
    let passes = skin.remesh(Effort::default(), 1000).expect("within limits");
    assert_eq!(assert_sound(&skin), 1);
    assert!(passes.collapses > 50, "{passes:?}");
    let left = (0..skin.points.len()).filter(|&v| skin.is_there(v));
    let ranks: Vec<Rank> = left.map(|v| skin.ranks[v]).collect();
    assert_eq!(ranks.iter().filter(|r| **r == Rank::Fixed).count(), 4);
    assert_eq!(ranks.iter().filter(|r| **r == Rank::Removable).count(), 0);
    let area: f64 = skin.mesh.triangles().map(|t| 0.5 * skin.normal(t)[2]).sum();
    assert!((area - 1.0).abs() < 1e-14, "the square is still covered: {area}");
}

// spec: U10
#[test]
fn too_many_vertices_end_the_run() {
    let ground = Round { is_sphere: true, spacing: 0.01 };
    let mut skin = skin(&ground, octahedron(), |_| Rank::Free);
    let error = skin.remesh(Effort::default(), 50).expect_err("too many");
    assert_eq!(error, TooManyVertices(50));
    assert_eq!(assert_sound(&skin), 2);
}
