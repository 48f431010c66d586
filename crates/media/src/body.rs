//! A field as a case file gives it: along a line, or as a volume with a ray through it; or one for each
//! channel (wavelength) on the same line or ray.

use std::sync::Arc;

use super::reader::{read_line, read_volume};
use super::{CATALOGUE, Medium, Profile, Volume};
use crate::catalogue::{Domain, Settings, Value};
use numeric::Span;
use numeric::digits::number;
use numeric::geometry::{Aabb, Bounds, Point, Ray};

/// A field, and the span of the line or the ray on which it is used.
#[derive(Clone)]
pub enum Body {
    /// `medium.NAME = { … }` on `span = [from, to]`.
    Line {
        /// The field's name in the catalogue.
        name: String,
        /// The field as a function of the distance.
        profile: Arc<Profile>,
        /// Span on which it is used.
        span: Span,
    },
    /// `volume.NAME = { … }` crossed by `ray = { … }`.
    Volume {
        /// The field's name in the catalogue.
        name: String,
        /// The field as a function of the point.
        volume: Arc<Volume>,
        /// The ray.
        ray: Ray,
    },
    /// `medium = [{ NAME = { … } }, …]` or `volume = [{ NAME = { … } }, …]`.
    Spectral {
        /// The fields' names in the catalogue, without repetition.
        name: String,
        /// The field of each channel.
        channels: Vec<Body>,
    },
}

/// Maximum number of channels.
pub const MAX_CHANNELS: usize = 8;

/// Parts of the ray through a volume that a problem needs; other parts may be given, and show σ_t.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RayNeed {
    /// Origin, direction and length.
    Whole,
    /// Origin and direction.
    Line,
    /// Nothing.
    Nothing,
}

impl Body {
    /// Reads `medium` and `span`, or `volume` and a whole `ray`.
    pub fn read(settings: &Settings) -> Option<Self> {
        Self::read_for(settings, RayNeed::Whole)
    }

    /// Reads `medium` and `span`, or `volume` and the parts of a `ray` that a problem needs.
    pub fn read_for(settings: &Settings, need: RayNeed) -> Option<Self> {
        for key in ["medium", "volume"] {
            let entry = settings.entry(key);
            if entry.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
                return read_channels(settings, key);
            }
        }
        match (settings.has("medium"), settings.has("volume")) {
            (true, false) => {
                let field = read_line(settings, Some("medium"));
                let span = read_span(settings);
                is_extinction(settings, "medium", Self::line(settings, "medium", field?, span?)?)
            }
            (false, true) => {
                let field = read_volume(settings, Some("volume"));
                let bounds = field.as_ref().map_or(Bounds::Everywhere, |(_, f)| f.bounds());
                let ray = if need == RayNeed::Nothing && !settings.has("ray") {
                    through(bounds)
                } else {
                    let within = (need != RayNeed::Whole).then_some(bounds);
                    settings.table("ray").and_then(|ray| read_ray(&ray, within))
                };
                is_extinction(settings, "volume", Self::crossed(settings, field?, ray?)?)
            }
            (both, _) => {
                let actual = if both { "both `medium` and `volume`" } else { "no field is given" };
                let help = "give `medium.NAME = { … }` with `span = [from, to]`, or \
                            `volume.NAME = { … }` with `ray = { origin, direction, length }`";
                settings.fault_at(settings.span.clone(), "", actual, help);
                None
            }
        }
    }

    /// Reads another field for the same line or ray: a control variate.
    pub fn read_beside(&self, settings: &Settings) -> Option<Self> {
        match self {
            Self::Line { span, .. } => {
                Self::line(settings, "medium", read_line(settings, Some("medium"))?, *span)
            }
            Self::Volume { ray, .. } => {
                Self::crossed(settings, read_volume(settings, Some("volume"))?, *ray)
            }
            Self::Spectral { channels, .. } => channels[0].read_beside(settings),
        }
    }

    /// A field on a span without too many pieces.
    fn line(
        settings: &Settings,
        key: &'static str,
        (name, profile): (String, Arc<Profile>),
        span: Span,
    ) -> Option<Self> {
        not_too_many(settings, key, profile.facts().pieces_per_length * span.length())?;
        Some(Self::Line { name, profile, span })
    }

    /// A field crossed by a ray that has no more pieces than fit, all of them within the range of lattice coordinates.
    fn crossed(
        settings: &Settings,
        (name, volume): (String, Arc<Volume>),
        ray: Ray,
    ) -> Option<Self> {
        let inside = volume.bounds().clip(&ray);
        let farthest = volume.max_lattice_coordinate(&ray, inside);
        if farthest < MAX_COORDINATE {
            let pieces = volume.facts().pieces_per_length * inside.length();
            not_too_many(settings, "volume", pieces)?;
            return Some(Self::Volume { name, volume, ray });
        }
        let actual = format!(
            "the ray reaches {farthest:.1e} cells from the field's origin, and 2^31 is most"
        );
        settings.fault("volume", actual, "bring the ray's origin nearer, or make the cells larger");
        None
    }

    /// The field of each channel: one, unless it is spectral.
    pub fn channels(&self) -> &[Self] {
        match self {
            Self::Spectral { channels, .. } => channels,
            one => std::slice::from_ref(one),
        }
    }

    /// Returns the field along the ray of another body. A field along a line stays as it is.
    #[must_use]
    pub fn seen_like(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Volume { name, volume, .. }, Self::Volume { ray, .. }) => {
                Self::Volume { name: name.clone(), volume: volume.clone(), ray: *ray }
            }
            _ => self.clone(),
        }
    }

    /// The field's name in the catalogue.
    pub fn name(&self) -> &str {
        match self {
            Self::Line { name, .. } | Self::Volume { name, .. } | Self::Spectral { name, .. } => {
                name
            }
        }
    }

    /// Contents of the files of the fields, a sentence each, without repetitions.
    pub fn contents(&self) -> Vec<String> {
        let mut contents: Vec<String> = Vec::new();
        for channel in self.channels() {
            if let Self::Volume { volume, .. } = channel {
                for fact in volume.facts().contents {
                    if !contents.contains(fact) {
                        contents.push(fact.clone());
                    }
                }
            }
        }
        contents
    }

    /// The field along its line or ray, clipped to its bounds; that of the first channel.
    pub fn medium(&self) -> Medium {
        match self {
            Self::Line { profile, span, .. } => Medium::new(profile.clone(), *span, *span),
            Self::Volume { volume, ray, .. } => {
                let ends = volume.bounds().ends(ray);
                let support = Span::new(ends[0].value, ends[1].value);
                let profile = volume.along(ray, support);
                Medium::clipped(profile, ray.span(), ends)
            }
            Self::Spectral { channels, .. } => channels[0].medium(),
        }
    }
}

