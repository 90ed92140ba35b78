//! The legend of a layer: a histogram over the palette, and the figures that sum it up.

use super::Palette;
use super::layer::{Better, Layer};
use super::text::{self, Anchor};
use std::fmt::Write as _;

/// Bars of the histogram.
const BARS: usize = 60;
const HISTOGRAM: f64 = 38.0;
const BAR: f64 = 9.0;
/// Height of a legend with its labels.
pub const HEIGHT: f64 = HISTOGRAM + BAR + 34.0;

/// What a layer's values amount to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Mean of the values that are numbers; infinite if one of them is.
    pub mean: f64,
    /// The value that 99 of 100 triangles are at least as good as.
    pub percentile: f64,
    /// The worst value.
    pub worst: f64,
    /// Values that are NaN.
    pub missing: usize,
    /// Counts in equal parts of the range; values outside count in the end bars.
    bars: Vec<usize>,
}

impl Summary {
    /// `None` if the layer has no value that is a number.
    pub fn of(layer: &Layer) -> Option<Self> {
        let mut values: Vec<f64> = layer.values.iter().copied().filter(|v| !v.is_nan()).collect();
        let missing = layer.values.len() - values.len();
        let n = values.len();
        if n == 0 {
            return None;
        }
        let mut bars = vec![0; BARS];
        for &v in &values {
            bars[((layer.fraction(v) * BARS as f64) as usize).min(BARS - 1)] += 1;
        }
        let mean = values.iter().map(|v| v / n as f64).sum();
        // Better ones first; rank ceil(0.99 n), counted from 1.
        let rank = (n * 99).div_ceil(100).max(1) - 1;
        let order = |a: &f64, b: &f64| match layer.better {
            Better::Low => a.total_cmp(b),
            Better::High => b.total_cmp(a),
        };
        let (_, &mut percentile, rest) = values.select_nth_unstable_by(rank, order);
        let worst = rest.iter().copied().max_by(order).unwrap_or(percentile);
        Some(Self { mean, percentile, worst, missing, bars })
    }

    /// The figures in one line.
    fn line(&self, better: Better) -> String {
        let (most, worst) = match better {
            Better::Low => ("\u{2264}", "max"),
            Better::High => ("\u{2265}", "min"),
        };
        let [mean, percentile, extreme] = [self.mean, self.percentile, self.worst].map(text::short);
        let missing = match self.missing {
            0 => String::new(),
            n => format!(", {} without a value", text::count(n)),
        };
        format!("mean {mean}, 99 % {most} {percentile}, {worst} {extreme}{missing}")
    }
}

/// Draws the legend with its top left corner at `at`.
pub fn write(
    out: &mut String,
    at: [f64; 2],
    width: f64,
    (layer, summary): (&Layer, &Summary),
    palette: Palette,
) {
    let [x, y] = at.map(text::pixels);
    let _ = writeln!(out, "<g transform=\"translate({x} {y})\">");
    write_bars(out, width, (layer, summary), palette);
    write_ticks(out, width, (layer, summary));
    out.push_str("</g>\n");
}

fn write_bars(
    out: &mut String,
    width: f64,
    (layer, summary): (&Layer, &Summary),
    palette: Palette,
) {
    let tallest = summary.bars.iter().copied().max().unwrap_or(0).max(1) as f64;
    let step = width / BARS as f64;
    let mut outline = format!("M0 {HISTOGRAM}");
    for (i, &n) in summary.bars.iter().enumerate() {
        let t = (i as f64 + 0.5) / BARS as f64;
        let shade = if layer.better == Better::Low { t } else { 1.0 - t };
        let colour = palette.colour(shade);
        // A bar that is not empty can be seen.
        let height = if n == 0 { 0.0 } else { (n as f64 / tallest * HISTOGRAM).max(1.0) };
        let [x, y, w, h] =
            [i as f64 * step, HISTOGRAM - height, step, height + BAR].map(text::pixels);
        let _ = writeln!(
            out,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"#{colour:06x}\" shape-rendering=\"crispEdges\"/>"
        );
        let _ = write!(outline, "V{y}H{}", text::pixels((i + 1) as f64 * step));
    }
    let _ = writeln!(
        out,
        "<path d=\"{outline}V{HISTOGRAM}\" fill=\"none\" stroke=\"#5a6068\" stroke-width=\"0.6\"/>"
    );
    let _ = writeln!(
        out,
        "<rect y=\"{HISTOGRAM}\" width=\"{}\" height=\"{BAR}\" fill=\"none\" stroke=\"#5a6068\" stroke-width=\"0.6\"/>",
        text::pixels(width)
    );
}

