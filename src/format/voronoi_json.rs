//! Voronoi tessellations as JSON: written, by the schema `schemas/voronoi-1.schema.json`.

use super::mesh_json::{integers, list, numbers};
use super::text::TextOut;
use crate::voronoi::{Clipped, Voronoi};
use std::io::{self, Write};

/// The value of the key `schema`.
pub const SCHEMA: &str = "trigrade-voronoi/1";

/// Writes a tessellation and, if it was clipped, the pieces of its cells.
///
/// # Errors
/// Those of the output.
pub fn write(voronoi: &Voronoi, clipped: Option<&Clipped>, out: &mut dyn Write) -> io::Result<()> {
    let mut text = TextOut::new(out);
    text.text(&format!("{{\"schema\":\"{SCHEMA}\",\n\"sites\":["))?;
    list(&mut text, &voronoi.sites, |text, p| numbers(text, &[p.x, p.y]))?;
    text.text("],\n\"repeated\":[")?;
    list(&mut text, &voronoi.repeated, |text, pair| integers(text, &pair.map(i64::from)))?;
    text.text("],\n\"vertices\":[")?;
    list(&mut text, &voronoi.vertices, |text, p| numbers(text, &[p.x, p.y]))?;
    text.text("],\n\"edges\":[")?;
    list(&mut text, &voronoi.edges, |text, edge| {
        text.text("{\"sites\":")?;
        integers(text, &edge.sites.map(i64::from))?;
        let end = |end: Option<u32>| end.map_or_else(|| "null".to_owned(), |v| v.to_string());
        text.text(&format!(",\"ends\":[{},{}]", end(edge.ends[0]), end(edge.ends[1])))?;
        if edge.ends.contains(&None) {
            text.text(",\"direction\":")?;
            numbers(text, &voronoi.direction(edge))?;
        }
        text.text("}")
    })?;
    text.text("],\n\"cells\":[")?;
    let sites = (0..voronoi.sites.len() as u32).filter(|&site| voronoi.has_cell(site));
    list(&mut text, sites, |text, site| write_cell(voronoi, site, text))?;
    text.text("]")?;
    if let Some(clipped) = clipped {
        write_clipped(clipped, &mut text)?;
    }
    text.text("}\n")?;
    text.finish()
}

fn write_cell(voronoi: &Voronoi, site: u32, text: &mut TextOut) -> io::Result<()> {
    let of = |value: &dyn Fn(crate::voronoi::Side) -> Option<u32>| -> Vec<i64> {
        voronoi.cell(site).filter_map(value).map(i64::from).collect()
    };
    text.text(&format!("{{\"site\":{site},\"bounded\":{}", !voronoi.is_unbounded(site)))?;
    for (key, values) in [
        ("edges", of(&|side| Some(side.edge))),
        ("neighbours", of(&|side| Some(side.neighbour))),
        ("vertices", of(&|side| side.ends[0])),
    ] {
        text.text(&format!(",\"{key}\":"))?;
        integers(text, &values)?;
    }
    text.text("}")
}

fn write_clipped(clipped: &Clipped, text: &mut TextOut) -> io::Result<()> {
    text.text(",\n\"clipped\":{\"points\":[")?;
    list(text, &clipped.points, |text, p| numbers(text, &[p.x, p.y]))?;
    text.text("],\n\"pieces\":[")?;
    list(text, &clipped.pieces, |text, piece| {
        text.text(&format!("{{\"site\":{},\"rings\":[", piece.site))?;
        for (i, ring) in piece.rings.iter().enumerate() {
            text.text(if i == 0 { "" } else { "," })?;
            integers(text, &ring.iter().copied().map(i64::from).collect::<Vec<_>>())?;
        }
        text.text("]}")
    })?;
    text.text("]}")
}
