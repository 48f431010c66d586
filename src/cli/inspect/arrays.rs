//! Arrays of `NumPy`: draws, images, stacks of images or grids, by their axes.

use super::item::{Item, Spread};
use media::files::number::Number;
use media::files::{Fault, npy, wrong};

/// The array of a file.
pub fn items(mut bytes: &[u8]) -> Result<Vec<Item>, Fault> {
    let header = match npy::bytes(&mut bytes).and_then(|header| npy::parse(&header)) {
        Ok(header) => header,
        Err(error) => {
            return wrong(format!("the header cannot be read: {error}"), "write it by numpy.save");
        }
    };
    let shape = header.written_shape();
    let order = if header.fortran_order { "Fortran order" } else { "C order" };
    let mut item = Item {
        format: "NumPy array".to_owned(),
        kind: header.kind.clone(),
        size: header.shape.clone(),
        counts: "along its axes",
        details: vec![format!("shape {shape}, {order}")],
        ..Item::default()
    };
    let Some(number) = Number::named(&header.kind) else {
        item.notes.push("not read: its elements are no real numbers".to_owned());
        return Ok(vec![item]);
    };
    let wanted = header.count().and_then(|count| count.checked_mul(number.width() as u64));
    if wanted != Some(bytes.len() as u64) {
        return wrong(
            format!(
                "{} bytes follow the header, not those of the shape {shape} in {}",
                bytes.len(),
                header.kind
            ),
            "write one array to its end",
        );
    }
    let spread = Spread::of(number.all(bytes));
    spread.tell(&mut item);
    let is = |what: String| Some(what);
    let may_be = match *header.shape.as_slice() {
        [n] => is(format!("{n} draws")),
        [n, m] => is(format!("{n} draws of {m} values, or an image {m} wide and {n} high")),
        [a, b, c] => is(format!(
            "a grid of {c} × {b} × {a} voxels (x, y, z; with `axes = \"xyz\"` {a} × {b} × {c}), {a} passes of images {c} \
             wide and {b} high, or an image {b} wide and {a} high of {c} channels"
        )),
        [a, b, c, d] => is(format!("{a} passes of images {c} wide and {b} high of {d} channels")),
        _ => None,
    };
    item.details.extend(may_be.map(|what| format!("may be {what}")));
    if header.shape.len() == 3 {
        super::volumes::doubt(&mut item, &spread);
    }
    Ok(vec![item])
}
