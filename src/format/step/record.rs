//! Records of a STEP file, parsed when they are asked for, and what they hold.

use super::super::domain_file::{DomainReadError, Problem};
use super::Read;
use super::scan::Statement;
use crate::domain::Place;
use crate::vector::{Vector, along, cross, dot, sub, unit};
use ruststep::ast::{EntityInstance, Name, Parameter, Record};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::str::FromStr;

/// Bytes of records that may be parsed for each byte of the file: a record that is used twice is
/// parsed twice.
const UNFOLDING: usize = 64;

/// What is said where they are more.
const TOO_MUCH: &str = "the references of the file unfold to many times its size";

pub(super) struct Records<'a> {
    statements: BTreeMap<u64, Statement<'a>>,
    /// Bytes that may still be parsed.
    budget: Cell<usize>,
    /// Where the part stands that is being read.
    place: Cell<Rigid>,
}

/// A map that keeps lengths: what becomes of the three axes, and of the origin.
#[derive(Clone, Copy)]
pub(super) struct Rigid {
    axes: [Vector; 3],
    shift: Vector,
}

impl Rigid {
    pub(super) const IDENTITY: Self =
        Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };

    /// The map that brings one frame to another.
    pub(super) fn between(from: &Frame, to: &Frame) -> Self {
        let same = from.origin == to.origin && from.axes == to.axes;
        if same {
            return Self::IDENTITY;
        }
        let image = |p: Vector| {
            let parts = from.axes.map(|axis| dot(axis, p));
            (0..3).fold([0.0; 3], |sum, i| along(sum, parts[i], to.axes[i]))
        };
        let axes = Self::IDENTITY.axes.map(image);
        Self { axes, shift: sub(to.origin, image(from.origin)) }
    }

    fn vector(&self, p: Vector) -> Vector {
        if self.axes == Self::IDENTITY.axes {
            return p;
        }
        (0..3).fold([0.0; 3], |sum, i| along(sum, p[i], self.axes[i]))
    }

    fn point(&self, p: Vector) -> Vector {
        if self.shift == [0.0; 3] { self.vector(p) } else { along(self.vector(p), 1.0, self.shift) }
    }

    /// This map after another.
    pub(super) fn after(&self, first: &Self) -> Self {
        Self { axes: first.axes.map(|axis| self.vector(axis)), shift: self.point(first.shift) }
    }
}

/// A record.
pub(super) struct Entity {
    pub(super) id: u64,
    line: u64,
    /// One, or the parts of a complex record.
    parts: Vec<Record>,
}

/// The parameters of a record, or of a part of one.
pub(super) struct Fields<'e> {
    entity: &'e Entity,
    list: &'e [Parameter],
}

/// A frame: its origin, and unit vectors x, y, z across each other.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    pub(super) origin: Vector,
    pub(super) axes: [Vector; 3],
}

fn problem(text: String, line: u64) -> DomainReadError {
    Problem::Step(text).at(Place::Line(line))
}

impl<'a> Records<'a> {
    pub(super) fn new(statements: BTreeMap<u64, Statement<'a>>, size: usize) -> Self {
        let budget = Cell::new(UNFOLDING.saturating_mul(size));
        Self { statements, budget, place: Cell::new(Rigid::IDENTITY) }
    }

    /// From now on points and directions are those of a part that stands there.
    pub(super) fn stand(&self, place: Rigid) {
        self.place.set(place);
    }

