//! Voxel grids, and arrays of `NumPy`: draws, images, stacks of images or grids, by their axes.

use super::{Item, NumberSummary};
use media::files::number::NumberType;
use media::files::vdb::{Transform, VdbGrid};
use media::files::{Unreadable, npy, nvdb, pbrt, vdb, vol::Vol, wrong};
use media::grid_vdb;
use numeric::digits::number;

const VOXELS: &str = "voxels (x, y, z)";

/// Adds a note that an item cannot be a medium, if a value is negative or not finite.
fn doubt(item: &mut Item, spread: &NumberSummary) {
    if spread.negative > 0.0 {
        let many = spread.negative;
        item.notes.push(format!("no medium: {many} values are negative, and an extinction is not"));
    }
}

/// Adds the box to an item, or a note that its corners make no box.
fn place(item: &mut Item, [low, high]: [[f64; 3]; 2]) {
    (item.low, item.high) = (Some(low), Some(high));
    let edges: [f64; 3] = std::array::from_fn(|j| (high[j] - low[j]) / item.size[j] as f64);
    if edges.iter().all(|edge| *edge > 0.0 && edge.is_finite()) {
        item.voxel = Some(edges);
    } else {
        item.notes.push("its corners do not make a box: give `bounds.box`".to_owned());
    }
}

/// Returns the channels of a grid of Mitsuba.
pub fn of_vol(bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
    let vol = Vol::read(bytes)?;
    if vol.size.contains(&0) {
        return wrong("the file holds no sample", "write one with samples");
    }
    let channels = usize::try_from(vol.channels).unwrap_or(usize::MAX);
    let items = (0..channels.min(64)).map(|channel| {
        let spread = NumberSummary::of(vol.values(channel));
        let mut item = Item {
            format: "Mitsuba grid".to_owned(),
            name: if channels == 1 { String::new() } else { format!("channel {channel}") },
            kind: vol.encoding.name().to_owned(),
            size: vol.size.to_vec(),
            counts: VOXELS,
            channels: Some(vol.channels),
            ..Item::default()
        };
        spread.tell(&mut item);
        doubt(&mut item, &spread);
        place(&mut item, vol.corners);
        item
    });
    Ok(items.collect())
}

/// Returns the media of a scene of pbrt.
pub fn of_pbrt(bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return wrong("the file is no text", "give a scene file of pbrt that is not packed");
    };
    let items = pbrt::grids(text)?.into_iter().map(|(name, grid)| {
        let mut item = Item { format: "pbrt scene".to_owned(), name, ..Item::default() };
        match grid {
            Ok(grid) => {
                let spread = NumberSummary::of(grid.density.iter().copied());
                (item.kind, item.class) = ("text".to_owned(), "density".to_owned());
                (item.size, item.counts) = (grid.size.to_vec(), VOXELS);
                spread.tell(&mut item);
                doubt(&mut item, &spread);
                place(&mut item, grid.corners);
            }
            Err(Unreadable { message, help }) => {
                item.notes.push(format!("not read: {message}; {help}"));
            }
        }
        item
    });
    Ok(items.collect())
}

/// Returns the grids of an `OpenVDB` file.
pub fn of_vdb(bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
    let items = vdb::list(bytes)?.into_iter().map(|listed| {
        let format = "OpenVDB".to_owned();
        let listed = match listed {
            Ok(listed) => listed,
            Err((name, Unreadable { message, help })) => {
                let notes = vec![format!("not read: {message}; {help}")];
                return Item { format, name, notes, ..Item::default() };
            }
        };
        let mut item = Item {
            format,
            name: listed.name.clone(),
            kind: listed.kind,
            class: listed.class,
            active: listed.active,
            ..Item::default()
        };
        if listed.is_read {
            tree(&mut item, vdb::read(bytes, Some(&listed.name)));
        } else {
            item.voxel = Some(listed.transform.voxel());
            item.notes.push("not read: grids of the type Tree_float_5_4_3 are".to_owned());
        }
        item
    });
    Ok(items.collect())
}