/// Reads a list of media with a `span`, or of volumes with a `ray`.
fn read_channels(settings: &Settings, key: &'static str) -> Option<Body> {
    let fields = settings.tables(key);
    let (span, ray) = if key == "medium" {
        (Some(read_span(settings)), None)
    } else {
        (None, Some(settings.table("ray").and_then(|ray| read_ray(&ray, None))))
    };
    let fields = fields?;
    if !(1..=MAX_CHANNELS).contains(&fields.len()) {
        let message = format!("`{key}` lists {} channels", fields.len());
        settings.fault(key, message, format!("it takes 1 to {MAX_CHANNELS}"));
        return None;
    }
    let mut channels = Vec::new();
    for table in &fields {
        channels.push(if let Some(span) = span {
            let field = read_line(table, None);
            field.zip(span).and_then(|(field, span)| Body::line(table, "", field, span))
        } else {
            let field = read_volume(table, None);
            field.zip(ray.flatten()).and_then(|(field, ray)| Body::crossed(table, field, ray))
        });
    }
    let channels: Vec<Body> = channels.into_iter().collect::<Option<_>>()?;
    let support = channels[0].medium().support();
    if channels.iter().any(|channel| channel.medium().support() != support) {
        let message = "the channels do not fill the same part of the ray";
        settings.fault(key, message, "give all of them the same `bounds`");
        return None;
    }
    for (number, (table, channel)) in (1..).zip(fields.iter().zip(&channels)) {
        if !support.is_empty() && channel.medium().optical_depth(support).value <= 0.0 {
            let message = format!("σ_t = 0 everywhere in channel {number}");
            table.fault("", message, "give it some extinction, or leave the channel out");
            return None;
        }
    }
    let mut different: Vec<&str> = channels.iter().map(Body::name).collect();
    different.dedup();
    Some(Body::Spectral { name: different.join(", "), channels })
}

/// Maximum number of pieces along one ray; more are a mistake in the case: they would fill the memory.
const MAX_PIECES: f64 = 1e7;

/// Range of lattice coordinates: they are integers of 32 bits.
const MAX_COORDINATE: f64 = 2_147_483_648.0;

