//! Curves in JSON, for loops of domains and for surface models (SPEC 12.1).

use super::domain_file::Problem;
use super::domain_json::{Item, Path, Read};
use crate::curve::Curve;
use crate::curve::discretize::{Rule, nodes, points};
use crate::domain::Place;
use crate::vector::{Vector, distance, key};
use serde_json::Value;

/// The keys of a curve.
pub(super) const KEYS: [&str; 15] = [
    "kind",
    "points",
    "degree",
    "knots",
    "weights",
    "periodic",
    "centre",
    "normal",
    "from",
    "spacing",
    "count",
    "chord_error",
    "graded",
    "marker",
    "name",
];

impl Item<'_> {
    /// A point of space; z = 0 when the file gives two coordinates.
    pub fn vector(self) -> Read<Vector> {
        let items = self.array("a point [x, y] or [x, y, z]")?;
        if !(2..=3).contains(&items.len()) {
            return Err(self.expected("a point [x, y] or [x, y, z]"));
        }
        let mut vector = [0.0; 3];
        for (i, value) in items.iter().enumerate() {
            vector[i] = Item { value, path: &Path::Index(self.path, i) }.number()?;
        }
        Ok(vector)
    }

    pub fn vectors(self) -> Read<Vec<Vector>> {
        let mut list = Vec::new();
        self.each("an array of points", |item| {
            list.push(item.vector()?);
            Ok(())
        })?;
        Ok(list)
    }

    pub fn numbers(self) -> Read<Vec<f64>> {
        let mut list = Vec::new();
        self.each("an array of numbers", |item| {
            list.push(item.number()?);
            Ok(())
        })?;
        Ok(list)
    }

    /// The value of a key that must be there.
    pub fn required<T>(self, key: &'static str, then: impl FnOnce(Item) -> Read<T>) -> Read<T> {
        self.key(key, then)?.ok_or_else(|| self.error(Problem::MissingKey(key)))
    }

    pub fn flag(self, key: &'static str) -> Read<bool> {
        let read = |item: Item| item.value.as_bool().ok_or_else(|| item.expected("true or false"));
        Ok(self.key(key, read)?.unwrap_or(false))
    }

    pub fn degree(self) -> Read<usize> {
        self.integer("a degree", 1, 15).map(|degree| degree as usize)
    }

    pub fn text(self, what: &'static str) -> Read<String> {
        self.value.as_str().map(str::to_owned).ok_or_else(|| self.expected(what))
    }
}

/// A curve.
pub(super) fn read(item: Item) -> Read<Curve> {
    item.only_keys(&KEYS)?;
    let kind = item.required("kind", |item| item.text("the kind of a curve"))?;
    let curve = match kind.as_str() {
        "polyline" => Curve::polyline(item.required("points", |item| item.vectors())?),
        "bspline" => read_spline(item)?,
        "arc" => match item.required("points", |item| item.vectors())?[..] {
            [from, via, to] => Curve::arc(from, via, to),
            ref list => {
                let found = list.len();
                let problem = Problem::Length { what: "points of an arc", found, expected: 3 };
                return Err(item.error(problem));
            }
        },
        "circle" => {
            let vector = |key| item.required(key, |item: Item| item.vector());
            let normal = item.key("normal", |item| item.vector())?.unwrap_or([0.0, 0.0, 1.0]);
            Curve::circle(vector("centre")?, normal, vector("from")?)
        }
        _ => {
            let what = "a kind of curve: polyline, bspline, arc or circle";
            return Err(item.expected_value("kind", what));
        }
    };
    curve.map_err(|error| item.error(error.into()))
}

impl Item<'_> {
    /// The complaint that the value of a key is not what was expected.
    pub fn expected_value(
        self,
        key: &'static str,
        what: &'static str,
    ) -> super::domain_file::DomainReadError {
        let value = self.value.get(key).unwrap_or(&Value::Null);
        Item { value, path: &Path::Key(self.path, key) }.expected(what)
    }
}

fn read_spline(item: Item) -> Read<Result<Curve, crate::curve::CurveError>> {
    let points = item.required("points", |item| item.vectors())?;
    let degree = item.key("degree", |item| item.degree())?.unwrap_or(3);
    let knots = item.key("knots", |item| item.numbers())?;
    let weights = item.key("weights", |item| item.numbers())?;
    if item.flag("periodic")? {
        if knots.is_some() || weights.is_some() {
            return Err(item.error(Problem::Excluded("'periodic'", "'knots' and 'weights'")));
        }
        return Ok(Curve::periodic(degree, points));
    }
    let knots = knots.unwrap_or_else(|| crate::curve::clamped_knots(degree, points.len()));
    Ok(Curve::new(degree, knots, points, weights.unwrap_or_default()))
}

/// How a curve is cut into edges, if the file says so; at most one way.
pub(super) fn read_rule(item: Item) -> Read<Option<Rule>> {
    let number = |key| item.key(key, |item: Item| item.number());
    let count = item.key("count", |item| item.integer("a count", 1, 10_000_000))?;
    let graded = item.key("graded", |item| match item.numbers()?[..] {
        [from, to] => Ok(Rule::Graded(from, to)),
        _ => Err(item.expected("two spacings")),
    })?;
    let rules: Vec<Rule> = [
        number("spacing")?.map(Rule::Spacing),
        count.map(|n| Rule::Count(n as usize)),
        number("chord_error")?.map(Rule::ChordError),
        graded,
    ]
    .into_iter()
    .flatten()
    .collect();
    match rules[..] {
        [] => Ok(None),
        [rule] => Ok(Some(rule)),
        _ => Err(item.error(Problem::Excluded(
            "two of 'spacing', 'count', 'chord_error', 'graded'",
            "each other",
        ))),
    }
}

/// The points of each curve of a closed chain but its last, the curve's marker and place.
pub(super) type Chain = Vec<(Vec<Vector>, Option<i32>, Place)>;

/// A closed chain of curves, cut into edges; a piecewise linear one without a rule keeps its points.
pub(super) fn chain(item: Item) -> Read<Chain> {
    let mut chain: Vec<(Vec<Vector>, Option<i32>, Place)> = Vec::new();
    item.each("an array of curves", |item| {
        let curve = read(item)?;
        let rule = match read_rule(item)? {
            Some(rule) => rule,
            None if curve.degree() == 1 => Rule::Corners,
            None => return Err(item.error(Problem::MissingKey("spacing"))),
        };
        let nodes = nodes(&curve, rule).map_err(|error| item.error(error.into()))?;
        let marker = item.key("marker", |item| item.marker())?;
        let points = points(&curve, &nodes);
        if let Some(error) = chain.last().and_then(|(before, ..)| joint(before, &points)) {
            return Err(item.error(error));
        }
        if let Some(flat) = points.iter().position(|p| p[2] != 0.0) {
            let found = format!("the height {}", points[flat][2]);
            return Err(item.error(Problem::Expected { what: "a curve of the plane", found }));
        }
        chain.push((points, marker, item.place()));
        Ok(())
    })?;
    if let (Some((last, ..)), Some((first, ..))) = (chain.last(), chain.first())
        && let Some(error) = joint(last, first)
    {
        return Err(item.error(error));
    }
    for (points, ..) in &mut chain {
        points.pop();
    }
    Ok(chain)
}

/// The gap between the end of one curve and the start of the next, if there is one.
fn joint(before: &[Vector], after: &[Vector]) -> Option<Problem> {
    let (&from, &to) = (before.last()?, after.first()?);
    (key(from) != key(to)).then(|| Problem::Joint { gap: distance(from, to), from, to })
}
