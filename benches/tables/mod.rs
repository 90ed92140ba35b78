//! Tables of quality, worst cases and growth; each mesh is checked.

use crate::domains::{Named, all, circle, polygon, rings, square};
use std::time::Instant;
use trigrade::check::{CheckOptions, Metric, Report, check};
use trigrade::domain::Domain;
use trigrade::domain::validate::{Plc, validate};
use trigrade::improve::{ImproveOptions, forced_aspect};
use trigrade::mesh::{Mesh, MeshData};
use trigrade::mesher::{Gradation, Meshed, Observer, Options, Stage, mesh_plc};
use trigrade::point::Point2;

/// Seconds spent in front and improvement.
struct Clock {
    since: Option<Instant>,
    seconds: f64,
}

impl Observer for Clock {
    fn stage(&mut self, stage: Stage) {
        if let Some(since) = self.since.take() {
            self.seconds += since.elapsed().as_secs_f64();
        }
        if matches!(stage, Stage::Front | Stage::Improve) {
            self.since = Some(Instant::now());
        }
    }
}

/// A row: figures of one mesh.
struct Row {
    triangles: usize,
    mean: f64,
    p99: f64,
    worst: f64,
    forced: f64,
    angle: f64,
    area: f64,
    seconds: f64,
}

const HEAD: &str = "domain                      triangles   mean   99 %    max forced  angle  area99  fit 1/50/99 %      k/s";

fn run(domain: &Domain, options: &Options) -> Result<(Meshed, Report, f64), String> {
    let plc = validate(domain).map_err(|faults| faults[0].to_string())?;
    let mut clock = Clock { since: None, seconds: 0.0 };
    let meshed = mesh_plc(plc, options, &mut clock).map_err(|e| e.to_string())?;
    let report = check(&MeshData::from(&meshed.mesh), Some(domain), &CheckOptions::default());
    Ok((meshed, report, clock.seconds))
}

fn row(name: &str, domain: &Domain, options: &Options) -> Option<Row> {
    let (meshed, report, seconds) = match run(domain, options) {
        Ok(done) => done,
        Err(error) => {
            println!("{name:26} no mesh: {error}");
            return None;
        }
    };
    let verdict = if report.passed() { "" } else { "  FAILED its check" };
    let quality = report.quality.as_ref()?;
    let shape = quality.summary(Metric::RadiusRatio)?;
    let triangles = meshed.mesh.triangles.len();
    let row = Row {
        triangles,
        mean: shape.mean?,
        p99: shape.percentile_99?,
        worst: shape.max?,
        forced: forced_aspect(&meshed.mesh).map_or(1.0, |forced| forced.aspect),
        angle: quality.summary(Metric::MinAngle)?.min?,
        area: quality.summary(Metric::NeighbourAreaRatio)?.percentile_99?,
        seconds,
    };
    let fit = meshed
        .fit
        .map_or(String::new(), |fit| format!("{:.2} {:.2} {:.2}", fit.low, fit.median, fit.high));
    println!(
        "{name:26} {triangles:10} {:6.4} {:6.3} {:6.3} {:6.3} {:6.1} {:7.2}  {fit:16} {:6.0}{verdict}",
        row.mean,
        row.p99,
        row.worst,
        row.forced,
        row.angle,
        row.area,
        triangles as f64 / seconds / 1e3,
    );
    Some(row)
}

/// The regular domains, which come first.
const REGULAR: usize = 9;

/// What other meshers reach over the nine domains with the boundary kept, measured once: mean of
/// means, median 99 %, worst, median smallest angle, median 99 % of neighbours' area ratios, speed.
const PEERS: &str = "\
JIGSAW                          1.034  1.10   1.97   40      1.35        19
Gmsh                            1.049  1.21   2.98   32      1.65        96
Netgen                          1.085  1.40   3.42   22      2.18        24
delaundo                        1.061  1.35   138    25      1.76       242
Triangle -q33                   1.123  1.56   1.96   33      2.48      1400";

/// Quality over the domains, default options but for the level of improvement and the growth.
pub fn quality(level: u8, growth: f64) {
    let improve = ImproveOptions::level(level);
    let options = Options { improve, growth, ..Options::default() };
    println!("level {level}, growth {growth}\n{HEAD}");
    let rows: Vec<Row> =
        all().iter().filter_map(|Named { name, domain }| row(name, domain, &options)).collect();
    println!(
        "\nnine regular domains     mean of means, median 99 %, worst, median angle, area99, k/s"
    );
    let regular = &rows[..REGULAR.min(rows.len())];
    summary(regular);
    println!("{PEERS}");
    let forced = regular.iter().map(|row| row.forced).fold(1.0, f64::max);
    println!("the boundaries force {forced:.3} on any mesher that keeps them");
}