/// Checks a field of the program's own along the ray; built-in fields have checked their settings.
fn is_extinction(settings: &Settings, key: &'static str, body: Body) -> Option<Body> {
    let is_own = CATALOGUE.get(body.name()).is_none();
    let medium = body.medium();
    if is_own && medium.optical_depth(medium.support()).value.is_nan() {
        let actual = format!("σ_t of `{}` is negative or not finite on the ray", body.name());
        settings.fault(key, actual, "it takes a field with 0 ≤ σ_t < ∞");
        return None;
    }
    Some(body)
}

fn not_too_many(settings: &Settings, key: &'static str, pieces: f64) -> Option<()> {
    if pieces <= MAX_PIECES {
        return Some(());
    }
    let actual = format!("about {pieces:.1e} pieces along the ray, more than {MAX_PIECES:.0e}");
    settings.fault(key, actual, "make it shorter, or its features larger");
    None
}

fn read_span(settings: &Settings) -> Option<Span> {
    let ends = settings.numbers("span", Domain::Finite, 2)?;
    let &[from, to] = ends.as_slice() else {
        settings.fault("span", "`span` has more than two ends", "it takes [from, to]");
        return None;
    };
    if from > to {
        settings.fault(
            "span",
            format!("`span` ends at {}, before it begins at {}", number(to), number(from)),
            "it takes [from, to] with from ≤ to",
        );
        return None;
    }
    Some(Span::new(from, to))
}

/// A ray through the middle of a volume, for problems that need none.
fn through(bounds: Bounds) -> Option<Ray> {
    let unit = Aabb { low: Point([0.0; 3]), high: Point([0.0, 0.0, 1.0]) };
    let Aabb { low, high } = bounds.enclosing_box().unwrap_or(unit);
    let mut origin = (low + high) * 0.5;
    origin.0[2] = low.0[2];
    Ray::new(origin, Point([0.0, 0.0, 1.0]), high.0[2] - low.0[2])
}

/// Reads a ray, which may leave its length out if it is only used within bounds.
fn read_ray(settings: &Settings, within: Option<Bounds>) -> Option<Ray> {
    let origin = settings.triple("origin");
    let direction = settings.triple("direction");
    let length = match within {
        Some(bounds) if !settings.has("length") => {
            // No place within the bounds is farther than their farthest corner.
            let farthest = |within: Aabb| {
                let from = Point(origin.unwrap_or_default());
                let [low, high] = [within.low - from, within.high - from];
                Point([0, 1, 2].map(|axis| low.0[axis].abs().max(high.0[axis].abs()))).norm()
            };
            Some(bounds.enclosing_box().map_or(1.0, farthest))
        }
        _ => settings.number("length", Domain::NonNegative),
    };
    settings.close();
    if direction.is_some_and(|d| Point(d).normalised().is_none()) {
        settings.fault("direction", "`direction` is the zero vector", "it takes any other vector");
    }
    Ray::new(Point(origin?), Point(direction?), length?)
}

/// Reads `axis`, the direction in which a plane-parallel medium varies; the z axis without the key.
pub(super) fn read_axis(settings: &Settings) -> Option<Point> {
    let axis = Point(settings.triple_or("axis", [0.0, 0.0, 1.0])?).normalised();
    if axis.is_none() {
        settings.fault("axis", "`axis` is the zero vector", "it takes any other vector");
    }
    axis
}

/// Reads `bounds.sphere = { centre, radius }` or `bounds.box = { low, high }` of a volume that has
/// no bounds of its own; without the key the volume fills all of space.
pub(super) fn read_bounds(settings: &Settings) -> Option<Bounds> {
    if !settings.has("bounds") {
        return Some(Bounds::Everywhere);
    }
    let (index, bounds) = settings.chosen("bounds", &["sphere".into(), "box".into()])?;
    let read = if index == 0 {
        let centre = bounds.triple("centre");
        let radius = bounds.number("radius", Domain::Positive);
        centre.zip(radius).map(|(c, radius)| Bounds::Sphere { centre: Point(c), radius })
    } else {
        read_box(&bounds).map(Bounds::Box)
    };
    bounds.close();
    read
}

/// Reads `low` and `high`, the corners of a box.
pub(super) fn read_box(settings: &Settings) -> Option<Aabb> {
    let (low, high) = (settings.triple("low"), settings.triple("high"));
    let (low, high) = (low?, high?);
    if (0..3).any(|axis| low[axis] >= high[axis]) {
        settings.fault("high", "the box has no volume", "each entry of `high` is above `low`");
        return None;
    }
    Some(Aabb { low: Point(low), high: Point(high) })
}
