//! Layers of the checker's quality metrics, with ranges that make pictures comparable.

use super::layer::{self, Better, Layer};
use crate::check::Metric;
use crate::check::quality::{self, OWN_METRICS, measure};
use crate::mesh::MeshData;

impl Layer {
    /// A quality metric of every triangle, as [`check`](crate::check::check) defines it; NaN for a
    /// triangle that cannot be measured, and at a neighbour that cannot.
    ///
    /// Ranges are the same for every mesh, but for areas and their spread, which have no usual size.
    ///
    /// # Complexity
    /// O(n), O(n log n) for metrics that compare neighbours.
    #[must_use]
    pub fn metric(mesh: &MeshData, metric: Metric) -> Self {
        let values = match metric {
            Metric::NeighbourAreaRatio => neighbour_ratio(mesh, |m| m.area()),
            Metric::EdgeLengthGradation => neighbour_ratio(mesh, |m| m.perimeter()),
            Metric::AreaSpread => spread(mesh),
            own => {
                let at = own as usize;
                debug_assert!(at < OWN_METRICS, "{own} needs neighbours");
                measured(mesh).map(|m| m.map_or(f64::NAN, |m| m.metrics()[at])).collect()
            }
        };
        let better = match metric.better() {
            quality::Better::Higher => Better::High,
            quality::Better::Lower | quality::Better::Neither => Better::Low,
        };
        let layer = Self::new(title(metric), values, better);
        match usual_range(metric) {
            Some(range) => Self { range, ..layer },
            None => layer,
        }
    }
}

/// Name and unit for people.
fn title(metric: Metric) -> &'static str {
    match metric {
        Metric::RadiusRatio => "R/(2r)",
        Metric::MinAngle => "smallest angle [°]",
        Metric::MaxAngle => "largest angle [°]",
        Metric::EdgeRatio => "longest / shortest edge",
        Metric::NeighbourAreaRatio => "area ratio to neighbours",
        Metric::EdgeLengthGradation => "edge length ratio to neighbours",
        other => other.name(),
    }
}

fn usual_range(metric: Metric) -> Option<[f64; 2]> {
    match metric {
        Metric::RadiusRatio => Some([1.0, 1.6]),
        Metric::VerdictAspectRatio | Metric::EdgeLengthGradation => Some([1.0, 2.0]),
        Metric::EdgeRatio => Some([1.0, 3.0]),
        Metric::MinAngle => Some([0.0, 60.0]),
        Metric::MaxAngle => Some([60.0, 180.0]),
        Metric::RadiusEdgeRatio => Some([0.5, 1.5]),
        Metric::ScaledJacobian | Metric::Shape | Metric::EquiangleSkew => Some([0.0, 1.0]),
        Metric::NeighbourAreaRatio => Some([1.0, 4.0]),
        Metric::Area | Metric::AreaSpread => None,
    }
}

/// The measurements of each triangle that has three finite corners.
fn measured(mesh: &MeshData) -> impl Iterator<Item = Option<quality::Measured>> + '_ {
    let corners = |&t: &[u32; 3]| layer::corners(mesh, t);
    mesh.triangles.iter().map(move |t| corners(t).map(|c| measure(c, None)))
}

fn spread(mesh: &MeshData) -> Vec<f64> {
    let areas = || measured(mesh).map(|m| m.map_or(f64::NAN, |m| m.area()));
    let smallest = areas().fold(f64::INFINITY, f64::min);
    areas().map(|area| area / smallest).collect()
}

/// The largest ratio, at least 1, of a triangle's size to that of a neighbour, or its inverse.
fn neighbour_ratio(mesh: &MeshData, size: impl Fn(&quality::Measured) -> f64) -> Vec<f64> {
    let sizes: Vec<f64> = measured(mesh).map(|m| m.map_or(f64::NAN, |m| size(&m))).collect();
    let sides = mesh.triangles.iter().enumerate().flat_map(|(t, &[a, b, c])| {
        [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], t))
    });
    let mut sides: Vec<([u32; 2], usize)> = sides.collect();
    sides.sort_unstable();
    let mut ratios: Vec<f64> = sizes.iter().map(|s| if s.is_nan() { *s } else { 1.0 }).collect();
    for pair in sides.chunk_by(|x, y| x.0 == y.0).filter(|group| group.len() > 1) {
        for (&(_, s), &(_, t)) in pair.iter().zip(&pair[1..]) {
            let (low, high) = (sizes[s].min(sizes[t]), sizes[s].max(sizes[t]));
            let ratio = if low > 0.0 { high / low } else { f64::INFINITY };
            for i in [s, t] {
                ratios[i] = if ratios[i] < ratio { ratio } else { ratios[i] };
            }
        }
    }
    ratios
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckOptions, check};

    /// A fan of triangles of different sizes around the origin, one of them flat but for rounding.
    fn fan() -> MeshData {
        let rim = (0..7).map(|i| {
            let angle = f64::from(i);
            let r = 1.0 + f64::from(i % 3);
            [r * libm::cos(angle), r * libm::sin(angle), 0.0]
        });
        let points = [[0.0; 3]].into_iter().chain(rim).collect();
        let triangles = (1..7).map(|i| [0, i, i + 1]).collect();
        MeshData { points, triangles, ..MeshData::default() }
    }

    #[test]
    fn layers_have_the_values_that_the_checker_reports() {
        let mesh = fan();
        let report = check(&mesh, None, &CheckOptions::default());
        let quality = report.quality.expect("measured");
        for summary in &quality.metrics {
            let layer = Layer::metric(&mesh, summary.metric);
            let low = layer.values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = layer.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let near = |a: f64, b: Option<f64>| (a / b.expect("finite") - 1.0).abs() < 1e-12;
            assert!(near(low, summary.min) && near(high, summary.max), "{}", summary.metric);
            assert!(layer.range[0] < layer.range[1], "{}", summary.metric);
        }
    }

    #[test]
    fn what_cannot_be_measured_has_no_value_and_spoils_no_neighbour() {
        let mut mesh = fan();
        mesh.triangles.push([0, 1, 99]);
        mesh.points.push([f64::NAN; 3]);
        mesh.triangles.push([0, 1, 8]);
        for metric in Metric::all() {
            let layer = Layer::metric(&mesh, metric);
            assert!(layer.values[6].is_nan() && layer.values[7].is_nan(), "{metric}");
            assert!(layer.values[..6].iter().all(|v| v.is_finite()), "{metric}: {layer:?}");
        }
        assert!(Layer::metric(&MeshData::default(), Metric::AreaSpread).values.is_empty());
    }
}