    /// The representations of shapes, in the order of their numbers.
    pub(super) fn representations(&self) -> impl Iterator<Item = u64> + '_ {
        let is_one = |statement: &Statement| {
            let text = statement.text.split_once('=').map_or("", |(_, text)| text.trim_start());
            let end = text.find('(').unwrap_or(0);
            let kind = text[..end].trim_end();
            // That one says where a part stands, and has no items.
            kind.ends_with("SHAPE_REPRESENTATION") && !kind.starts_with("CONTEXT_DEPENDENT")
        };
        self.statements.iter().filter(move |(_, s)| is_one(s)).map(|(&id, _)| id)
    }

    /// Pays for work of this many bytes.
    pub(super) fn spend(&self, bytes: usize, entity: &Entity) -> Read<()> {
        match self.budget.get().checked_sub(bytes) {
            Some(left) => {
                self.budget.set(left);
                Ok(())
            }
            None => Err(problem(TOO_MUCH.to_owned(), entity.line)),
        }
    }

    /// The records of some kinds in the order of their numbers, found without parsing.
    pub(super) fn of_kinds<'k>(&'k self, kinds: &'k [&str]) -> impl Iterator<Item = u64> + 'k {
        let is_one = |statement: &Statement| {
            let text = statement.text.split_once('=').map_or("", |(_, text)| text.trim_start());
            let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            kinds.contains(&&text[..end.unwrap_or(text.len())])
        };
        self.statements.iter().filter(move |(_, s)| is_one(s)).map(|(&id, _)| id)
    }

    /// The complex records that have a part.
    pub(super) fn with_part<'k>(&'k self, part: &'k str) -> impl Iterator<Item = u64> + 'k {
        let has = move |s: &Statement| {
            s.text
                .split_once('=')
                .is_some_and(|(_, t)| t.trim_start().starts_with('(') && t.contains(part))
        };
        self.statements.iter().filter(move |(_, s)| has(s)).map(|(&id, _)| id)
    }

    pub(super) fn entity(&self, id: u64) -> Read<Entity> {
        let Some(&Statement { line, text }) = self.statements.get(&id) else {
            return Err(Problem::Step(format!("record #{id} is not in the file")).at(Place::Made));
        };
        let Some(left) = self.budget.get().checked_sub(text.len()) else {
            return Err(problem(TOO_MUCH.to_owned(), line));
        };
        self.budget.set(left);
        let whole = format!("{text};");
        // The parser is another's: if it panics on what nobody foresaw, the file is at fault for its
        // user, not the program. It holds nothing that could be left half done.
        let parsed = catch_unwind(|| EntityInstance::from_str(&whole).ok()).ok().flatten();
        let parts = match parsed {
            Some(EntityInstance::Simple { record, .. }) => vec![record],
            Some(EntityInstance::Complex { subsuper, .. }) if !subsuper.0.is_empty() => subsuper.0,
            _ => return Err(problem(format!("record #{id} is not well formed"), line)),
        };
        Ok(Entity { id, line, parts })
    }

    /// Radians in the unit of plane angles: of a degree where one is defined, else 1.
    pub(super) fn counts_degrees(&self) -> Read<f64> {
        for id in self.with_part("PLANE_ANGLE_UNIT") {
            let entity = self.entity(id)?;
            if let Some(unit) = entity.part("CONVERSION_BASED_UNIT") {
                let name = unit.text(0).unwrap_or_default().to_ascii_uppercase();
                return match name.as_str() {
                    "DEGREE" | "DEGREES" => Ok(std::f64::consts::PI / 180.0),
                    _ => {
                        Err(entity
                            .fail("a unit of angles other than radian and degree is not read"))
                    }
                };
            }
        }
        Ok(1.0)
    }

    /// The distance that the file says is none; 0 where it says nothing.
    pub(super) fn uncertainty(&self) -> Read<f64> {
        let Some(id) = self.of_kinds(&["UNCERTAINTY_MEASURE_WITH_UNIT"]).next() else {
            return Ok(0.0);
        };
        let entity = self.entity(id)?;
        let fields = entity.fields(None)?;
        let value = match fields.list.first() {
            Some(Parameter::Typed { parameter, .. }) => real(parameter),
            _ => None,
        };
        Ok(value.filter(|x| x.is_finite() && *x >= 0.0).unwrap_or(0.0))
    }

    /// A note of the unit of length.
    pub(super) fn lengths(&self) -> Read<String> {
        for id in self.with_part("LENGTH_UNIT") {
            let entity = self.entity(id)?;
            if entity.part("LENGTH_UNIT").is_none() {
                continue;
            }
            if let Some(unit) = entity.part("CONVERSION_BASED_UNIT") {
                let name = unit.text(0).unwrap_or_default().to_ascii_lowercase();
                return Ok(format!("lengths are in the unit {name:?}, as in the file"));
            }
            if let Some(unit) = entity.part("SI_UNIT") {
                let prefix = unit.text(0).unwrap_or_default().to_ascii_lowercase();
                return Ok(format!("lengths are in {prefix}metres, as in the file"));
            }
        }
        Ok("the file does not say the unit of its lengths".to_owned())
    }

    /// A point.
    pub(super) fn point(&self, id: u64) -> Read<Vector> {
        Ok(self.place.get().point(self.triple(id, "CARTESIAN_POINT")?))
    }

    /// A direction, of any length.
    fn direction(&self, id: u64) -> Read<Vector> {
        Ok(self.place.get().vector(self.triple(id, "DIRECTION")?))
    }

    /// The direction of a vector, of length 1.
    pub(super) fn vector(&self, id: u64) -> Read<Vector> {
        let entity = self.entity(id)?;
        if entity.kind() != "VECTOR" {
            return Err(entity.fail("a VECTOR should be here"));
        }
        let direction = self.direction(entity.fields(None)?.reference(1, "the direction")?)?;
        unit(direction).ok_or_else(|| entity.fail("a direction has a length"))
    }

    /// A point of a line, and its direction.
    pub(super) fn line(&self, line: &Entity) -> Read<[Vector; 2]> {
        let fields = line.fields(None)?;
        let point = self.point(fields.reference(1, "a point")?)?;
        Ok([point, self.vector(fields.reference(2, "a vector")?)?])
    }

    /// A point of an axis, and its direction.
    pub(super) fn axis(&self, id: u64) -> Read<[Vector; 2]> {
        let entity = self.entity(id)?;
        if entity.kind() != "AXIS1_PLACEMENT" {
            return Err(entity.fail("an AXIS1_PLACEMENT should be here"));
        }
        let fields = entity.fields(None)?;
        let point = self.point(fields.reference(1, "the origin")?)?;
        let direction = match fields.list.get(2) {
            None | Some(Parameter::NotProvided | Parameter::Omitted) => {
                self.place.get().vector([0.0, 0.0, 1.0])
            }
            _ => self.direction(fields.reference(2, "the direction")?)?,
        };
        let direction = unit(direction).ok_or_else(|| entity.fail("a direction has a length"))?;
        Ok([point, direction])
    }

    fn triple(&self, id: u64, kind: &str) -> Read<Vector> {
        let entity = self.entity(id)?;
        if entity.kind() != kind {
            return Err(entity.fail(&format!("a {kind} should be here")));
        }
        let numbers = entity.fields(None)?.reals(1, "the coordinates")?;
        numbers.try_into().map_err(|_| entity.fail("three coordinates should be here"))
    }

    /// A vertex.
    pub(super) fn vertex(&self, id: u64) -> Read<Vector> {
        let entity = self.entity(id)?;
        if entity.kind() != "VERTEX_POINT" {
            return Err(entity.fail("a VERTEX_POINT should be here"));
        }
        self.point(entity.fields(None)?.reference(1, "the point")?)
    }

    /// A frame, whose x may be any direction across z where the file does not say it.
    pub(super) fn frame(&self, id: u64) -> Read<Frame> {
        let entity = self.entity(id)?;
        if entity.kind() != "AXIS2_PLACEMENT_3D" {
            return Err(entity.fail("an AXIS2_PLACEMENT_3D should be here"));
        }
        let fields = entity.fields(None)?;
        let origin = self.point(fields.reference(1, "the origin")?)?;
        let direction = |i: usize| -> Read<Option<Vector>> {
            match fields.list.get(i) {
                None | Some(Parameter::NotProvided | Parameter::Omitted) => Ok(None),
                _ => Ok(Some(self.direction(fields.reference(i, "a direction")?)?)),
            }
        };
        let up = self.place.get().vector([0.0, 0.0, 1.0]);
        let axis = direction(2)?.unwrap_or(up);
        let least = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
        let mut aside = [0.0; 3];
        aside[least] = 1.0;
        let towards = direction(3)?.unwrap_or(aside);
        let frame = unit(axis).and_then(|z| {
            let x = unit(along(towards, -dot(towards, z), z))?;
            Some(Frame { origin, axes: [x, cross(z, x), z] })
        });
        frame.ok_or_else(|| entity.fail("the directions make no frame"))
    }
}

