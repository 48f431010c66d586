//! Steps that walks of several problems share: into a slab, into another direction, roulette.

use numeric::Lane;
use numeric::rng::Random;
use theory::problems::slab::IncidentLight;

/// The cosines with which particles enter a slab. Only lanes in the mask take a random number, and only for diffuse light,
/// which `diffuse` makes a cosine of.
#[inline(always)]
pub fn entering<L: Lane>(
    light: IncidentLight,
    diffuse: impl FnOnce(L) -> L,
    which: L::Mask,
    one: L,
    random: &mut impl Random<L>,
) -> L {
    match light {
        IncidentLight::Collimated(cosine) => one.each(cosine),
        IncidentLight::Diffuse => diffuse(random.uniform_where(which)),
    }
}

/// The cosine of diffuse light, in `(0, 1]`, from a uniform number.
#[inline(always)]
pub fn diffuse<L: Lane>(number: L) -> L {
    number.one_minus().root()
}

/// The cosine with the normal after a deflection about the direction of travel.
#[inline(always)]
pub fn turned<L: Lane>(cosine: L, deflection: L, azimuth: L) -> L {
    let (zero, one) = (cosine.each(0.0), cosine.each(1.0));
    let across = (one - cosine * cosine) * (one - deflection * deflection);
    // Rounding may carry a sum past 1, and a product below 0.
    let turned = cosine * deflection + across.or_more(zero).root() * azimuth;
    turned.or_less(one).or_more(-one)
}

/// Lanes of `goes_on` that survive roulette, with their weights: below w₀ a weight becomes ±w₀ with probability |w|/w₀, else the
/// walk ends. Without w₀ all go on.
#[inline(always)]
pub fn roulette<L: Lane>(
    below: Option<f64>,
    goes_on: L::Mask,
    weight: &mut L,
    random: &mut impl Random<L>,
) -> L::Mask {
    let Some(minimum) = below.map(|minimum| weight.each(minimum)) else { return goes_on };
    let size = weight.size();
    let plays = goes_on & size.below(minimum);
    let survives = (random.uniform_where(plays) * minimum).below(size);
    weight.set_where(plays, minimum.with_sign_of(*weight));
    goes_on & (!plays | survives)
}
