//! Where the parts of an assembly stand: each shell is read once for each of its places.

use super::record::{Entity, Rigid};
use super::{Read, Reader};
use std::collections::BTreeMap;

/// Parts of parts of parts deeper than this are nobody's.
const DEEPEST: usize = 24;
/// Most places of shells in all.
const PLACES_MAX: usize = 100_000;

/// How representations of shapes hang together.
#[derive(Default)]
pub(super) struct Assembly {
    /// Of each representation, those it stands in, and how.
    parents: BTreeMap<u64, Vec<(u64, Rigid)>>,
    /// The representation of each shell.
    owner: BTreeMap<u64, u64>,
}

/// Kinds of records that hold shells as items of a representation.
const BODIES: [&str; 4] =
    ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "SHELL_BASED_SURFACE_MODEL", "FACETED_BREP"];

impl Reader<'_> {
    /// The places of all parts.
    pub(super) fn assembly(&self) -> Read<Assembly> {
        let mut assembly = Assembly::default();
        let mut bodies: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
        for id in self.records.of_kinds(&BODIES) {
            let body = self.records.entity(id)?;
            bodies.insert(id, body.fields(None)?.mentioned());
        }
        let maps = self.maps()?;
        for id in self.records.representations() {
            let entity = self.records.entity(id)?;
            for item in entity.fields(None)?.references(1, "the items")? {
                if let Some(&(part, own)) = maps.get(&item) {
                    assembly.parents.entry(part).or_default().push((id, own));
                }
                for &shell in bodies.get(&item).into_iter().flatten() {
                    assembly.owner.insert(shell, id);
                }
            }
        }
        for id in self.records.of_kinds(&["SHAPE_REPRESENTATION_RELATIONSHIP"]) {
            let fields = self.records.entity(id)?;
            let fields = fields.fields(None)?;
            let (a, b) = (fields.reference(2, "a shape")?, fields.reference(3, "a shape")?);
            // Two names of one shape: the one with the bodies stands in the other.
            let is_body = |shape: u64| assembly.owner.values().any(|&owner| owner == shape);
            let (part, whole) = if is_body(b) && !is_body(a) { (b, a) } else { (a, b) };
            assembly.parents.entry(part).or_default().push((whole, Rigid::IDENTITY));
        }
        for id in self.records.with_part("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
            let entity = self.records.entity(id)?;
            let (a, b) = {
                let fields = entity.fields(Some("REPRESENTATION_RELATIONSHIP"))?;
                (fields.reference(2, "the part")?, fields.reference(3, "the whole")?)
            };
            let own = entity.fields(Some("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"))?;
            let own = self.transformation(own.reference(0, "the transformation")?)?;
            assembly.parents.entry(a).or_default().push((b, own));
        }
        Ok(assembly)
    }

    /// Items that stand for another representation: its number, and where it stands.
    fn maps(&self) -> Read<BTreeMap<u64, (u64, Rigid)>> {
        let mut maps = BTreeMap::new();
        for id in self.records.of_kinds(&["MAPPED_ITEM"]) {
            let item = self.records.entity(id)?;
            let fields = item.fields(None)?;
            let source = self.records.entity(fields.reference(1, "the map")?)?;
            if source.kind() != "REPRESENTATION_MAP" {
                return Err(source.fail("a REPRESENTATION_MAP should be here"));
            }
            let from = source.fields(None)?;
            let part = from.reference(1, "the representation")?;
            let from = self.records.frame(from.reference(0, "the origin")?)?;
            let to = self.records.frame(fields.reference(2, "the target")?)?;
            maps.insert(id, (part, Rigid::between(&from, &to)));
        }
        Ok(maps)
    }

    fn transformation(&self, id: u64) -> Read<Rigid> {
        let entity = self.records.entity(id)?;
        if entity.kind() != "ITEM_DEFINED_TRANSFORMATION" {
            return Err(entity.fail("a transformation of this kind is not read"));
        }
        let fields = entity.fields(None)?;
        let from = self.records.frame(fields.reference(2, "the first frame")?)?;
        let to = self.records.frame(fields.reference(3, "the second frame")?)?;
        Ok(Rigid::between(&from, &to))
    }
}

impl Assembly {
    /// The places of a shell: one where nothing moves it.
    pub(super) fn places(&self, shell: &Entity) -> Read<Vec<Rigid>> {
        let mut places = Vec::new();
        match self.owner.get(&shell.id) {
            None => places.push(Rigid::IDENTITY),
            Some(&owner) => self.climb(owner, Rigid::IDENTITY, 0, &mut places, shell)?,
        }
        Ok(places)
    }

    fn climb(
        &self,
        part: u64,
        so_far: Rigid,
        depth: usize,
        places: &mut Vec<Rigid>,
        shell: &Entity,
    ) -> Read<()> {
        let Some(parents) = self.parents.get(&part) else {
            places.push(so_far);
            return Ok(());
        };
        if depth > DEEPEST || places.len() > PLACES_MAX {
            return Err(shell.fail("it stands in too many places, or in itself"));
        }
        for (whole, own) in parents {
            self.climb(*whole, own.after(&so_far), depth + 1, places, shell)?;
        }
        Ok(())
    }
}
