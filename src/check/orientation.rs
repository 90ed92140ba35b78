//! Orientation: the exact sign of every triangle, and what wrong signs mean.
//!
//! A clockwise triangle has one of two causes. Its corners may be listed in the wrong order: then it
//! lies beside its neighbours, and runs along the shared edges in their direction. Or it is folded
//! over: then it runs against them, as neighbours should, but lies on their side of the edge.

use super::edges::{Edges, NONE};
use super::exact::{ExactSum, Lanes};
use super::id::Id;
use super::lattice::Plane;
use super::report::{Collector, Draft, show_triangle, show_vertex};
use super::structure::Sound;
use super::topology;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Triangles per piece of parallel work; fixed, so that nothing can depend on threads.
const CHUNK: usize = 1 << 14;

/// Signs of all triangles.
#[derive(Default)]
pub(super) struct Signs {
    pub(super) negative: Vec<u32>,
    pub(super) zero: Vec<u32>,
    /// Exact sum of twice the signed areas.
    pub(super) doubled_area: ExactSum,
}

/// The orientation of a mesh once its listing mistakes are undone.
pub(super) struct Oriented {
    /// Sorted: triangles folded over their neighbours.
    pub(super) inverted: Vec<u32>,
    /// Exact sum of twice the signed areas.
    pub(super) doubled_area: ExactSum,
}

/// Checks M8 to M11 and leaves `sound` with every triangle counterclockwise but the folded ones.
pub(super) fn orient(
    plane: &Plane<'_>,
    sound: &mut Sound<'_>,
    out: &mut Collector<'_>,
) -> Oriented {
    let mut signs = scan(plane, &sound.triangles);
    if !signs.negative.is_empty() {
        // A reversed copy of a triangle is a duplicate, not a fold.
        let edges = Edges::of(&sound.triangles, sound.mesh.points.len());
        let copies = topology::report_duplicates(
            sound,
            &edges,
            |t| signs.negative.binary_search(&t).is_ok(),
            out,
        );
        if !copies.is_empty() {
            sound.remove(&copies);
            signs = scan(plane, &sound.triangles);
        }
    }
    let count = sound.triangles.len();
    let clockwise = signs.negative.len();
    for &t in &signs.zero {
        out.add(Id::ZeroArea, || zero_area(sound, t));
    }
    if clockwise == 0 {
        return Oriented { inverted: Vec::new(), doubled_area: signs.doubled_area };
    }
    let mostly_clockwise = 2 * clockwise > count - signs.zero.len();
    if mostly_clockwise {
        reverse_all(sound);
        signs = scan(plane, &sound.triangles);
    }
    let (mistaken, inverted) = tell_apart(sound, &signs);
    if !mistaken.is_empty() {
        let odd = if mostly_clockwise { count - clockwise } else { clockwise };
        out.add(Id::MixedOrientation, || mixed(sound, &mistaken, [count - signs.zero.len(), odd]));
        let triangles = sound.triangles.to_mut();
        mistaken.iter().for_each(|&t| triangles[t as usize].swap(1, 2));
        signs = scan(plane, &sound.triangles);
    } else if mostly_clockwise {
        let text = format!("all {clockwise} triangles are clockwise");
        out.add(Id::Clockwise, || Draft::new(Id::Clockwise, text).triangles([sound.origin(0)]));
    }
    for &t in &inverted {
        out.add(Id::Inverted, || folded(plane, sound, t));
    }
    Oriented { inverted, doubled_area: signs.doubled_area }
}

