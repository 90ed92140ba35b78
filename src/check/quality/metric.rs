//! Quality metrics of a triangle, each with its formula and the other names it goes by.
//!
//! The names of the field are ambiguous ('aspect ratio' has five definitions in use), so every
//! metric prints its formula. Verdict's names: Stimpson et al., The Verdict Geometric Quality
//! Library, Sandia report SAND2007-1751.

use serde::{Deserialize, Serialize};

/// A quality metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Metric {
    /// R / (2 r).
    RadiusRatio,
    /// L / (2 sqrt(3) r).
    VerdictAspectRatio,
    /// Longest edge over shortest.
    EdgeRatio,
    /// Smallest angle in degrees.
    MinAngle,
    /// Largest angle in degrees.
    MaxAngle,
    /// R over the shortest edge.
    RadiusEdgeRatio,
    /// 2 / sqrt(3) times the sine of the angle between the two longest edges.
    ScaledJacobian,
    /// 4 sqrt(3) A over the sum of the squared edges.
    Shape,
    /// Deviation of the angles from 60 degrees, 0 to 1.
    EquiangleSkew,
    /// Area.
    Area,
    /// Largest ratio of areas with a neighbour across an edge, at least 1.
    NeighbourAreaRatio,
    /// Largest ratio of mean edge lengths with a neighbour across an edge, at least 1.
    EdgeLengthGradation,
    /// Area over the smallest area of the mesh: its maximum is the spread of areas.
    AreaSpread,
}

/// Which values of a metric are better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Low ones.
    Lower,
    /// High ones.
    Higher,
    /// Neither: the metric describes.
    Neither,
}

/// Name, aliases, formula, which is better.
struct Row(Metric, &'static str, &'static [&'static str], &'static str, Better);

const TABLE: [Row; Metric::COUNT] = [
    Row(
        Metric::RadiusRatio,
        "radius_ratio",
        &["aspect_ratio", "inverse_gamma"],
        "R / (2 r)",
        Better::Lower,
    ),
    Row(
        Metric::VerdictAspectRatio,
        "verdict_aspect_ratio",
        &[],
        "L_max / (2 sqrt(3) r)",
        Better::Lower,
    ),
    Row(Metric::EdgeRatio, "edge_ratio", &[], "L_max / L_min", Better::Lower),
    Row(
        Metric::MinAngle,
        "min_angle",
        &["minimum_angle"],
        "smallest angle, degrees",
        Better::Higher,
    ),
    Row(Metric::MaxAngle, "max_angle", &["maximum_angle"], "largest angle, degrees", Better::Lower),
    Row(Metric::RadiusEdgeRatio, "radius_edge_ratio", &[], "R / L_min", Better::Lower),
    Row(
        Metric::ScaledJacobian,
        "scaled_jacobian",
        &[],
        "(2 / sqrt(3)) 2 A / (product of the two longest edges)",
        Better::Higher,
    ),
    Row(Metric::Shape, "shape", &[], "4 sqrt(3) A / (a^2 + b^2 + c^2)", Better::Higher),
    Row(
        Metric::EquiangleSkew,
        "equiangle_skew",
        &[],
        "max((max_angle - 60) / 120, (60 - min_angle) / 60)",
        Better::Lower,
    ),
    Row(Metric::Area, "area", &[], "A", Better::Neither),
    Row(
        Metric::NeighbourAreaRatio,
        "neighbour_area_ratio",
        &["area_ratio"],
        "max over neighbours of max(A / A', A' / A)",
        Better::Lower,
    ),
    Row(
        Metric::EdgeLengthGradation,
        "edge_length_gradation",
        &["gradation"],
        "max over neighbours of max(P / P', P' / P), P the perimeter",
        Better::Lower,
    ),
    Row(Metric::AreaSpread, "area_spread", &[], "A / (smallest A of the mesh)", Better::Lower),
];

impl Metric {
    /// How many there are.
    pub const COUNT: usize = 13;

    /// All metrics, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.0)
    }

    /// The name in reports and gates.
    #[must_use]
    pub fn name(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// Further names that gates understand.
    #[must_use]
    pub fn aliases(self) -> &'static [&'static str] {
        TABLE[self as usize].2
    }

    /// The formula: A area, R circumradius, r inradius, L edge lengths.
    #[must_use]
    pub fn formula(self) -> &'static str {
        TABLE[self as usize].3
    }

    /// Which values are better.
    #[must_use]
    pub fn better(self) -> Better {
        TABLE[self as usize].4
    }
}