impl Entity {
    /// The kind; of a complex record the last part that says one.
    pub(super) fn kind(&self) -> &str {
        let shapes = |name: &str| name.contains("B_SPLINE") || name.contains("BEZIER");
        let part = self.parts.iter().find(|part| shapes(&part.name)).unwrap_or(&self.parts[0]);
        &part.name
    }

    pub(super) fn fail(&self, text: &str) -> DomainReadError {
        problem(format!("#{} ({}): {text}", self.id, self.kind()), self.line)
    }

    /// The place of the record.
    pub(super) fn at(&self, problem: Problem) -> DomainReadError {
        problem.at(Place::Line(self.line))
    }

    /// A part of a complex record.
    pub(super) fn part(&self, name: &str) -> Option<Fields<'_>> {
        let part = self.parts.iter().find(|part| part.name == name)?;
        let Parameter::List(list) = &part.parameter else { return None };
        Some(Fields { entity: self, list })
    }

    /// The parameters of a simple record, or of a part.
    pub(super) fn fields(&self, part: Option<&str>) -> Read<Fields<'_>> {
        let name = part.unwrap_or(&self.parts[0].name);
        self.part(name).ok_or_else(|| self.fail(&format!("{name} is missing")))
    }

    pub(super) fn is_complex(&self) -> bool {
        self.parts.len() > 1
    }
}