/// The exact sign of every triangle and the exact area sum; the same for any number of threads.
pub(super) fn scan(plane: &Plane<'_>, triangles: &[[u32; 3]]) -> Signs {
    let piece = |(chunk, triangles): (usize, &[[u32; 3]])| {
        let mut signs = Signs::default();
        let mut lanes = Lanes::default();
        for (t, &triangle) in ((chunk * CHUNK) as u32..).zip(triangles) {
            let sign = if let Some(doubled) = plane.lattice_area(triangle) {
                lanes.add(doubled);
                doubled.cmp(&0)
            } else {
                let doubled = plane.doubled_area(triangle);
                signs.doubled_area.add_scaled(&doubled);
                doubled.sign()
            };
            match sign {
                Ordering::Greater => {}
                Ordering::Equal => signs.zero.push(t),
                Ordering::Less => signs.negative.push(t),
            }
        }
        signs.doubled_area.add_lanes(&lanes, plane.area_exponent());
        signs
    };
    let join = |mut a: Signs, b: Signs| {
        a.negative.extend(b.negative);
        a.zero.extend(b.zero);
        a.doubled_area.merge(&b.doubled_area);
        a
    };
    triangles.par_chunks(CHUNK).enumerate().map(piece).reduce(Signs::default, join)
}

fn reverse_all(sound: &mut Sound<'_>) {
    sound.triangles.to_mut().par_iter_mut().for_each(|t| t.swap(1, 2));
}

/// Splits the clockwise triangles into those listed in the wrong order and those folded over.
///
/// A neighbour that is itself clockwise and consistent shares the fate of its neighbour, so the
/// verdict "folded" spreads from the folds inwards.
fn tell_apart(sound: &Sound<'_>, signs: &Signs) -> (Vec<u32>, Vec<u32>) {
    let edges = Edges::of(&sound.triangles, sound.mesh.points.len());
    let negative = |t: u32| signs.negative.binary_search(&t).is_ok();
    let zero = |t: u32| signs.zero.binary_search(&t).is_ok();
    let neighbours = |t: u32| {
        let twins = edges.twin[3 * t as usize..3 * t as usize + 3].iter();
        twins.filter(|&&h| h != NONE).map(|h| h / 3)
    };
    let folds = |t: u32| neighbours(t).any(|u| !negative(u) && !zero(u));
    let mut folded = vec![false; sound.triangles.len()];
    let mut work: Vec<u32> = signs.negative.iter().copied().filter(|&t| folds(t)).collect();
    work.iter().for_each(|&t| folded[t as usize] = true);
    while let Some(t) = work.pop() {
        for u in neighbours(t) {
            if negative(u) && !folded[u as usize] {
                folded[u as usize] = true;
                work.push(u);
            }
        }
    }
    signs.negative.iter().partition(|&&t| !folded[t as usize])
}

fn zero_area(sound: &Sound<'_>, t: u32) -> Draft {
    let [a, b, c] = sound.triangles[t as usize];
    let show = |v| show_vertex(sound.mesh, v);
    let number = show_triangle(sound.mesh, sound.origin(t));
    let text = format!(
        "triangle {number} has no area: its corners {}, {} and {} lie on a line",
        show(a),
        show(b),
        show(c)
    );
    Draft::new(Id::ZeroArea, text).triangles([sound.origin(t)]).vertices([a, b, c])
}

/// One finding for all, naming the first few.
fn mixed(sound: &Sound<'_>, mistaken: &[u32], [count, odd]: [usize; 2]) -> Draft {
    const NAMED: usize = 10;
    let text =
        format!("{odd} of {count} triangles list their corners in the other sense than the rest");
    let named = mistaken.iter().take(NAMED).map(|&t| sound.origin(t));
    #[expect(clippy::cast_precision_loss, reason = "counts far below 2^52")]
    let odd = odd as f64;
    Draft::new(Id::MixedOrientation, text).triangles(named).measured("triangles", odd)
}

fn folded(plane: &Plane<'_>, sound: &Sound<'_>, t: u32) -> Draft {
    let corners = sound.triangles[t as usize];
    let (value, exponent) = plane.doubled_area(corners).approximate();
    let number = show_triangle(sound.mesh, sound.origin(t));
    let text = format!("triangle {number} is folded over its neighbours");
    Draft::new(Id::Inverted, text)
        .triangles([sound.origin(t)])
        .vertices(corners)
        .measured("area", super::ldexp(value, exponent - 1))
}
