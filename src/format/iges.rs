//! IGES files (5.3, fixed-length ASCII): faces of surfaces with the curves around them, as a model.
//!
//! Read are trimmed surfaces (144 with 142), bounded surfaces (143 with 141), and B-splines (128),
//! surfaces of revolution (120), tabulated cylinders (122) and bounded planes (108) that stand for
//! themselves; curves are lines (110), arcs (100), polylines (106), B-splines (126) and what is composed
//! of them (102); matrices (124) are applied. IGES has no name for an edge that two faces share. Curves
//! that agree within the resolution that the file states of itself are made one curve of the model
//! (SPEC 13.4).
//!
//! Source: "Initial Graphics Exchange Specification 5.3", US PRO/IPO-100, 1996.

mod boundary;
mod card;
mod curve;
mod directory;
mod fields;
mod surface;

use super::domain_file::{DomainReadError, Problem, without_mark};
use crate::domain::Place;
use crate::model::{Model, Patch};
use crate::vector::{Vector, add, cross, dot};
use boundary::Ring;
use card::{Global, Sections};
use directory::Entity;
use fields::Fields;
use std::collections::{BTreeMap, BTreeSet};

type Read<T> = Result<T, DomainReadError>;

/// References deeper than this are nobody's.
const DEEPEST: usize = 24;
/// Bytes of records that may be read for each byte of the file: a record that is used twice is read
/// twice.
const UNFOLDING: usize = 64;
/// A resolution larger than this fraction of the model's size is not believed.
const RESOLUTION_MAX: f64 = 1e-4;

/// Reads the faces of an IGES file. Each is a patch called after its place in the directory (`D35`),
/// with its number from 1 as marker; [`Model::notes`] tell the unit and what was left out.
///
/// # Errors
/// The first thing that keeps the file from being understood, with its line. Memory and time are
/// bounded by a multiple of the file's size.
pub fn read(bytes: &[u8]) -> Result<Model, DomainReadError> {
    let sections = Sections::of(without_mark(bytes))?;
    let global = Global::of(sections.global())?;
    let entities = directory::read(sections.directory(), sections.parameters().len())?;
    let budget = UNFOLDING.saturating_mul(bytes.len());
    let mut reader = Reader { sections: &sections, global, entities, path: Vec::new(), budget };
    reader.model()
}

/// An affine map: a matrix and a shift.
#[derive(Clone, Copy, Debug)]
struct Affine {
    rows: [Vector; 3],
    shift: Vector,
}

impl Affine {
    const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };

    fn vector(&self, p: Vector) -> Vector {
        self.rows.map(|row| dot(row, p))
    }

    fn point(&self, p: Vector) -> Vector {
        add(self.vector(p), self.shift)
    }

    fn determinant(&self) -> f64 {
        dot(self.rows[0], cross(self.rows[1], self.rows[2]))
    }

    /// Whether it keeps lengths, as far as the digits of a file tell.
    fn is_rigid(&self) -> bool {
        (0..3).all(|i| {
            (0..3).all(|j| {
                let wanted = if i == j { 1.0 } else { 0.0 };
                (dot(self.rows[i], self.rows[j]) - wanted).abs() <= 1e-6
            })
        })
    }

    /// This map after another.
    fn after(&self, first: &Self) -> Self {
        let column = |k: usize| self.vector(first.rows.map(|row| row[k]));
        let columns = [column(0), column(1), column(2)];
        let rows = [0, 1, 2].map(|i| columns.map(|column| column[i]));
        Self { rows, shift: self.point(first.shift) }
    }
}

impl Entity {
    fn place(&self) -> Place {
        Place::Line(self.line)
    }
}

struct Reader<'a> {
    sections: &'a Sections<'a>,
    global: Global,
    entities: Vec<Entity>,
    /// The entities being read, each a part of the one before.
    path: Vec<usize>,
    /// Bytes of records that may still be read.
    budget: usize,
}

impl<'a> Reader<'a> {
    /// The entity that a pointer names.
    fn index(&self, pointer: i64, what: &'static str) -> Read<usize> {
        let index = usize::try_from(pointer).ok().filter(|p| p % 2 == 1).map(|p| p / 2);
        match index.filter(|&index| index < self.entities.len()) {
            Some(index) => Ok(index),
            None => {
                let high = 2 * self.entities.len() as i64 - 1;
                let text = format!(
                    "{what} is {pointer}, but must be an odd number from 1 to {high}: the place of an entity in the directory"
                );
                let place = self.path.last().map_or(Place::Made, |&i| self.entities[i].place());
                Err(Problem::Entity(text).at(place))
            }
        }
    }

