//! `trigrade explain ID`: the paragraph of SPEC.md behind an id.

use super::console::Console;
use super::failure::{Diagnostic, Failure};
use super::words::nearest;

/// The specification the program was built from.
const SPEC: &str = include_str!("../../SPEC.md");

/// One numbered invariant of the specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule<'a> {
    /// Letter and number, e.g. `M3`.
    pub id: &'a str,
    /// Dotted name, e.g. `mesh.positive`.
    pub slug: &'a str,
    /// The whole paragraph, id and strength included.
    pub text: &'a str,
}

/// All rules of a specification in the order of its chapters.
#[must_use]
pub fn rules(spec: &str) -> Vec<Rule<'_>> {
    spec.split("\n\n").flat_map(rules_of_paragraph).collect()
}

/// A paragraph holds one rule, or several whose heads each start a line.
fn rules_of_paragraph(paragraph: &str) -> Vec<Rule<'_>> {
    let starts: Vec<usize> = std::iter::once(0)
        .chain(paragraph.match_indices('\n').map(|(i, _)| i + 1))
        .filter(|&i| head(&paragraph[i..]).is_some())
        .collect();
    let ends = starts.iter().skip(1).copied().chain([paragraph.len()]);
    starts
        .iter()
        .zip(ends)
        .filter_map(|(&start, end)| {
            let text = paragraph[start..end].trim_end();
            head(text).map(|(id, slug)| Rule { id, slug, text })
        })
        .collect()
}

/// Id and slug when the text starts with `**ID** [slug]`.
fn head(text: &str) -> Option<(&str, &str)> {
    let (id, rest) = text.strip_prefix("**")?.split_once("**")?;
    let (slug, _) = rest.trim_start().strip_prefix('[')?.split_once(']')?;
    let digits = id.strip_prefix(|c: char| c.is_ascii_uppercase())?;
    let is_id = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    (is_id && !slug.contains('\n')).then_some((id, slug))
}

/// Prints one rule, or the list of all.
///
/// # Errors
/// Exit code 2 for an id that the specification does not have, with the nearest one.
pub fn run(id: Option<&str>, console: &Console) -> Result<(), Failure> {
    let rules = rules(SPEC);
    let Some(wanted) = id else {
        for rule in &rules {
            console.result(&format!("{:<5}{}", rule.id, rule.slug));
        }
        return Ok(());
    };
    match find(&rules, wanted) {
        Some(rule) => {
            console.result(rule.text);
            Ok(())
        }
        None => Err(unknown(&rules, wanted)),
    }
}

fn find<'a>(rules: &[Rule<'a>], wanted: &str) -> Option<Rule<'a>> {
    let matches = |rule: &&Rule<'_>| {
        rule.id.eq_ignore_ascii_case(wanted) || rule.slug.eq_ignore_ascii_case(wanted)
    };
    rules.iter().find(matches).copied()
}

fn unknown(rules: &[Rule<'_>], wanted: &str) -> Failure {
    let names = rules.iter().flat_map(|rule| [rule.id, rule.slug]);
    let mut diagnostic = Diagnostic::new(format!("the specification has no rule `{wanted}`"))
        .help("`trigrade explain` lists all rules");
    if let Some(near) = nearest(wanted, names) {
        diagnostic.helps.insert(0, format!("did you mean `{near}`?"));
    }
    Failure::cannot_run(diagnostic)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = "# title\n\nwords with **bold** [x] text\n\n**P1** [predicates.orient2d] \
        One.\n*strength:* sampled.\n\n**P2** [predicates.incircle] Two.\n*strength:* exact.\n\
        **P3** [third] Three.\n\n    **P9** [indented] an example\n\n**bold** [not an id]\n";

    // spec: K3
    #[test]
    fn rules_are_found_with_their_whole_paragraph() {
        let found = rules(SAMPLE);
        assert_eq!(found.iter().map(|rule| rule.id).collect::<Vec<_>>(), ["P1", "P2", "P3"]);
        assert_eq!(found[0].text, "**P1** [predicates.orient2d] One.\n*strength:* sampled.");
        assert_eq!(found[1].text, "**P2** [predicates.incircle] Two.\n*strength:* exact.");
    }

    #[test]
    fn ids_and_slugs_are_found_in_any_case() {
        let all = rules(SAMPLE);
        assert_eq!(find(&all, "p2").map(|rule| rule.id), Some("P2"));
        assert_eq!(find(&all, "Third").map(|rule| rule.id), Some("P3"));
        assert_eq!(find(&all, "P9"), None, "an indented example is no rule");
    }

    // spec: K3
    #[test]
    fn an_unknown_id_names_the_nearest() {
        let failure = unknown(&rules(SAMPLE), "predicates.orient3d");
        assert_eq!(failure.exit, 2);
        assert!(failure.diagnostics[0].helps[0].contains("predicates.orient2d"));
    }

    #[test]
    fn the_built_in_specification_has_rules() {
        assert!(find(&rules(SPEC), "K3").is_some(), "SPEC.md states the rule this test is for");
    }
}
