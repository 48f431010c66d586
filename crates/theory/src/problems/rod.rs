//! Reflectance and transmittance of a rod, or a light seen through it: light that scatters forward and backward along a
//! line.
//!
//! ```text
//! a particle enters at the beginning, going forward; where it collides (rate σ_t) it is scattered
//! with probability a, and then goes on forward with probability p_f, else it turns round
//! reflectance R: it leaves at the beginning;  transmittance T: it leaves at the end
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it: the rod | is required |
//! | `albedo` | a in [0, 1]: a number, or a field, see below | required unless swept |
//! | `forward` | `p_f` in [0, 1], the probability that scattering keeps the direction; likewise | 0.5 |
//! | `absorbed` | whether the absorbed energy is a channel, scored at every collision: Σ w r (1 − a) | false |
//! | `flux` | up to 4: the mean flux, forward and backward together, in so many equal parts of the rod are channels too, scored at every tentative collision: Σ w/(σ̂ width) | none |
//! | `orders` | K, up to 6: reflectance and transmittance by order of scattering, 0 to K, are channels too | none |
//! | `sampling` | σ̂ of every estimator without its own | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale`; of several channels `contrast` in place of `albedo` | none |
//! | `estimators` | what is tested | required |
//!
//! A field of numbers along the rod is `{ piecewise-linear = { knots, values } }` or
//! `{ piecewise-constant = { breaks, values } }`, with distances along the ray; outside its knots the
//! first and the last value go on. In empty space the particle flies on, so that only the part of a
//! ray inside the field's bounds is the rod.
//!
//! Options choose another form of the problem, in which `absorbed`, `flux` and `orders` as above have no place:
//!
//! | option | what is sought | settings |
//! |---|---|---|
//! | `light = "emitter"` | the probability that a path of a camera at the beginning reaches an emitter of radiance 1, the end of the rod: T, by hits and by shadow rays | as above |
//! | `albedos` | R where it is not 0, and T, for each of 1 to 8 channels (wavelengths) by one draw | `albedos`: numbers; `forward`: a number; σ̂ ≥ σ_t |
//! | `albedos`, `light` and a list as `medium` or `volume` | what the camera sees of the emitter in 1 to 8 channels by one draw; each has its own σ_t, within the same bounds | `albedos`: numbers or fields, `forward`: a number, or a list with one for each channel; `sampling`: σ̂ ≥ σ_t for all channels or a list |
//! | `sensor = "transmitted"` or `"reflected"` | light that enters at the beginning and is scattered r times before it meets a sensor at the end, or at the beginning, by bidirectional path tracing: `I_r = ∫ ∏ᵢ a ρᵢ e^{−Σ dⱼ} du₁ … du_r`, u the optical depths of the scatterings | `albedo` and `forward`: numbers; `orders`: the highest r, up to 5, required; `lowest`: the lowest r (0, or 1 of reflected light); `shares`: whether what each technique contributes is a channel beside their sum (true) |
//!
//! **Emitter.** It touches the medium: a ray that ends beyond the field's bounds, or on which nothing is ever met, is a
//! mistake. In a rod it fills every direction in which it lies: a shadow ray finds it for certain, so that next-event
//! estimation has the pdf 1 for its direction, and unidirectional tracking the phase function, `p_f` or `1 − p_f`.
//!
//! **Channels.** With one extinction for all of them, `R_λ = Σ_r a_λ^r R_r` and `T_λ = Σ_r a_λ^r T_r`, r the number of
//! scatterings: all moments depend on the optical length alone and are closed forms. With a medium for each channel,
//! moments are exact where one channel is drawn at a time, and where all channels have the same σ_t and σ̂ and albedos
//! are numbers. Moments of hits are also exact if light only scatters forward and each cell is constant. Elsewhere
//! variances of draws that score all channels at once are bounded. Means, variances and the covariances of consecutive
//! channels are tested. One lookup answers σ_t of all channels.
//!
//! **Sensor.** A path of r scatterings has r + 2 vertices, light and sensor included, and can be made in r + 3 ways: its
//! first s vertices from the light, s = 0 … r + 2, the others from the sensor. Channels are what each technique
//! contributes, `s = 0` to `s = r + 2` (of several orders `r = …, s = …`), and `sum`; the estimator `technique`
//! has one technique only, and no shares. A record therefore holds shares and second moments by technique.
//!
//! The answer is exact. Where a and `p_f` are constant it is a closed form that depends on the optical
//! depth only; elsewhere, and by order, two coupled equations are solved to a stated error. An experiment
//! with a channel of answer 0 is refused: `absorbed` where `a = 1`, `reflectance` where `a = 0` or
//! `p_f = 1`, with a sensor an odd number of scatterings forward where `p_f = 0`.
//!
//! Sources: the two-stream equations of a rod, as in R. Bellman, R. Kalaba, G. M. Wing, *Invariant
//! Imbedding and Mathematical Physics*, Journal of Mathematical Physics 1 (1960); emitter, sensor and several media: B.
//! Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*, ACM Transactions on
//! Graphics 38 (2019), section 5; albedos: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking
//! for Rendering Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5, in one dimension.
//!
//! ```toml
//! title = "An example of rod"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["analog", "terminating", "weighted"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::slice;

