//! Predicates by class of input, beside `robust`: `cargo bench --bench predicates`.
//!
//! One iteration answers a whole batch of [`BATCH`] questions; the throughput printed is questions
//! per second.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main,
};
use trigrade::point::Point2;
use trigrade::predicates::{incircle, incircle_perturbed, orient2d, rounded_crossing};

const BATCH: usize = 1024;

/// Numbers in [0, 1) from SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, bound: u64) -> f64 {
        (self.next() % bound) as f64
    }
}

type Quad = [Point2; 4];

fn quads(mut quad: impl FnMut(&mut Random) -> Quad) -> Vec<Quad> {
    let mut random = Random(1);
    (0..BATCH).map(|_| quad(&mut random)).collect()
}

fn uniform(random: &mut Random) -> Quad {
    std::array::from_fn(|_| Point2::new(random.unit(), random.unit()))
}

/// The corners of a cell of a 1000 x 1000 grid.
fn cell(random: &mut Random) -> Quad {
    let (x, y) = (random.below(1000), random.below(1000));
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| Point2::new(x + u, y + v))
}

fn scaled(quad: Quad, scale: f64) -> Quad {
    quad.map(|p| Point2::new(p.x * scale, p.y * scale))
}

/// Four of 100,000 points of the unit circle.
fn circle(random: &mut Random) -> Quad {
    std::array::from_fn(|_| {
        let angle = std::f64::consts::TAU * random.below(100_000) / 100_000.0;
        Point2::new(angle.cos(), angle.sin())
    })
}

/// Four consecutive of 100,000 points of the unit circle.
fn arc(random: &mut Random) -> Quad {
    let first = random.below(100_000);
    [0.0, 1.0, 2.0, 3.0].map(|i| {
        let angle = std::f64::consts::TAU * (first + i) / 100_000.0;
        Point2::new(angle.cos(), angle.sin())
    })
}

/// Points of the segment from (0, 0) to (1, 1/3), rounded.
fn near_collinear(random: &mut Random) -> Quad {
    std::array::from_fn(|_| {
        let x = random.unit();
        Point2::new(x, x / 3.0)
    })
}

/// Exponents all over the range, two coordinates far apart each.
fn mixed(random: &mut Random) -> Quad {
    let mut coordinate = || random.unit() * 10.0_f64.powf(600.0 * random.unit() - 308.0);
    std::array::from_fn(|_| Point2::new(coordinate(), coordinate()))
}

fn classes() -> Vec<(&'static str, Vec<Quad>)> {
    vec![
        ("uniform", quads(uniform)),
        ("grid", quads(cell)),
        ("grid times 0.1", quads(|random| scaled(cell(random), 0.1))),
        ("circle", quads(circle)),
        ("arc", quads(arc)),
        ("near-collinear", quads(near_collinear)),
        ("grid times 2^900", quads(|random| scaled(cell(random), 2.0_f64.powi(900)))),
        ("grid times 2^-1060", quads(|random| scaled(cell(random), 2.0_f64.powi(-1060)))),
        ("mixed exponents", quads(mixed)),
    ]
}

fn coord(p: Point2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}

/// The benchmarks of one class of input.
struct Class<'a> {
    group: BenchmarkGroup<'a, WallTime>,
    quads: &'a [Quad],
}

impl Class<'_> {
    fn measure<T>(&mut self, name: &str, answer: impl Fn(Quad) -> T) {
        self.group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for &quad in self.quads {
                    black_box(answer(black_box(quad)));
                }
            });
        });
    }
}

fn predicates(criterion: &mut Criterion) {
    for (name, quads) in &classes() {
        let mut group = criterion.benchmark_group(*name);
        group.throughput(Throughput::Elements(quads.len() as u64));
        let mut class = Class { group, quads };
        class.measure("orient2d", |[a, b, c, _]| orient2d(a, b, c));
        class.measure("orient2d by robust", |quad| {
            let [a, b, c, _] = quad.map(coord);
            robust::orient2d(a, b, c)
        });
        class.measure("incircle", |[a, b, c, d]| incircle(a, b, c, d));
        class.measure("incircle by robust", |quad| {
            let [a, b, c, d] = quad.map(coord);
            robust::incircle(a, b, c, d)
        });
        class.measure("incircle_perturbed", |[a, b, c, d]| incircle_perturbed(a, b, c, d));
        class.group.finish();
    }
}

fn crossings(criterion: &mut Criterion) {
    let crossing = |&[a, b, c, d]: &Quad| rounded_crossing(a, b, c, d);
    let mut random = Random(2);
    let mut next_crossing =
        || std::iter::repeat_with(|| uniform(&mut random)).find(|quad| crossing(quad).is_some());
    criterion.bench_function("rounded_crossing", |bencher| {
        bencher.iter_batched(
            &mut next_crossing,
            |quad| quad.as_ref().and_then(crossing),
            BatchSize::SmallInput,
        );
    });
}

criterion_group!(benches, predicates, crossings);
criterion_main!(benches);