/// The peers' columns of some rows.
fn summary(rows: &[Row]) {
    let median = |of: fn(&Row) -> f64| {
        let mut values: Vec<f64> = rows.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let triangles: usize = rows.iter().map(|row| row.triangles).sum();
    println!(
        "trigrade                       {:6.4} {:5.3} {:6.3} {:4.1} {:9.2} {:9.0}",
        rows.iter().map(|row| row.mean).sum::<f64>() / rows.len() as f64,
        median(|row| row.p99),
        rows.iter().map(|row| row.worst).fold(1.0, f64::max),
        median(|row| row.angle),
        median(|row| row.area),
        triangles as f64 / rows.iter().map(|row| row.seconds).sum::<f64>() / 1e3,
    );
}

fn mapped(domain: &Domain, map: impl Fn(Point2) -> Point2) -> Domain {
    let points = domain.points.iter().map(|&p| map(p)).collect();
    Domain { points, ..domain.clone() }
}

fn needles(angle_deg: f64) -> Domain {
    let height = 2.0 * libm::tan(angle_deg.to_radians() / 2.0);
    rings(&[vec![
        Point2::new(0.0, 0.0),
        Point2::new(1.0, -height / 2.0),
        Point2::new(1.0, height / 2.0),
    ]])
}

/// A channel a hundredth as high as it is long, with segments ten times as long as it is high.
fn thin_channel() -> Domain {
    rings(&[polygon(&[[0.0, 0.0], [10.0, 0.0], [10.0, 0.01], [0.0, 0.01]], &[100, 1], &[1.0])])
}

fn rotated(domain: &Domain, angle: f64) -> Domain {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    mapped(domain, |p| Point2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y))
}

/// A circle in whose middle another one leaves a gap.
fn near_circles(gap: f64) -> Domain {
    rings(&[
        circle(0.0, 0.0, 10.0, 80),
        circle(-1.0 - gap / 2.0, 0.0, 1.0, 200),
        circle(1.0 + gap / 2.0, 0.0, 1.0, 200),
    ])
}

fn holes(side: u32) -> Domain {
    let n = f64::from(side);
    let mut all = vec![polygon(&[[0.0, 0.0], [n, 0.0], [n, n], [0.0, n]], &[4 * side], &[1.0])];
    for i in 0..side * side {
        all.push(circle(f64::from(i % side) + 0.5, f64::from(i / side) + 0.5, 0.25, 12));
    }
    rings(&all)
}

/// The worst cases: each ends, is checked, and has its figures.
pub fn worst() {
    println!("{HEAD}");
    let jump = polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[1000, 1, 1, 1], &[1.0]);
    let airfoil = crate::domains::naca(200, 60);
    let cases = [
        ("gap of 1e-3", near_circles(1e-3)),
        ("jump of 1000 : 1", rings(&[jump])),
        ("needle of 1e-6 degrees", needles(1e-6)),
        ("wedge of 0.5 degrees", needles(0.5)),
        ("thin channel", thin_channel()),
        ("square turned by 0.3", rotated(&square(100), 0.3)),
        ("100,000 vertices", rings(&[circle(0.0, 0.0, 1.0, 100_000)])),
        ("5,041 holes", holes(71)),
        ("offset of 1e9", mapped(&airfoil, |p| Point2::new(p.x + 1e9, p.y + 1e9))),
        ("offset of 1e6", mapped(&airfoil, |p| Point2::new(p.x + 1e6, p.y + 1e6))),
        ("size of 1e-300", mapped(&airfoil, |p| Point2::new(p.x * 1e-300, p.y * 1e-300))),
        ("size of 1e300", mapped(&airfoil, |p| Point2::new(p.x * 1e300, p.y * 1e300))),
        ("size of 1e-9", mapped(&airfoil, |p| Point2::new(p.x * 1e-9, p.y * 1e-9))),
    ];
    for (name, domain) in &cases {
        row(name, domain, &Options::default());
    }
    println!("an equal fan has 16.1 where 1000 : 1 meets at 90 degrees: no mesh has less");
}

/// A figure of this process in bytes, where the system tells it.
fn memory(key: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(key))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}

/// Time and its exponent over the number of triangles of uniform squares, memory, and the time of
/// spade's refinement to as many triangles, whose quality is another.
pub fn growth(side: u32, refine: impl Fn(&Plc, usize) -> usize) {
    let options = Options { gradation: Gradation::Uniform, ..Options::default() };
    println!("square     triangles   mean   99 %    max   seconds  exponent  bytes  over spade");
    let mut before: Option<(f64, f64)> = None;
    let mut n = 130;
    while n <= side {
        let plc = validate(&square(n)).expect("a square is sound");
        // Resets the high-water mark.
        let _ = std::fs::write("/proc/self/clear_refs", "5");
        let resident = memory("VmRSS").unwrap_or(f64::NAN);
        let mut clock = Clock { since: None, seconds: 0.0 };
        let meshed = mesh_plc(plc.clone(), &options, &mut clock).expect("a square is meshed");
        let count = meshed.mesh.triangles.len();
        let bytes = (memory("VmHWM").unwrap_or(f64::NAN) - resident) / count as f64;
        let (mean, p99, worst) = aspects(&meshed.mesh);
        drop(meshed);
        let start = Instant::now();
        refine(&plc, count);
        let spade = start.elapsed().as_secs_f64();
        let (size, time) = (count as f64, clock.seconds);
        let exponent = before.map_or(f64::NAN, |(s, t)| libm::log(time / t) / libm::log(size / s));
        println!(
            "{n:6} {count:13} {mean:6.4} {p99:6.3} {worst:6.3} {time:9.3} {exponent:9.3} {bytes:6.0} \
             {:11.2}",
            time / spade
        );
        before = Some((size, time));
        n *= 2;
    }
}

/// Mean, 99th percentile and largest R/(2r).
fn aspects(mesh: &Mesh) -> (f64, f64, f64) {
    let aspect = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.points[v as usize]);
        let (x, y, z) = (b.distance(c), c.distance(a), a.distance(b));
        x * y * z / ((y + z - x) * (z + x - y) * (x + y - z))
    };
    let mut all: Vec<f64> = mesh.triangles.iter().map(aspect).collect();
    all.sort_by(f64::total_cmp);
    let last = all.len() - 1;
    (all.iter().sum::<f64>() / all.len() as f64, all[last * 99 / 100], all[last])
}