    /// Reads on as a part of an entity, which must not be a part of itself.
    fn within<T>(&mut self, pointer: i64, read: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        let index = self.index(pointer, "a pointer")?;
        let fault = match self.path.contains(&index) {
            true => Some("the entity is a part of itself"),
            false => (self.path.len() >= DEEPEST).then_some("the references go too deep"),
        };
        if let Some(fault) = fault {
            return Err(Problem::Entity(fault.to_owned()).at(self.entities[index].place()));
        }
        self.path.push(index);
        let outcome = read(self);
        self.path.pop();
        outcome
    }

    /// The parameters of an entity, behind its type number.
    fn open(&mut self, index: usize) -> Read<Fields<'a>> {
        let entity = self.entities[index];
        let [first, count] = entity.lines;
        let cards = &self.sections.parameters()[first..first + count];
        let mut fields = Fields::of(cards, &self.global)?;
        let Some(left) = self.budget.checked_sub(fields.size()) else {
            let text = "the references of the file unfold to many times its size".to_owned();
            return Err(Problem::Entity(text).at(entity.place()));
        };
        self.budget = left;
        let kind = fields.int("the type of the entity")?;
        if kind != entity.kind {
            let (what, found) = ("the type that the directory has", kind.to_string());
            return Err(fields.fail(Problem::Expected { what, found }));
        }
        Ok(fields)
    }

    /// Reads an entity with its own map under an outer one.
    fn enter<T>(
        &mut self,
        pointer: i64,
        what: &'static str,
        outer: &Affine,
        read: impl FnOnce(&mut Self, &mut Fields<'a>, &Affine) -> Read<T>,
    ) -> Read<T> {
        let index = self.index(pointer, what)?;
        self.within(pointer, |reader| {
            let map = match reader.entities[index].matrix {
                0 => *outer,
                matrix => outer.after(&reader.matrix(matrix)?),
            };
            let mut fields = reader.open(index)?;
            read(reader, &mut fields, &map)
        })
    }

    /// A matrix, after the one that it has itself.
    fn matrix(&mut self, pointer: i64) -> Read<Affine> {
        let what = "a matrix";
        let index = self.index(pointer, what)?;
        if self.entities[index].kind != 124 {
            let text =
                format!("the entity's matrix is of type {}, not 124", self.entities[index].kind);
            return Err(Problem::Entity(text).at(self.entities[index].place()));
        }
        self.enter(pointer, what, &Affine::IDENTITY, |_, fields, outer| {
            let numbers = fields.reals("a number of a matrix", 12)?;
            let row = |i: usize| [numbers[4 * i], numbers[4 * i + 1], numbers[4 * i + 2]];
            let own = Affine {
                rows: [row(0), row(1), row(2)],
                shift: [numbers[3], numbers[7], numbers[11]],
            };
            Ok(outer.after(&own))
        })
    }

    fn model(&mut self) -> Read<Model> {
        let mut model = Model { notes: vec![self.lengths()], ..Model::default() };
        let used = self.used_surfaces()?;
        let mut left_out: BTreeMap<i64, usize> = BTreeMap::new();
        for i in 0..self.entities.len() {
            let entity = self.entities[i];
            let alone = !entity.is_part && !used.contains(&i);
            let is_face = match entity.kind {
                108 => entity.form == 1 && alone,
                143 | 144 => true,
                kind => surface::KINDS.contains(&kind) && alone,
            };
            if is_face && !entity.is_blank {
                self.face(i, &mut model)?;
            } else if alone && is_shape(entity.kind) {
                *left_out.entry(entity.kind).or_default() += 1;
            }
        }
        let list: Vec<String> =
            left_out.iter().map(|(kind, count)| format!("{count} of type {kind}")).collect();
        if model.patches.is_empty() {
            let has = if list.is_empty() { "nothing".to_owned() } else { list.join(", ") };
            let text = format!(
                "the file has no face that is read: trimmed surfaces (144), bounded surfaces (143), B-spline surfaces (128), of revolution (120), tabulated cylinders (122). It has {has}; export surfaces with their boundaries, not solids"
            );
            return Err(Problem::Entity(text).at(Place::Made));
        }
        if !list.is_empty() {
            model.notes.push(format!("left out of the file: {} (IGES types)", list.join(", ")));
        }
        self.join(&mut model);
        Ok(model)
    }

    /// The surfaces that faces are made of.
    fn used_surfaces(&mut self) -> Read<BTreeSet<usize>> {
        let mut used = BTreeSet::new();
        for i in 0..self.entities.len() {
            let skip = match self.entities[i].kind {
                144 => 0,
                143 => 1,
                _ => continue,
            };
            let mut fields = self.open(i)?;
            for _ in 0..skip {
                fields.int("the type of the surface")?;
            }
            let pointer = fields.int("a pointer to a surface")?;
            self.path.push(i);
            used.insert(self.index(pointer, "a pointer to a surface")?);
            self.path.pop();
        }
        Ok(used)
    }

    fn lengths(&self) -> String {
        let Global { unit, scale, .. } = &self.global;
        let scaled = match *scale == 1.0 {
            true => String::new(),
            false => format!(" at a scale of {scale}, which is not taken out"),
        };
        format!("lengths are in {unit}{scaled}, as in the file")
    }

    /// Adds a face to the model.
    fn face(&mut self, index: usize, model: &mut Model) -> Read<()> {
        let pointer = 2 * index as i64 + 1;
        let kind = self.entities[index].kind;
        let outer = Affine::IDENTITY;
        let (surface, outline, holes, map) = match kind {
            143 | 144 => self.enter(pointer, "a face", &outer, |_, fields, map| {
                let (surface, outline, holes) =
                    if kind == 144 { trimmed(fields)? } else { bounded(fields)? };
                Ok((surface, outline, holes, *map))
            })?,
            108 => self.enter(pointer, "a plane", &outer, |_, fields, _| {
                fields.reals("a coefficient of a plane", 4)?;
                Ok((pointer, Some(fields.int("a pointer to a curve")?), Vec::new(), outer))
            })?,
            _ => (pointer, None, Vec::new(), outer),
        };
        let whole = |reader: &mut Self| {
            let outline = outline.map(|p| reader.ring(p, &map)).transpose()?;
            let holes: Read<Vec<Ring>> = holes.iter().map(|&p| reader.ring(p, &map)).collect();
            Ok((outline, holes?))
        };
        // A plane with a boundary is its own surface.
        let (mut outline, mut holes) =
            if surface == pointer { whole(self)? } else { self.within(pointer, whole)? };
        let points: Vec<Vector> = outline
            .iter()
            .chain(&holes)
            .flat_map(|ring| ring.space.iter().flat_map(|curve| curve.points().to_vec()))
            .collect();
        if kind == 143 && !holes.is_empty() {
            // Nothing says which of the boundaries is the outer one: the one of the largest extent.
            holes.extend(outline.take());
            holes.sort_by(|a, b| b.size().total_cmp(&a.size()));
            outline = Some(holes.remove(0));
        }
        let mut base = self.surface(surface, &map, &points)?;
        let has_outline = outline.is_some();
        let rings: Vec<Ring> = outline.into_iter().chain(holes).collect();
        let trim = boundary::cut(&mut base, rings, has_outline)?;
        let number = model.patches.len();
        if let Some(trim) = trim {
            model.trims.insert(number, trim);
        }
        let name = format!("D{pointer}");
        model.patches.push(Patch { name, ..Patch::plain(number, base.surface) });
        Ok(())
    }

    /// Makes curves one that agree within the resolution that the file states.
    fn join(&self, model: &mut Model) {
        let Some(resolution) = self.global.resolution else { return };
        if resolution > RESOLUTION_MAX * model.diagonal() {
            let text = format!(
                "the file states a resolution of {resolution:e}, too coarse for its size to be believed"
            );
            model.notes.push(text);
            return;
        }
        model.weld(resolution);
    }
}

