//! What is said of graded triangulation, judged from the figures of a run and from nothing else.

use super::{Figures, Row, Setting, System};
use serde::Serialize;

/// A statement and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Name in files.
    pub id: &'static str,
    /// The statement.
    pub statement: &'static str,
    /// How it is decided.
    pub rule: &'static str,
    /// Whether the report makes it; the others are ours.
    pub is_of_the_report: bool,
    /// One per domain, in the order of the rows.
    pub outcomes: Vec<Outcome>,
}

/// What became of a statement on one domain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Name of the domain.
    pub domain: &'static str,
    /// Whether it holds; `None` where the figures that decide it are missing.
    pub holds: Option<bool>,
    /// The figures in words.
    pub figures: String,
}

impl Claim {
    /// The domains on which it holds, does not hold, and cannot be judged.
    #[must_use]
    pub fn split(&self) -> [Vec<&Outcome>; 3] {
        [Some(true), Some(false), None]
            .map(|wanted| self.outcomes.iter().filter(|o| o.holds == wanted).collect())
    }

    /// One sentence: on how many domains it holds, and on which not.
    #[must_use]
    pub fn sentence(&self) -> String {
        let [holds, fails, open] = self.split();
        let names =
            |list: &[&Outcome]| list.iter().map(|o| o.domain).collect::<Vec<_>>().join(", ");
        let judged = holds.len() + fails.len();
        let mut text = match (holds.len(), fails.len()) {
            (0, 0) => "cannot be judged".to_owned(),
            (_, 0) => format!("holds on all {judged} domains judged"),
            (0, _) => format!("holds on none of {judged} domains"),
            (n, _) => format!("holds on {n} of {judged} domains, not on {}", names(&fails)),
        };
        if !open.is_empty() && judged > 0 {
            text += &format!("; not judged on {}", names(&open));
        }
        text
    }
}

/// How a pair of meshes of a domain decides a statement.
struct Rule {
    id: &'static str,
    statement: &'static str,
    rule: &'static str,
    is_of_the_report: bool,
    /// The two meshes that are compared.
    setting: Setting,
    systems: [System; 2],
    judge: fn(&Figures, &Figures) -> (Option<bool>, String),
}

/// Means that differ by less are called alike.
const MEAN_ALIKE: f64 = 0.01;
/// 99 % values that differ by less are called alike.
const P99_ALIKE: f64 = 0.05;
/// Far triangles are called sparse from this ratio on.
const SPARSE: f64 = 2.0;

const RULES: [Rule; 9] = [
    Rule {
        id: "dense-at-the-boundary",
        statement: "Graded triangulation is dense where the boundary is dense and sparse away \
                    from there.",
        rule: "The quarter of the triangles farthest from the shortest quarter of the boundary's \
               edges has edges at least twice as long as these.",
        is_of_the_report: true,
        setting: Setting::Own,
        systems: [System::Graded, System::Graded],
        judge: |graded, _| {
            let ratio = graded.far_over_dense;
            (Some(ratio >= SPARSE), format!("{ratio:.2} times as long"))
        },
    },
    Rule {
        id: "afm-clashes",
        statement: "Where its fronts meet the plain advancing front leaves worse slivers than \
                    graded triangulation.",
        rule: "Before any improvement the worst R/2r is lower; not judged where a corner of the \
               boundary makes it the same.",
        is_of_the_report: true,
        setting: Setting::Raw,
        systems: [System::Graded, System::Afm],
        judge: slivers,
    },
    Rule {
        id: "afm-clashes-improved",
        statement: "The same after flips, smoothing and repair.",
        rule: "In the finished meshes the worst R/2r is lower; not judged where a corner of the \
               boundary makes it the same.",
        is_of_the_report: false,
        setting: Setting::Own,
        systems: [System::Graded, System::Afm],
        judge: slivers,
    },
    Rule {
        id: "gentler-sizes",
        statement: "Sizes change more gently in a graded triangulation than in a plain advancing \
                    front.",
        rule: "The area ratio to neighbours that 99 % of the triangles keep is lower.",
        is_of_the_report: true,
        setting: Setting::Own,
        systems: [System::Graded, System::Afm],
        judge: |graded, afm| {
            let (g, a) = (graded.area_ratio_p99, afm.area_ratio_p99);
            (Some(g < a), format!("{g:.2} against {a:.2}"))
        },
    },
    Rule {
        id: "alike-at-equal-counts",
        statement: "At equal numbers of triangles graded triangulation and plain advancing front \
                    differ little.",
        rule: "Means of R/2r differ by at most 0.01 and 99 % values by at most 0.05, with numbers \
               of triangles within 5 % of each other.",
        is_of_the_report: true,
        setting: Setting::Equal,
        systems: [System::Graded, System::Afm],
        judge: |graded, afm| {
            let mean = (graded.ratio_mean - afm.ratio_mean).abs();
            let p99 = (graded.ratio_p99 - afm.ratio_p99).abs();
            (Some(mean <= MEAN_ALIKE && p99 <= P99_ALIKE), shapes(graded, afm))
        },
    },
    Rule {
        id: "third-is-finer",
        statement: "The literal field divided by three gives a finer mesh.",
        rule: "It has more triangles than the literal field's.",
        is_of_the_report: true,
        setting: Setting::Own,
        systems: [System::Third, System::Literal],
        judge: |third, literal| {
            let (t, l) = (third.triangles, literal.triangles);
            (Some(t > l), format!("{t} against {l} triangles"))
        },
    },
    Rule {
        id: "growth-beats-literal",
        statement: "Limited growth, the default here, gives better shapes than the literal field.",
        rule: "Mean and 99 % value of R/2r are both lower.",
        is_of_the_report: false,
        setting: Setting::Own,
        systems: [System::Graded, System::Literal],
        judge: better_shapes,
    },
    Rule {
        id: "background-beats-direct",
        statement: "Spacings from the background triangulation give better shapes than direct \
                    grading with as many triangles.",
        rule: "Mean and 99 % value of R/2r are both lower, with numbers of triangles within 5 %.",
        is_of_the_report: false,
        setting: Setting::Equal,
        systems: [System::Graded, System::Direct],
        judge: better_shapes,
    },
    Rule {
        id: "front-beats-refinement",
        statement: "A graded front gives better shapes than Delaunay refinement by areas with as \
                    many triangles.",
        rule: "Mean and 99 % value of R/2r are both lower, with numbers of triangles within 5 %.",
        is_of_the_report: false,
        setting: Setting::Equal,
        systems: [System::Graded, System::Delaunay],
        judge: better_shapes,
    },
];

