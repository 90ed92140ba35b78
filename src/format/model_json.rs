//! Surface models as JSON; the schema is in SPEC 12.

use super::curve_json::{self, read_rule};
use super::domain_file::{DomainReadError, Problem, excerpt, without_mark};
use super::domain_json::{Item, Path, Read, parse};
use crate::curve::Curve;
use crate::model::{Model, ModelCurve, Patch, Trim, TrimCurve};
use crate::surface::{Coons, Revolution, Side, Surface, SurfaceError, Tensor};
use crate::vector::{Vector, add};
use serde_json::Value;

/// The value of the key `format`.
pub const FORMAT: &str = "trigrade-model";

/// Whether a file is a surface model: JSON with `"format": "trigrade-model"` or the key `patches`.
#[must_use]
pub fn is_model(bytes: &[u8]) -> bool {
    let bytes = without_mark(bytes);
    if bytes.trim_ascii_start().first() != Some(&b'{') {
        return false;
    }
    serde_json::from_slice::<Value>(bytes).is_ok_and(|value| is_model_value(&value))
}

/// The same of JSON that was parsed.
#[must_use]
pub fn is_model_value(value: &Value) -> bool {
    value.get("patches").is_some() || value.get("format").is_some_and(|format| format == FORMAT)
}

/// Reads a surface model.
///
/// # Errors
/// The first thing that keeps the file from being understood, with its line or JSON path.
pub fn read(bytes: &[u8]) -> Result<Model, DomainReadError> {
    let value = parse(without_mark(bytes))?;
    let root = Item { value: &value, path: &Path::Root };
    root.only_keys(&[
        "format",
        "version",
        "name",
        "comment",
        "spacing",
        "chord_error",
        "angle_per_edge",
        "corner_tolerance",
        "parts_may_cross",
        "curves",
        "patches",
    ])?;
    root.key("format", |item| match item.value.as_str() {
        Some(FORMAT) => Ok(()),
        _ => Err(item.expected("the format 'trigrade-model'")),
    })?;
    root.key("version", |item| item.integer("the version", 1, 1).map(|_| ()))?;
    let mut reader = Reader { model: Model::default() };
    reader.model.spacing = root.key("spacing", positive)?;
    reader.model.chord_error = root.key("chord_error", positive)?;
    reader.model.angle_per_edge_deg = root.key("angle_per_edge", |item| match positive(item)? {
        degrees if degrees <= 120.0 => Ok(degrees),
        _ => Err(item.expected("an angle in degrees, at most 120")),
    })?;
    reader.model.corner_tolerance = root.key("corner_tolerance", positive)?;
    reader.model.parts_may_cross = root.flag("parts_may_cross")?;
    root.key("curves", |item| item.each("an array of curves", |item| reader.named_curve(item)))?;
    root.required("patches", |item| item.each("an array of patches", |item| reader.patch(item)))?;
    Ok(reader.model)
}

fn positive(item: Item) -> Read<f64> {
    match item.number()? {
        value if value > 0.0 => Ok(value),
        _ => Err(item.expected("a number above 0")),
    }
}

struct Reader {
    model: Model,
}

impl Reader {
    fn named_curve(&mut self, item: Item) -> Read<()> {
        let name = item.required("name", |item| item.text("a name"))?;
        if self.model.curves.iter().any(|curve| curve.name == name) {
            let text = format!("there are two curves named '{}'", excerpt(&name));
            return Err(item.error(Problem::Name(text)));
        }
        let curve = curve_json::read(item)?;
        self.add_curve(item, name, curve)
    }

    fn add_curve(&mut self, item: Item, name: String, curve: Curve) -> Read<()> {
        let rule = read_rule(item)?;
        let marker = item.key("marker", |item| item.marker())?;
        self.model.curves.push(ModelCurve { name, curve, rule, marker });
        Ok(())
    }

    /// A curve by its name, backwards with a minus before it, or given in place.
    fn curve(&mut self, item: Item) -> Read<Curve> {
        let Some(text) = item.value.as_str() else {
            let curve = curve_json::read(item)?;
            self.add_curve(item, item.path.to_string(), curve.clone())?;
            return Ok(curve);
        };
        let name = text.strip_prefix('-').unwrap_or(text);
        match self.model.curves.iter().find(|curve| curve.name == name) {
            Some(found) if name.len() < text.len() => Ok(found.curve.reversed()),
            Some(found) => Ok(found.curve.clone()),
            None => {
                let text = format!("there is no curve named '{}'", excerpt(name));
                Err(item.error(Problem::Name(text)))
            }
        }
    }