/// Returns the grids of a `NanoVDB` file.
pub fn of_nvdb(bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
    let items = nvdb::list(bytes)?.into_iter().map(|listed| {
        let mut item = Item {
            format: "NanoVDB".to_owned(),
            name: listed.name.clone(),
            kind: listed.kind.clone(),
            class: listed.class.clone(),
            active: Some(listed.active),
            details: vec![format!("version {}, packed by {}", listed.version, listed.codec)],
            ..Item::default()
        };
        if listed.is_read() {
            tree(&mut item, nvdb::read(bytes, Some(&listed.name)));
        } else {
            item.notes
                .push("not read: grids of the types Float, Fp4, Fp8, Fp16 and FpN are".to_owned());
        }
        item
    });
    Ok(items.collect())
}

/// Adds the facts of a grid of voxels.
fn tree(item: &mut Item, read: Result<VdbGrid, Unreadable>) {
    let grid = match read {
        Ok(grid) => grid,
        Err(Unreadable { message, help }) => {
            item.notes.push(format!("not read: {message}; {help}"));
            return;
        }
    };
    let background = grid.tree.background;
    item.background = Some(background.into());
    item.active = Some(grid.tree.active);
    item.voxel = Some(grid.transform.voxel());
    if let Some([low, high]) = grid_vdb::reach(&grid.tree) {
        item.size = (0..3).map(|j| high[j].abs_diff(low[j]) + 1).collect();
        item.counts = VOXELS;
        let all: f64 = item.size.iter().map(|&n| n as f64).product();
        let (mut spread, mut filled) = (NumberSummary::default(), 0.0);
        for (_, edge, value) in grid_vdb::values(&grid.tree) {
            let voxels = (edge as f64).powi(3);
            if value.to_bits() != background.to_bits() {
                spread.add(value.into(), voxels);
                filled += voxels;
            }
        }
        if all > filled {
            spread.add(background.into(), all - filled);
        }
        spread.tell(item);
        let [low, high] = world(&grid.transform, [low.map(|n| n - 1), high.map(|n| n + 1)]);
        (item.low, item.high) = (Some(low), Some(high));
        if grid.transform.scale().is_none() {
            let rows = grid.transform.matrix.map(|row| row.map(number).join(" ")).join("; ");
            item.details
                .push(format!("turned or sheared by the matrix [{rows}]; the box is about it"));
        }
    }
    match grid_vdb::samples(&grid) {
        Ok(samples) => item.notes.extend(Some(samples.remark).filter(|remark| !remark.is_empty())),
        Err(Unreadable { message, help }) => {
            item.notes.push(format!("no medium: {message}; {help}"));
        }
    }
}

/// Returns the axis-aligned box around a box of indices.
fn world(transform: &Transform, ends: [[i64; 3]; 2]) -> [[f64; 3]; 2] {
    let corner = |n: usize| transform.world(std::array::from_fn(|j| ends[n >> j & 1][j] as f64));
    let corners = (1..8).map(corner);
    corners.fold([corner(0); 2], |[low, high], at| {
        [[0, 1, 2].map(|j| at[j].min(low[j])), [0, 1, 2].map(|j| at[j].max(high[j]))]
    })
}

/// Returns the array of a file.
pub fn array(mut bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
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
    let Some(number) = NumberType::named(&header.kind) else {
        item.notes.push("not read: its elements are no real numbers".to_owned());
        return Ok(vec![item]);
    };
    let expected = header.count().and_then(|count| count.checked_mul(number.width() as u64));
    if expected != Some(bytes.len() as u64) {
        return wrong(
            format!(
                "{} bytes follow the header, not those of the shape {shape} in {}",
                bytes.len(),
                header.kind
            ),
            "write one array to its end",
        );
    }
    let spread = NumberSummary::of(number.all(bytes));
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
        doubt(&mut item, &spread);
    }
    Ok(vec![item])
}