impl std::fmt::Display for Metric {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// Text that names no metric.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is no quality metric; the metrics are {names}", names = metric_names())]
pub struct UnknownMetric(pub String);

fn metric_names() -> String {
    Metric::all().map(Metric::name).collect::<Vec<_>>().join(", ")
}

impl std::str::FromStr for Metric {
    type Err = UnknownMetric;

    fn from_str(text: &str) -> Result<Self, UnknownMetric> {
        let wanted = text.trim().replace('-', "_");
        let named = |m: &Self| m.name() == wanted || m.aliases().contains(&wanted.as_str());
        Self::all().find(named).ok_or_else(|| UnknownMetric(text.trim().to_owned()))
    }
}

/// Edge lengths and area of a triangle, scaled by a power of two so that no product of four of them
/// over- or underflows.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Edge lengths; edge i runs from corner i to the next.
    pub edges: [f64; 3],
    /// Twice the signed area.
    pub doubled_area: f64,
    /// Lengths are to be multiplied by two to this power.
    pub exponent: i32,
}

/// How many metrics need no neighbours: the first ones of [`Metric`], up to the area.
pub const OWN_METRICS: usize = 10;

impl Measured {
    /// Area in the unit of the mesh.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.in_unit(0.5 * self.doubled_area, 2)
    }

    /// Perimeter in the unit of the mesh.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.in_unit(self.edges.iter().sum(), 1)
    }

    /// A product of `power` lengths in the unit of the mesh.
    #[inline]
    fn in_unit(&self, value: f64, power: i32) -> f64 {
        match self.exponent {
            0 => value,
            exponent => super::super::ldexp(value, power * exponent),
        }
    }

    /// The metrics of the triangle alone; infinite where the area is zero and the metric divides by
    /// it.
    #[must_use]
    pub fn metrics(&self) -> [f64; OWN_METRICS] {
        let mut metrics = super::lanes::metrics(self.edges, self.doubled_area);
        metrics[Metric::Area as usize] = self.area();
        metrics
    }
}