use super::channels::{ColourValues, Colours, read_albedos};
use super::{Problem, ProblemOption, default_albedo, number};
use media::catalogue::{Domain, Node, Settings, Value};
use media::piecewise_linear::read_pieces;
use media::{Body, Medium, Piecewise};
use numeric::{Lane, Span};

/// The most channels that a draw can have.
pub const MAX_CHANNELS: usize = 20;
/// The most parts of a rod in which its flux is a channel.
pub const MAX_PARTS: usize = 4;
/// The highest order of scattering that has a channel of its own.
pub const HIGHEST_ORDER: u64 = 6;

/// Quantity of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RodQuantity {
    /// The weight that leaves at the beginning after this number of scatterings.
    ReflectedBy(usize),
    /// The weight that leaves at the end after this number of scatterings.
    TransmittedBy(usize),
    /// The mean flux in a part of the rod, from 0.
    Flux(usize),
    /// The energy absorbed on the way.
    Absorbed,
    /// The weight that leaves at the beginning.
    Reflected,
    /// The weight that leaves at the end.
    Transmitted,
}

impl RodQuantity {
    /// The channel's name.
    pub fn name(self) -> String {
        match self {
            Self::ReflectedBy(order) => format!("reflectance, order {order}"),
            Self::TransmittedBy(order) => format!("transmittance, order {order}"),
            Self::Flux(part) => format!("flux, part {}", part + 1),
            Self::Absorbed => "absorbed".to_owned(),
            Self::Reflected => "reflectance".to_owned(),
            Self::Transmitted => "transmittance".to_owned(),
        }
    }
}

/// A rod.
pub struct Rod {
    medium: Medium,
    /// a, as a function of the distance.
    pub albedo: Piecewise,
    /// `p_f`, as a function of the distance.
    pub forward: Piecewise,
    /// Quantities of the channels of a draw; the last two are always reflectance and transmittance.
    pub channels: Vec<RodQuantity>,
    /// Number of parts of the rod that have their flux as a channel: 0 or all of them.
    pub parts: usize,
}

/// The values of one draw, one per channel.
pub type Values = super::Values<MAX_CHANNELS>;

impl Rod {
    /// A rod with an albedo and a probability to scatter forward, both in `[0, 1]`.
    pub fn new(
        medium: Medium,
        albedo: &Piecewise,
        forward: &Piecewise,
        channels: Vec<RodQuantity>,
    ) -> Self {
        let span = medium.span();
        let parts =
            channels.iter().filter(|quantity| matches!(quantity, RodQuantity::Flux(_))).count();
        Self { medium, albedo: albedo.on(span), forward: forward.on(span), channels, parts }
    }

    /// Length of a part of the rod.
    pub fn width(&self) -> f64 {
        self.medium.support().length() / self.parts.max(1) as f64
    }

    /// Beginning of the rod.
    pub fn begin(&self) -> f64 {
        self.medium.support().from
    }

    /// The part that holds a distance inside the rod.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most the number of parts
    pub fn part(&self, t: f64) -> usize {
        let part = (t - self.begin()) / self.width();
        (part as usize).min(self.parts.saturating_sub(1))
    }

    /// Mask of the distances inside the rod, in widths of its parts, that lie in a part.
    #[inline(always)]
    pub fn is_in<L: Lane>(&self, part: usize, at: L) -> L::Mask {
        let (from, to) = (at.each(part as f64), at.each((part + 1) as f64));
        match part {
            0 if self.parts == 1 => at.at_most(at),
            0 => at.below(to),
            _ if part + 1 == self.parts => from.at_most(at),
            _ => from.at_most(at) & at.below(to),
        }
    }
}

/// The channels that a case requests.
pub fn channels(parts: usize, absorbed: bool, orders: Option<usize>) -> Vec<RodQuantity> {
    let mut channels: Vec<RodQuantity> = (0..parts).map(RodQuantity::Flux).collect();
    if let Some(highest) = orders {
        channels.push(RodQuantity::TransmittedBy(0));
        for order in 1..=highest {
            channels.extend([RodQuantity::ReflectedBy(order), RodQuantity::TransmittedBy(order)]);
        }
    }
    if absorbed {
        channels.push(RodQuantity::Absorbed);
    }
    channels.extend([RodQuantity::Reflected, RodQuantity::Transmitted]);
    channels
}

