//! Histograms of two meshes laid over each other.

use super::layer::{Better, Layer};
use super::legend::is_outside;
use super::text::{self, Anchor};
use super::{DrawError, Options, Panel, check_input, page, perspective};
use crate::mesh::MeshData;
use std::fmt::Write as _;

/// Okabe and Ito's blue and vermilion: apart for every eye.
pub const COLOURS: [&str; 2] = ["#0072b2", "#d55e00"];

const BARS: usize = 48;
const MARGIN: f64 = 16.0;
const GAP: f64 = 28.0;
const HEIGHT: f64 = 110.0;
/// A histogram with its name, figures and ticks.
const CELL: f64 = HEIGHT + 74.0;

const NAME: &str = " font-size=\"12\" font-weight=\"bold\" fill=\"#22262c\"";
const SMALL: &str = " font-size=\"10\" fill=\"#4a4f57\"";

/// Draws two meshes side by side at one scale, and below them histograms of pairs of layers, the
/// first mesh's in blue and the second's in vermilion. Surfaces in space are drawn in perspective.
///
/// # Errors
/// As [`svg`](super::svg).
pub fn comparison(
    panels: &[Panel<'_>; 2],
    histograms: &[[Layer; 2]],
    options: &Options,
) -> Result<String, DrawError> {
    check_input(panels, options)?;
    let is_flat = panels.iter().all(|p| p.view.is_some() || !perspective::is_in_space(p.mesh));
    let (top, height) = if is_flat {
        let page = page::Page::new(panels, options);
        (page.svg(), page.height)
    } else {
        in_space(panels, options)?
    };
    let columns = ((options.width / 420.0) as usize).clamp(1, 3);
    let rows = histograms.len().div_ceil(columns);
    let key = if histograms.is_empty() { 0.0 } else { 34.0 };
    let total = height + key + CELL * rows as f64 + MARGIN;
    let [width, total] = [options.width, total].map(text::pixels);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{total}\" \
         viewBox=\"0 0 {width} {total}\" font-family=\"{}\">\n\
         <rect width=\"{width}\" height=\"{total}\" fill=\"#fff\"/>\n{top}",
        text::FONT
    );
    if !histograms.is_empty() {
        write_key(&mut out, panels, height + 16.0);
    }
    let cell = (options.width - 2.0 * MARGIN - GAP * (columns - 1) as f64) / columns as f64;
    for (i, pair) in histograms.iter().enumerate() {
        let x = MARGIN + (i % columns) as f64 * (cell + GAP);
        let y = height + key + CELL * (i / columns) as f64;
        write_histogram(&mut out, [x, y], cell, pair);
    }
    Ok(out + "</svg>\n")
}