fn slivers(graded: &Figures, other: &Figures) -> (Option<bool>, String) {
    let [g, o] = [graded, other];
    let text = format!(
        "worst R/2r {:.2} against {:.2}, smallest angle {:.1}° against {:.1}°",
        g.ratio_max, o.ratio_max, g.angle_min_deg, o.angle_min_deg
    );
    // A sharp corner of the boundary is the worst triangle of every mesh, to the last bits.
    let is_forced = (g.ratio_max - o.ratio_max).abs() <= 1e-9 * o.ratio_max;
    ((!is_forced).then_some(g.ratio_max < o.ratio_max), text)
}

fn better_shapes(one: &Figures, other: &Figures) -> (Option<bool>, String) {
    let is_better = one.ratio_mean < other.ratio_mean && one.ratio_p99 < other.ratio_p99;
    (Some(is_better), shapes(one, other))
}

fn shapes(one: &Figures, other: &Figures) -> String {
    format!(
        "mean {:.4} against {:.4}, 99 % {:.3} against {:.3}",
        one.ratio_mean, other.ratio_mean, one.ratio_p99, other.ratio_p99
    )
}

/// Judges every statement on every domain that has rows.
#[must_use]
pub fn claims(rows: &[Row]) -> Vec<Claim> {
    let mut domains: Vec<&'static str> = Vec::new();
    for row in rows {
        if !domains.contains(&row.domain) {
            domains.push(row.domain);
        }
    }
    let judge = |rule: &Rule| Claim {
        id: rule.id,
        statement: rule.statement,
        rule: rule.rule,
        is_of_the_report: rule.is_of_the_report,
        outcomes: domains.iter().map(|domain| outcome(rule, domain, rows)).collect(),
    };
    RULES.iter().map(judge).collect()
}

fn outcome(rule: &Rule, domain: &'static str, rows: &[Row]) -> Outcome {
    let found = rule.systems.map(|system| find(rows, domain, system, rule.setting));
    let open = |figures: String| Outcome { domain, holds: None, figures };
    let [Some(one), Some(other)] = found else { return open("not run".into()) };
    if let Some(missed) = [one, other].into_iter().find(|row| !row.is_on_target()) {
        let count = missed.figures.map_or_else(
            || "no mesh".to_owned(),
            |figures| format!("{} triangles", figures.triangles),
        );
        let target = missed.target.unwrap_or(0);
        return open(format!("{}: {count} where {target} were asked for", missed.system.name()));
    }
    match [one.figures, other.figures] {
        [Some(one), Some(other)] => {
            let (holds, figures) = (rule.judge)(&one, &other);
            Outcome { domain, holds, figures }
        }
        _ => open("no mesh".into()),
    }
}

