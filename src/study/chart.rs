//! A dot chart: a row a domain, a dot a system.

use super::claims::find;
use super::{Figures, Row, Setting, System};
use std::fmt::Write as _;

/// What a chart shows of the figures.
#[derive(Clone, Copy)]
pub struct Measure {
    /// Heading.
    pub title: &'static str,
    /// The value, above 1.
    pub value: fn(&Figures) -> f64,
}

/// The colours of Okabe and Ito, in the order of [`System::ALL`]: apart for every eye.
pub const COLOURS: [&str; 6] = ["#0072b2", "#56b4e9", "#009e73", "#e69f00", "#d55e00", "#7f7f7f"];

const LEFT: f64 = 120.0;
const WIDTH: f64 = 560.0;
const ROW: f64 = 24.0;
const TOP: f64 = 46.0;

/// Draws the values above 1 on a logarithmic axis of their excess, so that 1.01 and 1.02 are as far
/// apart as 2 and 3.
#[must_use]
pub fn chart(rows: &[Row], setting: Setting, measure: Measure) -> String {
    // Rows of a setting stand together, and in it those of a domain.
    let shown = rows.iter().filter(|row| row.setting == setting);
    let mut domains: Vec<&str> = shown.clone().map(|row| row.domain).collect();
    domains.dedup();
    let excess = |row: &Row| row.figures.as_ref().map(|f| (measure.value)(f) - 1.0);
    let values: Vec<f64> = shown.filter_map(excess).filter(|v| v.is_finite() && *v > 0.0).collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    if values.is_empty() {
        return String::new();
    }
    // Whole powers of ten around the values.
    let [from, to] = [libm::floor(libm::log10(low)), libm::ceil(libm::log10(high))];
    let to = to.max(from + 1.0);
    let place = |v: f64| LEFT + WIDTH * (libm::log10(v) - from) / (to - from);
    let height = TOP + ROW * domains.len() as f64 + 10.0;
    let mut out = format!(
        "<svg class=\"chart\" viewBox=\"0 0 {:.0} {height:.0}\" role=\"img\"><text x=\"{LEFT}\" y=\"14\" \
         class=\"title\">{}</text>\n",
        LEFT + WIDTH + 40.0,
        measure.title
    );
    write_axis(&mut out, [from, to], &place, height);
    for (i, domain) in domains.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.5);
        let _ = writeln!(
            out,
            "<text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{domain}</text>\
             <line x1=\"{LEFT}\" x2=\"{:.0}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#e3e6ea\"/>",
            LEFT - 8.0,
            y + 4.0,
            LEFT + WIDTH
        );
        for (system, colour) in System::ALL.into_iter().zip(COLOURS).rev() {
            let row = find(rows, domain, system, setting);
            if let Some(v) = row.and_then(excess) {
                let x = if v.is_finite() { place(v.max(low)) } else { LEFT + WIDTH + 14.0 };
                let _ = writeln!(
                    out,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"{colour}\" fill-opacity=\"0.85\" \
                     stroke=\"#fff\"><title>{domain}, {}: {:.4}</title></circle>",
                    system.title(),
                    v + 1.0
                );
            }
        }
    }
    out + "</svg>\n"
}

fn write_axis(out: &mut String, [from, to]: [f64; 2], place: &dyn Fn(f64) -> f64, height: f64) {
    let mut decade = from;
    while decade <= to {
        for multiple in [1.0, 2.0, 5.0] {
            let v = multiple * libm::pow(10.0, decade);
            if v > libm::pow(10.0, to) * 1.000_001 {
                break;
            }
            let x = place(v);
            // 1 + a rounded power of ten, to as many digits as it has.
            let digits = if decade < 0.0 { (-decade) as usize } else { 0 };
            let _ = writeln!(
                out,
                "<text x=\"{x:.1}\" y=\"34\" text-anchor=\"middle\" class=\"tick\">{:.digits$}</text>\
                 <line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{:.0}\" stroke=\"#eef0f3\"/>",
                1.0 + v,
                height - 10.0
            );
        }
        decade += 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(domain: &'static str, system: System, ratio: f64) -> Row {
        let figures = Figures {
            triangles: 1,
            points: 3,
            ratio_mean: ratio,
            ratio_p99: ratio,
            ratio_max: ratio,
            angle_min_deg: 1.0,
            area_ratio_p99: 1.0,
            far_over_dense: 1.0,
            passed: true,
        };
        let setting = Setting::Own;
        let figures = Some(figures);
        Row { domain, system, setting, target: None, figures, reason: None, seconds: 0.0 }
    }

    const MEAN: Measure = Measure { title: "mean", value: |f| f.ratio_mean };

    // spec: K34
    #[test]
    fn a_chart_has_a_dot_for_every_mesh_and_the_worse_one_is_further_right() {
        let rows = [row("a", System::Graded, 1.02), row("a", System::Afm, 1.5)];
        let svg = chart(&rows, Setting::Own, MEAN);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let dots: Vec<f64> = document
            .descendants()
            .filter(|node| node.has_tag_name("circle"))
            .map(|node| node.attribute("cx").and_then(|x| x.parse().ok()).expect("a number"))
            .collect();
        assert_eq!(dots.len(), 2);
        assert!(dots[0] > dots[1], "drawn from the last system on: {dots:?}");
    }

    // spec: K34
    #[test]
    fn every_domain_has_one_row_whatever_the_settings() {
        let mut rows = Vec::new();
        for setting in Setting::ALL {
            for domain in ["a", "b"] {
                rows.push(Row { setting, ..row(domain, System::Graded, 1.1) });
                rows.push(Row { setting, ..row(domain, System::Afm, 1.2) });
            }
        }
        for setting in Setting::ALL {
            let svg = chart(&rows, setting, MEAN);
            assert_eq!((svg.matches(">a<").count(), svg.matches(">b<").count()), (1, 1), "{svg}");
        }
    }

    // spec: K34
    #[test]
    fn odd_values_give_a_chart_of_finite_numbers() {
        for ratios in [vec![1.0, 1.0 + 1e-9], vec![f64::INFINITY, 1.1], vec![1e9, 1.1]] {
            let rows: Vec<Row> = ratios.iter().map(|&r| row("a", System::Graded, r)).collect();
            let svg = chart(&rows, Setting::Own, MEAN);
            roxmltree::Document::parse(&svg).expect("XML");
            assert!(!svg.contains("NaN") && !svg.contains("\"inf"), "{svg}");
        }
        assert_eq!(chart(&[], Setting::Own, MEAN), "");
        assert_eq!(chart(&[row("a", System::Afm, 1.1)], Setting::Raw, MEAN), "");
    }
}