    fn patch(&mut self, item: Item) -> Read<()> {
        let number = self.model.patches.len() + 1;
        let name = item.key("name", |item| item.text("a name"))?;
        let name = name.unwrap_or_else(|| number.to_string());
        let kind = item.required("kind", |item| item.text("the kind of a patch"))?;
        let surface = match kind.as_str() {
            "coons" => self.coons(item)?,
            "bspline" => Surface::Tensor(bspline(item)?),
            "bezier" => Surface::Tensor(tensor(item, &["net"], |rows, _| Tensor::bezier(rows))?),
            "bilinear" => {
                Surface::Tensor(tensor(item, &["net"], |rows, _| Tensor::clamped([1, 1], rows))?)
            }
            "plane" => Surface::Tensor(plane(item)?),
            "revolution" => Surface::Revolution(self.revolution(item)?),
            _ => {
                let what = "a kind of patch: coons, bspline, bezier, bilinear, plane or revolution";
                return Err(item.expected_value("kind", what));
            }
        };
        if kind != "coons" {
            item.key("sides", |item| self.side_rules(item, &surface, &name))?;
        }
        let marker = item.key("marker", |item| item.marker())?;
        let marker = marker.unwrap_or(i32::try_from(number).unwrap_or(i32::MAX));
        let reversed = item.flag("reversed")?;
        let trim = Trim {
            outline: item.key("outline", |item| self.trim_loop(item))?,
            holes: self.holes(item)?,
        };
        if trim != Trim::default() {
            self.model.trims.insert(self.model.patches.len(), trim);
        }
        self.model.patches.push(Patch { name, surface, marker, reversed });
        Ok(())
    }

    fn holes(&mut self, item: Item) -> Read<Vec<Vec<TrimCurve>>> {
        let mut holes = Vec::new();
        item.key("holes", |item| {
            item.each("an array of loops", |item| {
                holes.push(self.trim_loop(item)?);
                Ok(())
            })
        })?;
        Ok(holes)
    }

    fn trim_loop(&mut self, item: Item) -> Read<Vec<TrimCurve>> {
        let mut curves = Vec::new();
        item.each("an array of curves", |item| {
            curves.push(self.trim_curve(item)?);
            Ok(())
        })?;
        if curves.is_empty() { Err(item.expected("a curve")) } else { Ok(curves) }
    }

    /// A curve of space by its name, one with its parameters, or a curve of (u, v).
    fn trim_curve(&mut self, item: Item) -> Read<TrimCurve> {
        if item.value.is_string() {
            return Ok(TrimCurve::Space { curve: self.curve(item)?, parameters: None });
        }
        if item.value.get("curve").is_some() {
            item.only_keys(&["curve", "uv"])?;
            let curve = item.required("curve", |item| self.curve(item))?;
            let parameters = item.key("uv", |item| match read_rule(item)? {
                None => flat_curve(item),
                Some(_) => Err(item.expected("a curve without a rule: that of 'curve' holds")),
            })?;
            return Ok(TrimCurve::Space { curve, parameters });
        }
        let curve = flat_curve(item)?;
        let marker = item.key("marker", |item| item.marker())?;
        Ok(TrimCurve::Parameters { curve, rule: read_rule(item)?, marker })
    }

    fn coons(&mut self, item: Item) -> Read<Surface> {
        only(item, &["sides"])?;
        let sides = item.required("sides", |item| {
            item.only_keys(&Side::ALL.map(Side::name))?;
            let mut side = |side: Side| item.required(side.name(), |item| self.curve(item));
            Ok([side(Side::South)?, side(Side::East)?, side(Side::North)?, side(Side::West)?])
        })?;
        let coons = Coons::new(sides, self.model.corner_tolerance);
        coons.map(|coons| Surface::Coons(Box::new(coons))).map_err(|error| item.error(error.into()))
    }

