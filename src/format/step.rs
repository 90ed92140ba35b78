//! STEP files (ISO 10303-21): the faces of the shells of a part with the edges that they share, as a
//! model. With the Cargo feature `step` only.
//!
//! Read are the faces of closed and open shells on planes, cylinders, cones, spheres, tori, surfaces of
//! extrusion and of revolution, and B-spline surfaces; their edges on lines, circles, ellipses,
//! polylines and B-spline curves. An edge that faces share is one curve of the model, so that their
//! meshes have its points in common. A part of an assembly is read once for each of its places. Records
//! are parsed by the crate `ruststep`, one at a time and only those that faces are made of.
//!
//! Source: ISO 10303-21:2016 (the text), ISO 10303-42:2022 (the shapes).

mod assembly;
mod boundary;
mod curve;
mod foot;
mod path;
mod record;
mod scan;
mod surface;
mod swept;
mod turned;

use super::domain_file::{DomainReadError, Problem, without_mark};
use crate::curve::Curve;
use crate::domain::Place;
use crate::model::{Model, Patch};
use crate::surface::Side;
use crate::vector::Vector;
use boundary::Use;
use record::{Entity, Records, Rigid};
use std::collections::{BTreeMap, BTreeSet};

type Read<T> = Result<T, DomainReadError>;

/// Files above this size are refused before anything is read.
const LARGEST: usize = 1 << 30;
/// An uncertainty larger than this fraction of the model's size is not believed.
const UNCERTAINTY_MAX: f64 = 1e-4;

/// Reads the faces of a STEP file. Each is a patch called after its record (`#105`), with its number
/// from 1 as marker; [`Model::notes`] tell the unit of length.
///
/// # Errors
/// The first thing that keeps the file from being understood, with its line. Memory and time are
/// bounded by a multiple of the file's size.
pub fn read(bytes: &[u8]) -> Result<Model, DomainReadError> {
    let fail = |text: &str| Problem::Step(text.to_owned()).at(Place::Made);
    if bytes.len() > LARGEST {
        return Err(fail("a STEP file may have at most 2^30 bytes"));
    }
    let text = std::str::from_utf8(without_mark(bytes))
        .map_err(|_| fail("a STEP file is plain text, but this has bytes that are no UTF-8"))?;
    let records = Records::new(scan::scan(text)?, text.len());
    let mut reader = Reader {
        degrees: records.counts_degrees()?,
        uncertainty: records.uncertainty()?,
        records: &records,
        edges: BTreeMap::new(),
        rims: BTreeMap::new(),
    };
    reader.model()
}

/// A face in one of the places of its part.
struct Standing {
    face: u64,
    /// Which of the places, from 0.
    copy: usize,
    place: Rigid,
}

struct Reader<'a> {
    records: &'a Records<'a>,
    /// Radians in the unit of plane angles.
    degrees: f64,
    /// What the file says is the same.
    uncertainty: f64,
    /// The curves of the edges met so far, by their records.
    edges: BTreeMap<u64, Curve>,
    /// Sides of whole patches that stand for edges.
    rims: BTreeMap<u64, Curve>,
}

impl Reader<'_> {
    fn model(&mut self) -> Read<Model> {
        let assembly = self.assembly()?;
        let mut faces = Vec::new();
        let mut seen = BTreeSet::new();
        for shell in self.records.of_kinds(&["CLOSED_SHELL", "OPEN_SHELL"]) {
            let shell = self.records.entity(shell)?;
            let own = shell.fields(None)?.references(1, "the faces")?;
            if let Some(twice) = own.iter().find(|face| !seen.insert(**face)) {
                let text = format!("face #{twice} stands in shells twice");
                return Err(shell.fail(&text));
            }
            let places = assembly.places(&shell)?;
            let copies = places.into_iter().enumerate();
            faces.extend(copies.flat_map(|(copy, place)| {
                own.iter().map(move |&face| Standing { face, copy, place }).collect::<Vec<_>>()
            }));
        }
        if faces.is_empty() {
            let text = "the file has no shell (CLOSED_SHELL, OPEN_SHELL) with faces";
            return Err(Problem::Step(text.to_owned()).at(Place::Made));
        }
        let mut model = Model { notes: vec![self.records.lengths()?], ..Model::default() };
        let mut before = None;
        for (i, standing) in faces.iter().enumerate() {
            // A part that stands elsewhere has edges of its own.
            if before.replace(standing.copy).is_some_and(|copy| copy != standing.copy) {
                self.edges.clear();
                self.rims.clear();
            }
            self.records.stand(standing.place);
            self.face(standing, &mut model).map_err(|error| of_face(error, i + 1))?;
        }
        let size = model.diagonal();
        let uncertainty =
            if self.uncertainty <= UNCERTAINTY_MAX * size { self.uncertainty } else { 0.0 };
        model.weld(uncertainty.max(1e-10 * size));
        Ok(model)
    }

    fn face(&mut self, standing: &Standing, model: &mut Model) -> Read<()> {
        let id = standing.face;
        let face = self.records.entity(id)?;
        if !["ADVANCED_FACE", "FACE_SURFACE"].contains(&face.kind()) {
            return Err(face.fail("a face of this kind is not read"));
        }
        let fields = face.fields(None)?;
        let bounds = fields.references(1, "the bounds")?;
        let base = self.records.entity(fields.reference(2, "the surface")?)?;
        let is_forward = fields.flag(3, "the sense")?;
        let mut loops = Vec::new();
        for bound in bounds {
            loops.extend(self.bound(bound, is_forward)?);
        }
        let cut = self.surface(&base, &face, &loops)?;
        let number = model.patches.len();
        if let Some(trim) = cut.trim {
            model.trims.insert(number, trim);
        }
        let name = match standing.copy {
            0 => format!("#{id}"),
            copy => format!("#{id} in place {}", copy + 1),
        };
        model.patches.push(Patch { name, ..Patch::plain(number, cut.surface) });
        Ok(())
    }

    /// Notes that a side of a patch without a trim is an edge, which another such patch must have the
    /// same.
    fn rim(&mut self, edge: Use, side: Curve, face: &Entity) -> Read<()> {
        match self.rims.get(&edge.id) {
            Some(other) if other.same_as(&side).is_none() => {
                let text =
                    format!("two faces with poles share edge #{}, which is not read", edge.id);
                Err(face.fail(&text))
            }
            _ => {
                self.rims.insert(edge.id, side);
                Ok(())
            }
        }
    }

    /// The points of the curves of a loop, a number of them on each, in the direction of the loop.
    fn samples(&self, edge: Use, count: u32) -> Vec<Vector> {
        let curve = &self.edges[&edge.id];
        let [start, end] = curve.domain();
        let at = |i: u32| curve.at(start + f64::from(i) / f64::from(count) * (end - start));
        let end_point = *curve.points().last().unwrap_or(&[0.0; 3]);
        let mut points: Vec<Vector> = (0..count).map(at).chain([end_point]).collect();
        if edge.reversed {
            points.reverse();
        }
        points
    }
}

fn of_face(error: DomainReadError, number: usize) -> DomainReadError {
    let DomainReadError { place, problem } = error;
    match problem {
        Problem::Step(text) => Problem::Step(format!("face {number}: {text}")).at(place),
        problem => problem.at(place),
    }
}

/// The sides across a profile: where it starts and where it ends.
const RIMS: [Side; 2] = [Side::West, Side::East];