fn write_ticks(out: &mut String, width: f64, (layer, summary): (&Layer, &Summary)) {
    let y = HISTOGRAM + BAR + 12.0;
    for i in 0..=4 {
        let t = f64::from(i) / 4.0;
        let value = text::short(layer.value_at(t));
        let label = match i {
            0 if beyond(layer, summary, 0) => format!("\u{2264} {value}"),
            4 if beyond(layer, summary, 1) => format!("\u{2265} {value}"),
            _ => value,
        };
        let anchor = match i {
            0 => Anchor::Start,
            4 => Anchor::End,
            _ => Anchor::Middle,
        };
        text::push(out, [t * width, y], anchor, SMALL, &label);
    }
    let name = format!("{}: {}", layer.name, summary.line(layer.better));
    // Set in a smaller size than it is measured by: the figures matter more than the margin.
    let name = text::fitted(&name, width, 9.5);
    text::push(out, [width / 2.0, y + 15.0], Anchor::Middle, NAME, &name);
}

const SMALL: &str = " font-size=\"10\" fill=\"#4a4f57\"";
const NAME: &str = " font-size=\"11\" fill=\"#22262c\"";

/// Whether a value lies outside the low (0) or high (1) end of a range, by more than rounding.
pub(super) fn is_outside(range: [f64; 2], end: usize, value: f64) -> bool {
    let rounding = 1e-9 * (range[1] - range[0]);
    if end == 0 { value < range[0] - rounding } else { value > range[1] + rounding }
}

/// Whether a value of the layer lies outside the low (0) or high (1) end of its range.
fn beyond(layer: &Layer, summary: &Summary, end: usize) -> bool {
    let outside = |v: &f64| is_outside(layer.range, end, *v);
    let worst_end = usize::from(layer.better == Better::Low);
    if end == worst_end { outside(&summary.worst) } else { layer.values.iter().any(outside) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_hundred_values() {
        let layer = Layer::new("x", (1..=100).map(f64::from).collect(), Better::Low);
        let summary = Summary::of(&layer).expect("values");
        assert_eq!((summary.mean * 1e9).round() / 1e9, 50.5);
        assert_eq!((summary.percentile, summary.worst, summary.missing), (99.0, 100.0, 0));
        let high = Layer { better: Better::High, ..layer };
        let summary = Summary::of(&high).expect("values");
        assert_eq!((summary.percentile, summary.worst), (2.0, 1.0));
        assert_eq!(summary.bars.iter().sum::<usize>(), 100);
    }

    #[test]
    fn missing_and_infinite_values_are_said() {
        let layer = Layer::new("x", vec![1.0, f64::NAN, f64::INFINITY], Better::Low);
        let summary = Summary::of(&layer).expect("values");
        assert_eq!(
            summary.line(Better::Low),
            "mean \u{221e}, 99 % \u{2264} \u{221e}, max \u{221e}, 1 without a value"
        );
        assert_eq!(Summary::of(&Layer::new("x", vec![f64::NAN], Better::Low)), None);
        assert_eq!(Summary::of(&Layer::new("x", vec![], Better::Low)), None);
    }

    #[test]
    fn ends_say_when_values_lie_beyond() {
        let layer =
            Layer { range: [1.0, 2.0], ..Layer::new("q", vec![0.5, 1.5, 3.0], Better::Low) };
        let summary = Summary::of(&layer).expect("values");
        let mut out = String::new();
        write(&mut out, [0.0, 0.0], 300.0, (&layer, &summary), Palette::default());
        assert!(out.contains("\u{2264} 1<") && out.contains("\u{2265} 2<"), "{out}");
        assert!(!is_outside([1.0, 2.0], 0, 1.0 - f64::EPSILON), "equilateral but for rounding");
        let inside = Layer { range: [0.0, 4.0], ..layer };
        let mut out = String::new();
        write(&mut out, [0.0, 0.0], 300.0, (&inside, &summary), Palette::default());
        assert!(!out.contains("\u{2264} 0<") && !out.contains('\u{2265}'), "{out}");
    }
}
