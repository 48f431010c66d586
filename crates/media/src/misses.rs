//! Messages for rays and spans that miss their medium: every estimator gives the right answer for them, and tests
//! nothing.

use super::body::RayNeed;
use super::{Body, Medium, Volume};
use numeric::digits::number;
use numeric::digits::short;
use numeric::geometry::{Bounds, Point, Ray};

/// Warnings about a body and its ray, a sentence each, without repetitions. A problem that needs only a line
/// follows it to the end of the volume.
pub fn notes(body: &Body, need: RayNeed) -> Vec<String> {
    let mut notes: Vec<String> = Vec::new();
    for channel in body.channels() {
        let note = match channel {
            Body::Volume { .. } if need == RayNeed::Nothing => None,
            Body::Volume { name, volume, ray } => {
                let is_bounded = volume.bounds().enclosing_box().is_some();
                let length =
                    if need == RayNeed::Line && is_bounded { f64::MAX } else { ray.length };
                let ray = Ray { length, ..*ray };
                let (name, volume) = (name.clone(), volume.clone());
                of_volume(&*volume.clone(), &ray, &Body::Volume { name, volume, ray }.medium())
            }
            one => of_line(&one.medium()),
        };
        notes.extend(note.filter(|note| !notes.contains(note)));
    }
    notes
}

fn of_line(medium: &Medium) -> Option<String> {
    if medium.span().is_empty() {
        return Some("the span has the length 0, and holds nothing of the medium".to_owned());
    }
    is_nothing(medium).then(|| "σ_t is 0 along the whole span".to_owned())
}

fn of_volume(volume: &Volume, ray: &Ray, medium: &Medium) -> Option<String> {
    let bounds = volume.bounds();
    let inside = medium.support();
    if ray.span().is_empty() {
        return Some("the ray has the length 0, and meets nothing of the volume".to_owned());
    }
    if inside.is_empty() {
        return Some(format!(
            "the ray meets nothing of the volume, whose {}: {}",
            place(bounds),
            cure(bounds, ray)
        ));
    }
    let [from, to] = [inside.from, inside.to].map(|t| short(t, 6));
    is_nothing(medium).then(|| match bounds {
        Bounds::Everywhere => "σ_t is 0 along the whole ray".to_owned(),
        _ => format!(
            "the ray meets nothing of the volume, whose {}: it is in there from {from} to {to}, and σ_t is 0 along the \
             whole ray",
            place(bounds)
        ),
    })
}

/// Returns whether σ_t is 0 on all of an interval of positive length.
fn is_nothing(medium: &Medium) -> bool {
    let support = medium.support();
    !support.is_empty() && medium.optical_depth(support).value == 0.0
}

/// Bounds in words, such as "box is [0, 0, 0] to [1, 1, 1]".
pub fn place(bounds: Bounds) -> String {
    let point = |point: Point| format!("[{}]", point.0.map(|x| short(x, 6)).join(", "));
    match bounds {
        Bounds::Everywhere => "bounds are nowhere".to_owned(),
        Bounds::Box(bounds) => format!("box is {} to {}", point(bounds.low), point(bounds.high)),
        Bounds::Sphere { centre, radius } => {
            format!("ball has the radius {} about {}", number(radius), point(centre))
        }
    }
}

/// Cause and cure of a ray that misses its volume.
fn cure(bounds: Bounds, ray: &Ray) -> String {
    let [ahead, behind] = [1.0, -1.0].map(|sign| {
        let direction = ray.direction * sign;
        bounds.clip(&Ray { direction, length: f64::MAX, ..*ray })
    });
    if !ahead.is_empty() {
        let (end, begin) = (number(ray.length), short(ahead.from, 6));
        format!("it ends at {end}, before the volume begins at {begin}; make `length` larger")
    } else if !behind.is_empty() {
        "it points away from it; turn `direction` about, or move `origin`".to_owned()
    } else {
        "it passes beside it; move `origin`, or turn `direction`".to_owned()
    }
}