/// The two surfaces in perspective, side by side.
fn in_space(panels: &[Panel<'_>; 2], options: &Options) -> Result<(String, f64), DrawError> {
    let half = Options { width: options.width / 2.0, title: String::new(), ..options.clone() };
    let mut out = String::new();
    let mut tallest = 0.0_f64;
    for (i, panel) in panels.iter().enumerate() {
        let (svg, height) = perspective::perspective(panel.mesh, &panel.caption, &half)?;
        let x = text::pixels(i as f64 * half.width);
        out += &svg.replacen("<svg ", &format!("<svg x=\"{x}\" "), 1);
        tallest = tallest.max(height);
    }
    Ok((out, tallest))
}

/// Which colour is whose.
fn write_key(out: &mut String, panels: &[Panel<'_>; 2], y: f64) {
    let mut x = MARGIN;
    for (panel, colour) in panels.iter().zip(COLOURS) {
        let [left, top] = [x, y - 9.0].map(text::pixels);
        let _ = writeln!(
            out,
            "<rect x=\"{left}\" y=\"{top}\" width=\"22\" height=\"10\" fill=\"{colour}\" \
             fill-opacity=\"0.35\" stroke=\"{colour}\"/>"
        );
        let caption = text::fitted(&panel.caption, 360.0, 12.0);
        text::push(out, [x + 28.0, y], Anchor::Start, NAME, &caption);
        x += 28.0 + 7.6 * caption.chars().count() as f64 + 24.0;
    }
}

/// Where the bars of a pair begin and end: the range that holds all but one in two hundred of the
/// values of either end, but nothing beyond the values themselves.
fn span(pair: &[Layer; 2]) -> Option<[f64; 2]> {
    let values = pair.iter().flat_map(|layer| &layer.values).copied();
    let mut values: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let cut = last / 200;
    // The good end is kept whole: most values lie there.
    let [low, high] = match pair[0].better {
        Better::Low => [values[0], values[last - cut]],
        Better::High => [values[cut], values[last]],
    };
    Some(if low < high { [low, high] } else { [low - 0.5, high + 0.5] })
}

/// The share of the values in each bar; those outside count in the end bars.
fn shares(layer: &Layer, range: [f64; 2]) -> [f64; BARS] {
    let scaled = Layer { range, values: Vec::new(), ..layer.clone() };
    let values = || layer.values.iter().filter(|v| !v.is_nan());
    let each = 1.0 / values().count().max(1) as f64;
    let mut bars = [0.0; BARS];
    for &v in values() {
        bars[((scaled.fraction(v) * BARS as f64) as usize).min(BARS - 1)] += each;
    }
    bars
}

fn write_histogram(out: &mut String, [x, y]: [f64; 2], width: f64, pair: &[Layer; 2]) {
    let [left, top] = [x, y].map(text::pixels);
    let _ = writeln!(out, "<g transform=\"translate({left} {top})\">");
    text::push(out, [0.0, 12.0], Anchor::Start, NAME, &pair[0].name);
    let Some(range) = span(pair) else {
        text::push(out, [0.0, 30.0], Anchor::Start, SMALL, "no values");
        out.push_str("</g>\n");
        return;
    };
    let bars = [&pair[0], &pair[1]].map(|layer| shares(layer, range));
    let tallest = bars.iter().flatten().copied().fold(0.0_f64, f64::max).max(1e-12);
    let base = HEIGHT + 22.0;
    for (bars, colour) in bars.iter().zip(COLOURS) {
        let step = width / BARS as f64;
        let mut path = format!("M0 {base}");
        for (i, share) in bars.iter().enumerate() {
            let top = text::pixels(base - share / tallest * HEIGHT);
            let _ = write!(path, "V{top}H{}", text::pixels((i + 1) as f64 * step));
        }
        let _ = writeln!(
            out,
            "<path d=\"{path}V{base}Z\" fill=\"{colour}\" fill-opacity=\"0.3\" stroke=\"{colour}\" \
             stroke-width=\"1.1\"/>"
        );
    }
    write_ticks(out, width, base, (pair, range));
    out.push_str("</g>\n");
}

fn write_ticks(out: &mut String, width: f64, base: f64, (pair, range): (&[Layer; 2], [f64; 2])) {
    let w = text::pixels(width);
    let _ = writeln!(out, "<path d=\"M0 {base}H{w}\" stroke=\"#5a6068\" stroke-width=\"0.8\"/>");
    let values = || pair.iter().flat_map(|layer| &layer.values);
    let beyond = [0, 1].map(|end| values().any(|v| is_outside(range, end, *v)));
    for i in 0..=4 {
        let t = f64::from(i) / 4.0;
        let value = text::short(range[0] * (1.0 - t) + range[1] * t);
        let (anchor, label) = match i {
            0 if beyond[0] => (Anchor::Start, format!("\u{2264} {value}")),
            0 => (Anchor::Start, value),
            4 if beyond[1] => (Anchor::End, format!("\u{2265} {value}")),
            4 => (Anchor::End, value),
            _ => (Anchor::Middle, value),
        };
        text::push(out, [t * width, base + 13.0], anchor, SMALL, &label);
    }
    let line = pair.iter().map(mean_and_worst).collect::<Vec<_>>().join("   |   ");
    text::push(out, [0.0, base + 28.0], Anchor::Start, SMALL, &line);
}

fn mean_and_worst(layer: &Layer) -> String {
    super::legend::Summary::of(layer).map_or_else(
        || "no values".to_owned(),
        |summary| {
            let [mean, worst] = [summary.mean, summary.worst].map(text::short);
            let word = if layer.better == Better::Low { "max" } else { "min" };
            format!("mean {mean}, {word} {worst}")
        },
    )
}

/// The layers of both meshes for each metric that a comparison draws.
#[must_use]
pub fn comparison_layers(meshes: [&MeshData; 2]) -> Vec<[Layer; 2]> {
    use crate::check::Metric;
    const SHOWN: [Metric; 6] = [
        Metric::RadiusRatio,
        Metric::MinAngle,
        Metric::MaxAngle,
        Metric::EdgeRatio,
        Metric::NeighbourAreaRatio,
        Metric::Shape,
    ];
    SHOWN.iter().map(|&metric| meshes.map(|mesh| Layer::metric(mesh, metric))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(values: &[f64]) -> Layer {
        Layer::new("q", values.to_vec(), Better::Low)
    }

    fn triangle(height: f64) -> MeshData {
        MeshData {
            points: vec![[0.0; 3], [4.0, 0.0, 0.0], [2.0, height, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        }
    }

    // spec: G20
    #[test]
    fn shares_of_each_mesh_add_up_to_one_over_a_common_range() {
        let pair = [layer(&[1.0, 1.5, 2.0]), layer(&[1.0, 3.0, f64::INFINITY, f64::NAN])];
        let range = span(&pair).expect("values");
        assert_eq!(range, [1.0, 3.0]);
        for layer in &pair {
            let bars = shares(layer, range);
            assert!((bars.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{bars:?}");
        }
        assert_eq!(shares(&pair[1], range)[BARS - 1], 2.0 / 3.0, "3 and infinity");
        assert_eq!(span(&[layer(&[f64::NAN]), layer(&[])]), None);
        assert_eq!(span(&[layer(&[2.0]), layer(&[2.0])]), Some([1.5, 2.5]));
    }

    // spec: G20
    #[test]
    fn a_comparison_has_both_meshes_at_one_scale_and_a_histogram_a_pair() {
        let (a, b) = (triangle(3.0), triangle(1.0));
        let panels = [Panel::new(&a, "first"), Panel::new(&b, "second")];
        let layers = comparison_layers([&a, &b]);
        let svg = comparison(&panels, &layers, &Options::default()).expect("drawn");
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let filled = |colour: &str| {
            document
                .descendants()
                .filter(|n| n.has_tag_name("path") && n.attribute("fill") == Some(colour))
                .count()
        };
        assert_eq!([filled(COLOURS[0]), filled(COLOURS[1])], [6, 6]);
        assert!(svg.contains("first") && svg.contains("second"));
        assert!(!svg.contains("NaN"), "{svg}");
    }

    #[test]
    fn surfaces_and_empty_meshes_are_compared_too() {
        let mut a = triangle(3.0);
        a.points[2][2] = 1.0;
        let empty = MeshData::default();
        for other in [&a, &empty] {
            let panels = [Panel::new(&a, "a"), Panel::new(other, "b")];
            let layers = comparison_layers([&a, other]);
            let svg = comparison(&panels, &layers, &Options::default()).expect("drawn");
            roxmltree::Document::parse(&svg).expect("XML");
            assert!(!svg.contains("NaN") && !svg.contains("\"inf"), "{svg}");
        }
    }

    // spec: !G2
    #[test]
    fn a_layer_that_does_not_fit_is_refused() {
        let a = triangle(3.0);
        let wrong = layer(&[1.0, 2.0]);
        let panels = [Panel::new(&a, "a").coloured(&wrong), Panel::new(&a, "b")];
        assert!(comparison(&panels, &[], &Options::default()).is_err());
    }
}