fn real(parameter: &Parameter) -> Option<f64> {
    match parameter {
        Parameter::Real(x) => Some(*x),
        Parameter::Integer(i) => Some(*i as f64),
        _ => None,
    }
}

fn reference(parameter: &Parameter) -> Option<u64> {
    match parameter {
        Parameter::Ref(Name::Entity(id)) => Some(*id),
        _ => None,
    }
}

fn count(parameter: &Parameter) -> Option<usize> {
    match parameter {
        Parameter::Integer(i) => usize::try_from(*i).ok(),
        _ => None,
    }
}

impl Fields<'_> {
    fn get<T>(&self, i: usize, what: &str, of: impl Fn(&Parameter) -> Option<T>) -> Read<T> {
        let found = self.list.get(i).and_then(of);
        found.ok_or_else(|| self.entity.fail(&format!("{what} should be parameter {}", i + 1)))
    }

    fn all<T>(&self, i: usize, what: &str, of: impl Fn(&Parameter) -> Option<T>) -> Read<Vec<T>> {
        self.get(i, what, |parameter| match parameter {
            Parameter::List(list) => list.iter().map(&of).collect(),
            _ => None,
        })
    }

    pub(super) fn reference(&self, i: usize, what: &str) -> Read<u64> {
        self.get(i, what, reference)
    }

    pub(super) fn references(&self, i: usize, what: &str) -> Read<Vec<u64>> {
        self.all(i, what, reference)
    }

    /// All records that the parameters name, in lists too.
    pub(super) fn mentioned(&self) -> Vec<u64> {
        let of = |parameter: &Parameter| match parameter {
            Parameter::List(list) => list.iter().filter_map(reference).collect(),
            other => reference(other).into_iter().collect::<Vec<u64>>(),
        };
        self.list.iter().flat_map(of).collect()
    }

    /// Rows of references.
    pub(super) fn grid(&self, i: usize, what: &str) -> Read<Vec<Vec<u64>>> {
        self.all(i, what, |row| match row {
            Parameter::List(list) => list.iter().map(reference).collect(),
            _ => None,
        })
    }

    pub(super) fn real_grid(&self, i: usize, what: &str) -> Read<Vec<Vec<f64>>> {
        self.all(i, what, |row| match row {
            Parameter::List(list) => list.iter().map(real).collect(),
            _ => None,
        })
    }

    pub(super) fn real(&self, i: usize, what: &str) -> Read<f64> {
        self.get(i, what, |p| real(p).filter(|x| x.is_finite()))
    }

    /// A length above 0.
    pub(super) fn length(&self, i: usize, what: &str) -> Read<f64> {
        self.get(i, &format!("{what}, above 0,"), |p| real(p).filter(|x| x.is_finite() && *x > 0.0))
    }

    pub(super) fn reals(&self, i: usize, what: &str) -> Read<Vec<f64>> {
        self.all(i, what, |p| real(p).filter(|x| x.is_finite()))
    }

    pub(super) fn count(&self, i: usize, what: &str) -> Read<usize> {
        self.get(i, what, count)
    }

    /// Knots: their values, each as often as said. `most` bounds how many there are.
    pub(super) fn knots(&self, [times, values]: [usize; 2], most: usize) -> Read<Vec<f64>> {
        let times = self.all(times, "how often each knot is there", count)?;
        let values = self.reals(values, "the knots")?;
        let total = times.iter().fold(0_usize, |sum, &n| sum.saturating_add(n));
        if times.len() != values.len() || total != most {
            let text =
                format!("{total} knots of {} values, but there must be {most}", values.len());
            return Err(self.entity.fail(&text));
        }
        let each = times.iter().zip(&values);
        Ok(each.flat_map(|(&n, &x)| std::iter::repeat_n(x, n)).collect())
    }

    /// `.T.` or `.F.`
    pub(super) fn flag(&self, i: usize, what: &str) -> Read<bool> {
        self.get(i, &format!("{what}, .T. or .F.,"), |parameter| match parameter {
            Parameter::Enumeration(word) if word == "T" => Some(true),
            Parameter::Enumeration(word) if word == "F" => Some(false),
            _ => None,
        })
    }

    /// Whether a parameter is `.T.`: what is not known is taken for false.
    pub(super) fn says(&self, i: usize) -> bool {
        matches!(self.list.get(i), Some(Parameter::Enumeration(word)) if word == "T")
    }

    /// A string or an enumeration.
    fn text(&self, i: usize) -> Option<&str> {
        match self.list.get(i)? {
            Parameter::String(text) | Parameter::Enumeration(text) => Some(text),
            _ => None,
        }
    }
}