    fn revolution(&mut self, item: Item) -> Read<Revolution> {
        only(item, &["sides", "profile", "origin", "axis", "angles"])?;
        let profile = item.required("profile", |item| self.curve(item))?;
        let vector =
            |key, default| Ok(item.key(key, |item: Item| item.vector())?.unwrap_or(default));
        let (origin, axis) = (vector("origin", [0.0; 3])?, vector("axis", [0.0, 0.0, 1.0])?);
        let angles = item.key("angles", |item| match item.numbers()?[..] {
            [from, to] => Ok([from, to]),
            _ => Err(item.expected("two angles in degrees")),
        })?;
        Revolution::new(profile, origin, axis, angles.unwrap_or([0.0, 360.0]))
            .map_err(|error| item.error(error.into()))
    }

    /// Rules and markers of the sides of a patch that has them by itself.
    fn side_rules(&mut self, item: Item, surface: &Surface, patch: &str) -> Read<()> {
        item.only_keys(&Side::ALL.map(Side::name))?;
        for side in Side::ALL {
            item.key(side.name(), |item| {
                item.only_keys(&["spacing", "count", "chord_error", "graded", "marker"])?;
                let name = format!("the {} side of patch {patch}", side.name());
                self.add_curve(item, name, surface.side(side))
            })?;
        }
        Ok(())
    }
}

/// A curve of (u, v).
fn flat_curve(item: Item) -> Read<Curve> {
    let curve = curve_json::read(item)?;
    match curve.points().iter().all(|p| p[2] == 0.0) {
        true => Ok(curve),
        false => Err(item.expected("a curve of (u, v), without a third coordinate")),
    }
}

/// Refuses keys that neither every patch has nor this kind.
fn only(item: Item, more: &[&str]) -> Read<()> {
    let common = ["name", "kind", "marker", "reversed", "outline", "holes"];
    let known: Vec<&str> = common.iter().chain(more).copied().collect();
    item.only_keys(&known)
}

type Rows = Vec<Vec<Vector>>;

fn net(item: Item) -> Read<Rows> {
    let mut rows = Vec::new();
    item.each("an array of rows of points", |item| {
        rows.push(item.vectors()?);
        Ok(())
    })?;
    Ok(rows)
}

fn tensor(
    item: Item,
    keys: &[&str],
    make: impl FnOnce(&Rows, Item) -> Result<Tensor, SurfaceError>,
) -> Read<Tensor> {
    let keys: Vec<&str> = keys.iter().copied().chain(["sides"]).collect();
    only(item, &keys)?;
    let rows = item.required("net", net)?;
    make(&rows, item).map_err(|error| item.error(error.into()))
}

fn bspline(item: Item) -> Read<Tensor> {
    only(item, &["sides", "net", "degrees", "knots", "weights"])?;
    let rows = item.required("net", net)?;
    let degrees = item.key("degrees", |item| {
        let mut list = Vec::new();
        item.each("two degrees", |item| {
            list.push(item.degree()?);
            Ok(())
        })?;
        <[usize; 2]>::try_from(list).map_err(|_| item.expected("two degrees"))
    })?;
    let degrees = degrees.unwrap_or([3, 3]);
    let lists = |item: Item| {
        let mut lists = Vec::new();
        item.each("an array of arrays of numbers", |item| {
            lists.push(item.numbers()?);
            Ok(())
        })?;
        Ok(lists)
    };
    let weights = item.key("weights", lists)?.unwrap_or_default();
    let knots = item.key("knots", |item| {
        <[Vec<f64>; 2]>::try_from(lists(item)?).map_err(|_| item.expected("two lists of knots"))
    })?;
    let tensor = match knots {
        Some(knots) => Tensor::new(degrees, knots, &rows, &weights),
        None => {
            let counts = [rows.len(), rows.first().map_or(0, Vec::len)];
            let knots = [0, 1].map(|i| crate::curve::clamped_knots(degrees[i], counts[i]));
            Tensor::new(degrees, knots, &rows, &weights)
        }
    };
    tensor.map_err(|error| item.error(error.into()))
}

/// The parallelogram from a corner along two vectors.
fn plane(item: Item) -> Read<Tensor> {
    only(item, &["sides", "corner", "u", "v"])?;
    let vector = |key| item.required(key, |item: Item| item.vector());
    let (corner, u, v) = (vector("corner")?, vector("u")?, vector("v")?);
    let (east, north) = (add(corner, u), add(corner, v));
    Tensor::bezier(&[vec![corner, north], vec![east, add(east, v)]])
        .map_err(|error| item.error(error.into()))
}