/// The row of a domain, a system and a setting.
#[must_use]
pub fn find<'a>(
    rows: &'a [Row],
    domain: &str,
    system: System,
    setting: Setting,
) -> Option<&'a Row> {
    rows.iter().find(|r| r.domain == domain && r.system == system && r.setting == setting)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(triangles: usize, ratio: f64) -> Figures {
        Figures {
            triangles,
            points: triangles / 2,
            ratio_mean: ratio,
            ratio_p99: ratio + 0.1,
            ratio_max: ratio + 1.0,
            angle_min_deg: 60.0 / ratio,
            area_ratio_p99: 1.5 * ratio,
            far_over_dense: 2.5 / ratio,
            passed: true,
        }
    }

    fn row(system: System, setting: Setting, figures: Option<Figures>) -> Row {
        let target = (setting == Setting::Equal).then_some(100);
        Row { domain: "x", system, setting, target, figures, reason: None, seconds: 0.1 }
    }

    /// Rows of one domain in which each system's ratio is what `ratio` says.
    fn rows(ratio: impl Fn(System) -> f64) -> Vec<Row> {
        let each = |setting| {
            let ratio = &ratio;
            System::ALL.map(move |s| {
                let triangles = if s == System::Third { 104 } else { 100 };
                row(s, setting, Some(figures(triangles, ratio(s))))
            })
        };
        Setting::ALL.into_iter().flat_map(each).collect()
    }

    fn verdicts(rows: &[Row]) -> Vec<(&'static str, Option<bool>)> {
        claims(rows).iter().map(|claim| (claim.id, claim.outcomes[0].holds)).collect()
    }

    // spec: K33
    #[test]
    fn every_statement_holds_where_the_graded_mesh_is_better_and_fails_where_it_is_worse() {
        let better = rows(|s| if s == System::Graded { 1.03 } else { 1.035 });
        for (id, holds) in verdicts(&better) {
            assert_eq!(holds, Some(true), "{id}");
        }
        let worse = rows(|s| if s == System::Graded { 1.9 } else { 1.05 });
        for (id, holds) in verdicts(&worse) {
            // Finer is finer, whatever the shapes.
            assert_eq!(holds, Some(id == "third-is-finer"), "{id}");
        }
    }

    // spec: K33
    #[test]
    fn statements_on_equal_counts_are_open_where_the_counts_are_not_equal() {
        let mut rows = rows(|_| 1.05);
        for row in rows.iter_mut().filter(|r| r.setting == Setting::Equal) {
            row.target = Some(if row.system == System::Afm { 200 } else { 100 });
        }
        let all = claims(&rows);
        let alike = all.iter().find(|c| c.id == "alike-at-equal-counts").expect("it is judged");
        assert_eq!(alike.outcomes[0].holds, None);
        assert!(alike.outcomes[0].figures.contains("100 triangles where 200"), "{alike:?}");
        assert_eq!(alike.sentence(), "cannot be judged");
    }

    // spec: K33
    #[test]
    fn a_worst_triangle_that_the_boundary_forces_judges_nothing() {
        for claim in claims(&rows(|_| 1.05)).iter().filter(|c| c.id.starts_with("afm-clashes")) {
            assert_eq!(claim.outcomes[0].holds, None, "{claim:?}");
        }
    }

    // spec: K33
    #[test]
    fn a_mesh_that_is_missing_leaves_the_statement_open() {
        let mut rows = rows(|s| if s == System::Afm { 1.06 } else { 1.05 });
        rows.iter_mut().filter(|r| r.system == System::Graded).for_each(|r| r.figures = None);
        let without_graded = ["third-is-finer"];
        for claim in claims(&rows) {
            let is_open = claim.outcomes[0].holds.is_none();
            assert_eq!(is_open, !without_graded.contains(&claim.id), "{}", claim.id);
        }
        assert_eq!(claims(&[]).len(), RULES.len());
        assert!(claims(&[]).iter().all(|claim| claim.sentence() == "cannot be judged"));
    }

    #[test]
    fn a_sentence_names_where_it_does_not_hold() {
        let outcome = |domain, holds| Outcome { domain, holds, figures: String::new() };
        let mut claim = claims(&[]).remove(0);
        claim.outcomes = vec![outcome("a", Some(true)), outcome("b", Some(false))];
        assert_eq!(claim.sentence(), "holds on 1 of 2 domains, not on b");
        claim.outcomes.push(outcome("c", None));
        claim.outcomes[1].holds = Some(true);
        assert_eq!(claim.sentence(), "holds on all 2 domains judged; not judged on c");
        claim.outcomes[0].holds = Some(false);
        claim.outcomes[1].holds = Some(false);
        assert_eq!(claim.sentence(), "holds on none of 2 domains; not judged on c");
    }
}
