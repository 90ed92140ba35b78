//! Clipped Voronoi cells as Wavefront OBJ: a group and a face for each piece. OBJ has no faces with
//! holes: the rings of such a piece are written as closed lines.

use super::text::TextOut;
use crate::voronoi::Clipped;
use std::io::{self, Write};

/// Writes the pieces.
///
/// # Errors
/// Those of the output.
pub fn write(clipped: &Clipped, out: &mut dyn Write) -> io::Result<()> {
    let mut text = TextOut::new(out);
    text.text("# Voronoi cells; a group is called after the index of its site\n")?;
    for p in &clipped.points {
        text.text("v ")?;
        text.float(p.x, b' ')?;
        text.float(p.y, b' ')?;
        text.text("0\n")?;
    }
    for piece in &clipped.pieces {
        text.text(&format!("g cell_{}\n", piece.site))?;
        for ring in &piece.rings {
            let closing = ring.first().filter(|_| piece.rings.len() > 1);
            text.text(if closing.is_none() { "f" } else { "l" })?;
            for &corner in ring.iter().chain(closing) {
                text.text(&format!(" {}", u64::from(corner) + 1))?;
            }
            text.text("\n")?;
        }
    }
    text.finish()
}