/// Measures a triangle given by its corners, and twice its signed area as `f * 2^e`.
#[inline(always)]
#[must_use]
pub fn measure(corners: [[f64; 3]; 3], doubled_area: Option<(f64, i32)>) -> Measured {
    let mut edges = differences(corners);
    let size = largest(&edges);
    let mut exponent = 0;
    // Within these bounds products of four lengths stay finite and normal.
    if !(1e-60..=1e60).contains(&size) && size > 0.0 {
        (edges, exponent) = rescaled(corners, edges, size);
    }
    let doubled_area = match doubled_area {
        Some((f, e)) => super::super::ldexp(f, e - 2 * exponent),
        None => cross_length(edges[0], edges[2]),
    };
    let length = |d: [f64; 3]| (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    Measured { edges: edges.map(length), doubled_area, exponent }
}

/// The edges as vectors, each from a corner to the next.
#[inline(always)]
fn differences([p, q, r]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [[p, q], [q, r], [r, p]].map(|[s, t]| [t[0] - s[0], t[1] - s[1], t[2] - s[2]])
}

/// The largest magnitude.
#[inline(always)]
fn largest(vectors: &[[f64; 3]; 3]) -> f64 {
    let larger = |most: f64, d: &f64| if d.abs() > most { d.abs() } else { most };
    vectors.iter().flatten().fold(0.0, larger)
}

/// The edges divided by a power of two, and its exponent.
#[cold]
fn rescaled(corners: [[f64; 3]; 3], edges: [[f64; 3]; 3], size: f64) -> ([[f64; 3]; 3], i32) {
    let is_huge = size > 1.0;
    let exponent = ilogb(if is_huge { largest(&corners) } else { size });
    let scale = |x: f64| super::super::ldexp(x, -exponent);
    // Differences of huge coordinates may overflow: those are scaled before they are taken.
    let edges = if is_huge {
        differences(corners.map(|p| p.map(scale)))
    } else {
        edges.map(|d| d.map(scale))
    };
    (edges, exponent)
}

/// |p x q|.
fn cross_length(p: [f64; 3], q: [f64; 3]) -> f64 {
    let minor = |i: usize, j: usize| p[i] * q[j] - p[j] * q[i];
    let [x, y, z] = [minor(1, 2), minor(2, 0), minor(0, 1)];
    (x * x + y * y + z * z).sqrt()
}

/// The exponent of the leading bit of a positive number.
fn ilogb(x: f64) -> i32 {
    libm::ilogb(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_parse() {
        for (i, metric) in Metric::all().enumerate() {
            assert_eq!(metric as usize, i);
            assert_eq!(metric.name().parse(), Ok(metric));
            assert_eq!(serde_json::to_value(metric).unwrap(), metric.name());
            for alias in metric.aliases() {
                assert_eq!(alias.parse(), Ok(metric));
            }
        }
        let error = "aspekt".parse::<Metric>().unwrap_err().to_string();
        assert!(error.contains("'aspekt'") && error.contains("radius_ratio"), "{error}");
    }

    fn metrics(corners: [[f64; 2]; 3]) -> [f64; OWN_METRICS] {
        measure(corners.map(|[x, y]| [x, y, 0.0]), None).metrics()
    }

    fn assert_near(got: f64, wanted: f64, what: &str) {
        assert!(
            (got - wanted).abs() <= 1e-12 * wanted.abs().max(1.0),
            "{what}: {got}, not {wanted}"
        );
    }

    #[test]
    fn the_right_isosceles_triangle_by_hand() {
        // Legs 1: A = 1/2, P = 2 + sqrt 2, R = sqrt 2 / 2, r = 1 / P.
        let m = metrics([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let (s2, s3) = (2f64.sqrt(), 3f64.sqrt());
        let perimeter = 2.0 + s2;
        assert_near(m[0], s2 / 2.0 * perimeter / 2.0, "R / 2r");
        assert_near(m[1], s2 * perimeter / (2.0 * s3), "L / (2 sqrt 3 r)");
        assert_near(m[2], s2, "edge ratio");
        assert_near(m[3], 45.0, "min angle");
        assert_near(m[4], 90.0, "max angle");
        assert_near(m[5], s2 / 2.0, "R / L_min");
        assert_near(m[6], 2.0 / s3 / s2, "scaled Jacobian");
        assert_near(m[7], s3 / 2.0, "shape");
        assert_near(m[8], 0.25, "equiangle skew");
        assert_near(m[9], 0.5, "area");
    }

    #[test]
    fn metrics_but_the_area_do_not_depend_on_scale() {
        let base = [[0.0, 0.0], [3.0, 0.5], [1.0, 2.0]];
        let wanted = metrics(base);
        for exponent in [-1060, -300, -150, 150, 300, 1020] {
            let scaled = base.map(|p| p.map(|c| super::super::super::ldexp(c, exponent)));
            let got = metrics(scaled);
            for i in 0..9 {
                let close = (got[i] - wanted[i]).abs() <= 1e-3 * wanted[i].abs();
                assert!(close, "metric {i} at 2^{exponent}: {} not {}", got[i], wanted[i]);
            }
        }
    }

    #[test]
    fn a_triangle_without_area_is_infinitely_bad() {
        let m = metrics([[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]]);
        assert!(m[0].is_infinite() && m[1].is_infinite() && m[5].is_infinite());
        assert_eq!((m[3], m[4], m[7]), (0.0, 180.0, 0.0));
    }
}
