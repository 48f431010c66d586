//! The media of a scene file that are grids.

use super::super::{Unreadable, shown, wrong};
use super::moved::{Moved, mirrored};
use super::words::{Word, Words};

/// A grid of densities in a box.
#[derive(Debug, Clone, PartialEq)]
pub struct PbrtGrid {
    /// The name of the medium.
    pub name: String,
    /// Samples along x, y and z.
    pub size: [u64; 3],
    /// The corners of the box.
    pub corners: [[f64; 3]; 2],
    /// The densities, x fastest, then y, then z.
    pub density: Vec<f64>,
}

/// A medium as written in the file.
#[derive(Default)]
struct Medium {
    name: String,
    line: usize,
    kind: String,
    file: String,
    counts: [Option<f64>; 3],
    corners: [Option<Vec<f64>>; 2],
    density: Option<Vec<f64>>,
    moved: Moved,
}

const ADVICE: &str = "give one, as in MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" [ 64 ] …";

/// A medium by its name.
pub type NamedMedium = (String, Result<PbrtGrid, Unreadable>);

/// The media of a scene file that are grids, or the errors in them.
///
/// # Errors
///
/// The text is no scene file, or has no medium.
pub fn grids(text: &str) -> Result<Vec<NamedMedium>, Unreadable> {
    let (media, included) = media(text)?;
    if media.is_empty() {
        return match included {
            Some(file) => wrong(
                format!("it makes no medium, but includes {}", shown(&file)),
                "files that are included are not read: give the one with the medium",
            ),
            None => wrong("it makes no medium", ADVICE),
        };
    }
    Ok(media.into_iter().map(|medium| (medium.name.clone(), medium.grid())).collect())
}

/// Reads the medium of a name; without a name, the file's only grid.
///
/// # Errors
///
/// The file has no such medium.
pub fn read(text: &str, name: Option<&str>) -> Result<PbrtGrid, Unreadable> {
    let mut media = grids(text)?;
    let list = |media: &[NamedMedium]| {
        media.iter().map(|(name, _)| shown(name)).take(20).collect::<Vec<_>>().join(", ")
    };
    if let Some(name) = name {
        let Some(place) = media.iter().position(|(other, _)| other == name) else {
            let message = format!("it has no medium {}, but {}", shown(name), list(&media));
            return wrong(message, "choose one of its grids");
        };
        return media.swap_remove(place).1;
    }
    if media.len() > 1 && media.iter().any(|(_, grid)| grid.is_ok()) {
        media.retain(|(_, grid)| grid.is_ok());
    }
    if media.len() > 1 {
        return wrong(
            format!("it has several media: {}", list(&media)),
            "choose one: `grid = \"…\"`",
        );
    }
    media.pop().map_or_else(|| wrong("it makes no medium", ADVICE), |(_, grid)| grid)
}

fn media(text: &str) -> Result<(Vec<Medium>, Option<String>), Unreadable> {
    let mut words = Words::new(text);
    let (mut media, mut included) = (Vec::new(), None);
    let (mut moved, mut outer) = (Moved::default(), Vec::new());
    while let Some(word) = words.next()? {
        let Word::Plain(directive) = word else { continue };
        match directive {
            "MakeNamedMedium" => {
                let medium = medium(&mut words, moved.clone())?;
                media.push(medium);
            }
            "Include" | "Import" => {
                if let Some(Word::Text(file)) = words.next()? {
                    included = Some(file.to_owned());
                }
            }
            "WorldBegin" | "Identity" => moved = Moved::default(),
            "AttributeBegin" | "TransformBegin" | "ObjectBegin" => outer.push(moved.clone()),
            "AttributeEnd" | "TransformEnd" | "ObjectEnd" => {
                moved = outer.pop().unwrap_or_default();
            }
            "Translate" => moved.translate(three(&mut words)?),
            "Scale" => moved.scale(three(&mut words)?),
            "Rotate" => moved.turned_by = Some("Rotate"),
            "LookAt" => moved.turned_by = Some("LookAt"),
            "CoordSysTransform" => moved.turned_by = Some("CoordSysTransform"),
            "Transform" | "ConcatTransform" => {
                if directive == "Transform" {
                    moved = Moved::default();
                }
                matrix(&mut words, &mut moved)?;
            }
            _ => {}
        }
    }
    Ok((media, included))
}

fn three(words: &mut Words) -> Result<[f64; 3], Unreadable> {
    let mut numbers = [0.0; 3];
    for number in &mut numbers {
        match words.next()? {
            Some(Word::Plain(text)) if text.parse::<f64>().is_ok() => {
                *number = text.parse().unwrap_or_default();
            }
            _ => {
                return words.wrong(
                    "a directive lacks one of its three numbers",
                    "give them, as in Translate 0 0 1",
                );
            }
        }
    }
    Ok(numbers)
}

