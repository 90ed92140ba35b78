//! What `trigrade mesh --method delaunay` says about its bounds.

use super::words::count;
use crate::mesher::Options;
use crate::refine::RefineStats;
use serde_json::{Value, json};

/// What refinement was asked for, and what it reached.
pub struct Refinement {
    stats: RefineStats,
    angle_min_deg: f64,
    split_boundary: bool,
}

impl Refinement {
    /// Of a run with these options.
    #[must_use]
    pub fn new(stats: RefineStats, options: &Options) -> Self {
        let Options { angle_min_deg, split_boundary, .. } = *options;
        Self { stats, angle_min_deg, split_boundary }
    }

    /// One sentence about the angles, and one about areas where some are too large.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let mut list = Vec::new();
        let Self { stats, angle_min_deg: bound, .. } = self;
        let smallest = stats.smallest_angle_deg;
        if *bound > 0.0 && stats.small_angles == 0 {
            list.push(format!(
                "every angle is at least {bound} degrees, the smallest {smallest:.3}"
            ));
        } else if *bound > 0.0 {
            list.push(format!(
                "{} below {bound} degrees, the smallest {smallest:.3}: {}",
                triangles(stats.small_angles, "an angle"),
                if self.split_boundary {
                    "the domain's own small angles and narrowest places"
                } else {
                    "the boundary is kept, --split-boundary may split it"
                }
            ));
        }
        if stats.too_large > 0 {
            list.push(format!(
                "{} above the bound: too thin for a point inside",
                triangles(stats.too_large, "an area")
            ));
        }
        list
    }

    /// The same as data.
    #[must_use]
    pub fn json(&self) -> Value {
        let has_bound = self.angle_min_deg > 0.0;
        json!({
            "inserted": self.stats.inserted,
            "min_angle": has_bound.then_some(self.angle_min_deg),
            "smallest_angle": has_bound.then_some(self.stats.smallest_angle_deg),
            "triangles_below_min_angle": self.stats.small_angles,
            "triangles_above_max_area": self.stats.too_large,
        })
    }
}

fn triangles(n: u64, what: &str) -> String {
    if n == 1 {
        format!("1 triangle has {what}")
    } else {
        format!("{} triangles have {what}", count(n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refinement(small_angles: u64, too_large: u64, split_boundary: bool) -> Refinement {
        let stats = RefineStats {
            small_angles,
            too_large,
            smallest_angle_deg: 12.3456,
            ..RefineStats::default()
        };
        Refinement { stats, angle_min_deg: 20.0, split_boundary }
    }

    // spec: E5
    #[test]
    fn what_is_not_reached_is_said_with_the_reason() {
        let text = refinement(2, 0, false).sentences();
        assert_eq!(text.len(), 1);
        assert!(text[0].starts_with("2 triangles have an angle below 20 degrees"), "{}", text[0]);
        assert!(text[0].contains("12.346") && text[0].contains("--split-boundary"), "{}", text[0]);
        let text = refinement(1, 1, true).sentences();
        assert!(
            text[0].starts_with("1 triangle has") && !text[0].contains("--split"),
            "{}",
            text[0]
        );
        assert!(text[1].contains("too thin"), "{}", text[1]);
    }

    #[test]
    fn without_a_bound_on_angles_none_is_spoken_of() {
        let mut quiet = refinement(0, 0, false);
        assert_eq!(quiet.sentences().len(), 1);
        quiet.angle_min_deg = 0.0;
        assert!(quiet.sentences().is_empty());
        assert!(quiet.json()["smallest_angle"].is_null());
    }
}