impl Problem for Rod {
    type Value = Values;

    #[allow(clippy::cast_possible_truncation)] // at most six and four
    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scattering = read_scattering(settings);
        let absorbed = settings.flag_or("absorbed", false);
        let parts = settings.count_or("flux", 0..=MAX_PARTS as u64, 0);
        let orders = settings.optional("orders", |key| settings.count(key, 0..=HIGHEST_ORDER));
        let medium = body?.medium();
        let [albedo, forward] = scattering?;
        let channels =
            channels(parts? as usize, absorbed?, orders.ok()?.map(|highest| highest as usize));
        Some(Self::new(medium, &albedo, &forward, channels))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let albedo = Piecewise::constant(albedo, self.medium.span());
        let (medium, channels) = (self.medium.clone(), self.channels.clone());
        Some(Self::new(medium, &albedo, &self.forward, channels))
    }
}

/// A rod with one albedo for each channel.
#[derive(Clone)]
pub struct SpectralRod {
    medium: Medium,
    /// The albedos.
    pub colours: Colours,
    /// `p_f`.
    pub forward: f64,
}

impl SpectralRod {
    /// A rod with albedos and a probability to scatter forward, all in `[0, 1]`.
    pub fn new(medium: Medium, albedos: Vec<f64>, forward: f64) -> Self {
        Self { medium, colours: Colours::new(albedos, forward < 1.0), forward }
    }
}

impl Problem for SpectralRod {
    type Value = ColourValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedos = read_albedos(settings);
        let forward = number(settings, "forward", Some(0.5));
        Some(Self::new(body?.medium(), albedos?, forward?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

/// Reads `albedo` and `forward`.
pub(super) fn read_scattering(settings: &Settings) -> Option<[Piecewise; 2]> {
    let albedo = share(settings, "albedo", default_albedo(settings));
    let forward = share(settings, "forward", Some(0.5));
    Some([albedo?, forward?])
}

/// Reads a share, a number or a field; `default` where the key is absent.
fn share(settings: &Settings, key: &'static str, default: Option<f64>) -> Option<Piecewise> {
    let value = settings.entry(key).map(|entry| &entry.node.value);
    if !matches!(value, Some(Value::Table(_))) {
        // The value goes on to both sides.
        let everywhere = |value| Piecewise::constant(value, Span::empty(0.0));
        return number(settings, key, default).map(everywhere);
    }
    let (index, field) = settings.chosen(key, &field_names())?;
    read_share(&field, index == 0, key)
}

/// Reads a list of shares, numbers or fields, one for each channel.
pub(super) fn shares(settings: &Settings, key: &'static str) -> Option<Vec<Piecewise>> {
    let value = settings.entry(key).map(|entry| &entry.node.value);
    let is_fields = |first: &Node| matches!(first.value, Value::Table(_));
    if !matches!(value, Some(Value::Array(list)) if list.first().is_some_and(is_fields)) {
        let numbers = settings.numbers(key, Domain::Unit, 1)?;
        let everywhere = |&value: &f64| Piecewise::constant(value, Span::empty(0.0));
        return Some(numbers.iter().map(everywhere).collect());
    }
    let read = |table: &Settings| {
        let (index, field) = table.choice(&field_names())?;
        read_share(&field, index == 0, key)
    };
    let read: Vec<Option<Piecewise>> = settings.tables(key)?.iter().map(read).collect();
    read.into_iter().collect()
}

fn field_names() -> [String; 2] {
    ["piecewise-constant".to_owned(), "piecewise-linear".to_owned()]
}

fn read_share(field: &Settings, is_steps: bool, key: &str) -> Option<Piecewise> {
    let pieces = read_pieces(field, is_steps);
    field.close();
    let pieces = pieces?;
    if pieces.corner_values().any(|value| value > 1.0) {
        let message = format!("`{key}` is a share, and exceeds 1");
        field.fault("values", message, "each value is between 0 and 1");
        return None;
    }
    Some(pieces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_channels_are_what_leaves() {
        assert_eq!(channels(0, false, None), [RodQuantity::Reflected, RodQuantity::Transmitted]);
        let all = channels(4, true, Some(6));
        assert_eq!(all.len(), MAX_CHANNELS);
        assert_eq!(all[MAX_CHANNELS - 2..], [RodQuantity::Reflected, RodQuantity::Transmitted]);
        assert_eq!(all[0].name(), "flux, part 1");
        assert_eq!(all[6].name(), "transmittance, order 1");
    }
}