/// A surface, its outline if it has one, and its holes.
type Face = (i64, Option<i64>, Vec<i64>);

fn trimmed(fields: &mut Fields) -> Read<Face> {
    let surface = fields.int("a pointer to a surface")?;
    let has_outline = fields.int("whether there is an outer boundary")? != 0;
    let holes = fields.int("the number of inner boundaries")?;
    let outline = fields.int("a pointer to the outer boundary")?;
    let most = fields.left() as i64;
    if !(0..=most).contains(&holes) {
        let (what, found) = ("the number of inner boundaries", holes.to_string());
        return Err(fields.fail(Problem::OutOfRange { what, found, low: 0, high: most }));
    }
    let holes: Read<Vec<i64>> =
        (0..holes).map(|_| fields.int("a pointer to an inner boundary")).collect();
    Ok((surface, has_outline.then_some(outline), holes?))
}

fn bounded(fields: &mut Fields) -> Read<Face> {
    fields.int("the type of the surface")?;
    let surface = fields.int("a pointer to a surface")?;
    let count = fields.count("the number of boundaries", 1, 1)?;
    let first = fields.int("a pointer to a boundary")?;
    let others: Read<Vec<i64>> =
        (1..count).map(|_| fields.int("a pointer to a boundary")).collect();
    Ok((surface, Some(first), others?))
}

/// Whether a type number stands for a shape, and not for a matrix, a view, text or a property.
fn is_shape(kind: i64) -> bool {
    matches!(kind, 100..=122 | 125..=198 | 408 | 430 | 502..=514)
}