/// A matrix that points are multiplied with from the left, column after column as pbrt writes it.
fn matrix(words: &mut Words, moved: &mut Moved) -> Result<(), Unreadable> {
    let numbers = words.numbers()?;
    let Ok(matrix) = <[f64; 16]>::try_from(numbers) else {
        return words.wrong("a matrix has not 16 numbers", "give 16, the translation last but one");
    };
    let at = |row: usize, column: usize| matrix[4 * row + column];
    let is_plain =
        (0..4).all(|row| (0..4).all(|column| row == column || row == 3 || at(row, column) == 0.0));
    if !is_plain || at(3, 3) != 1.0 {
        moved.turned_by = Some("Transform");
        return Ok(());
    }
    moved.translate([0, 1, 2].map(|j| at(3, j)));
    moved.scale([0, 1, 2].map(|j| at(j, j)));
    Ok(())
}

/// The parameters after `MakeNamedMedium`.
fn medium(words: &mut Words, moved: Moved) -> Result<Medium, Unreadable> {
    let line = words.line;
    let Some(Word::Text(name)) = words.next()? else {
        return words.wrong("a medium has no name", ADVICE);
    };
    let mut medium = Medium { name: name.to_owned(), line, moved, ..Medium::default() };
    while let Some(Word::Text(parameter)) = words.peek()? {
        words.next()?;
        let mut parts = parameter.split_whitespace();
        let (kind, key) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        match (kind, key) {
            ("integer", "nx") => medium.counts[0] = words.numbers()?.first().copied(),
            ("integer", "ny") => medium.counts[1] = words.numbers()?.first().copied(),
            ("integer", "nz") => medium.counts[2] = words.numbers()?.first().copied(),
            ("point" | "point3", "p0") => medium.corners[0] = Some(words.numbers()?),
            ("point" | "point3", "p1") => medium.corners[1] = Some(words.numbers()?),
            ("float", "density") => medium.density = Some(words.numbers()?),
            ("string", "type" | "filename") => {
                let into = if key == "type" { &mut medium.kind } else { &mut medium.file };
                words.values(|_, word| {
                    if let Word::Text(text) = word {
                        text.clone_into(into);
                    }
                    Ok(())
                })?;
            }
            _ => words.values(|_, _| Ok(()))?,
        }
    }
    Ok(medium)
}

impl Medium {
    fn grid(self) -> Result<PbrtGrid, Unreadable> {
        let refuse = |what: &str, help: &str| {
            wrong(format!("medium {} in line {} {what}", shown(&self.name), self.line), help)
        };
        match self.kind.as_str() {
            "uniformgrid" | "heterogeneous" => {}
            // Files of either kind leave the type out if another file has it.
            "" if self.density.is_some() => {}
            "nanovdb" => {
                let help = format!("read the file itself: `file = {}`", shown(&self.file));
                return refuse("is of the type \"nanovdb\"", &help);
            }
            other => {
                let what = format!("is of the type {}", shown(other));
                return refuse(&what, "media of the type \"uniformgrid\" are read");
            }
        }
        let Some(density) = self.density else {
            let help = "give it: \"rgb\" and \"spectrum\" densities are not read";
            return refuse("has no \"float density\"", help);
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked first
        let count = |n: f64| match n {
            n if n >= 1.0 && n <= f64::from(u32::MAX) && n.fract() == 0.0 => Some(n as u64),
            _ => None,
        };
        let counts = self.counts.map(|n| n.unwrap_or(1.0));
        let [Some(x), Some(y), Some(z)] = counts.map(count) else {
            let help = "give whole numbers above 0 as \"integer nx\", \"ny\" and \"nz\"";
            return refuse(&format!("has {counts:?} samples along its axes"), help);
        };
        let expected = [y, z].iter().try_fold(x, |product, &n| product.checked_mul(n));
        if expected != Some(density.len() as u64) {
            let what = format!("has {} densities for {x} × {y} × {z} samples", density.len());
            return refuse(&what, "give nx · ny · nz of them, x fastest");
        }
        if let Some(directive) = self.moved.turned_by {
            let what = format!("stands under {directive}, which turns its box");
            return refuse(&what, "make the medium before it, or after Identity");
        }
        let corner = |given: &Option<Vec<f64>>, default: f64| match given.as_deref() {
            None => Some([default; 3]),
            Some(&[x, y, z]) => Some([x, y, z]),
            Some(_) => None,
        };
        let [low, high] = &self.corners;
        let (Some(low), Some(high)) = (corner(low, 0.0), corner(high, 1.0)) else {
            return refuse("has a corner of its box without three numbers", "give [ x y z ]");
        };
        let Moved { scale, shift, .. } = self.moved;
        let ends = |j: usize| [low, high].map(|corner| scale[j] * corner[j] + shift[j]);
        let corners = [
            [0, 1, 2].map(|j| ends(j)[0].min(ends(j)[1])),
            [0, 1, 2].map(|j| ends(j)[0].max(ends(j)[1])),
        ];
        let size = [x, y, z];
        // p0 and p1 are corners in any order, but the samples begin at the lowest; a mirror reverses them.
        let density = mirrored(density, size, scale.map(|x| x < 0.0));
        Ok(PbrtGrid { name: self.name, size, corners, density })
    }
}
