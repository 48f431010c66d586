//! The walk of product estimators: Woodcock, ratio, residual ratio, single and double particle, weighted delta tracking.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support
//! ```
//!
//! It is the algorithm *Transmittance* of Szirmay-Kalos et al. 2017, section 4.2, for any rule at a collision.
//! Where the rule decides by a random number, a step takes one, whether it is used or not.
//!
//! Every draw keeps an invariant. At a collision the rule takes a share from the particle. At any time the weight
//! and the shares taken so far sum to the weight at the beginning, to rounding:
//!
//! ```text
//! X(S) + Σᵢ X(tᵢ⁻)(1 − (1 − rᵢ)/qᵢ) = T_c
//! ```

use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Draw, Kernel, Request, Setup};
use media::sampling::BothWays;
use media::{Control, Lookups};
use numeric::rng::{Random, Stream};
use numeric::{Lane, kept};
use theory::collisions::rules::{self, Collision};
use theory::problems::Transmittance;

/// The walk of a product estimator.
pub struct Product<'a, R> {
    /// The rule at a collision.
    rule: &'a R,
    control: Subtracted<'a>,
    /// T_c.
    begin: f64,
}

/// σ_c, which is subtracted from σ_t.
#[derive(Clone, Copy)]
pub struct Subtracted<'a> {
    control: &'a Control,
    /// The value of a constant control, so that no step has to look for it.
    constant: Option<f64>,
}

impl<'a> Subtracted<'a> {
    /// The control of a setup.
    #[inline(always)]
    pub fn new(control: &'a Control) -> Self {
        Self { control, constant: control.single_value() }
    }

    /// `σ_c` at distances.
    #[inline(always)]
    pub fn extinction<L: Lane>(&self, t: L) -> L {
        match self.constant {
            Some(constant) => t.each(constant),
            None => self.control.extinction(t),
        }
    }
}

impl<R> Clone for Product<'_, R> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Product<'_, R> {}

impl<'a, R> Product<'a, R> {
    /// The walk on a setup.
    #[inline(always)]
    pub fn new(rule: &'a R, setup: &'a Setup<Transmittance>) -> Self {
        let control = Subtracted::new(&setup.fields.control);
        Self { rule, control, begin: setup.fields.control_transmittance() }
    }
}

kept! {
    /// A particle of a product estimator.
    pub struct ProductParticle<L> {
        weight: L,
        invariant: Invariant<L>,
    }
}

impl<R: Collision> Walk for Product<'_, R> {
    type State<L: Lane> = ProductParticle<L>;

    const DECIDES: bool = R::DECIDES;
    const IS_FIXED: bool = true;
    const HAS_DEFECT: bool = true;
    const INLINES_GRID: bool = !R::DECIDES;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> ProductParticle<L> {
        let weight = one.each(self.begin);
        ProductParticle { weight, invariant: Invariant::open(weight) }
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        particle: &mut ProductParticle<L>,
        which: L::Mask,
        _: L,
        _: &mut impl Random<L>,
    ) {
        particle.weight.set_where(which, particle.invariant.begin);
        particle.invariant.restart(which);
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        particle: &mut ProductParticle<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, t, mean_free_path, extinction, number, .. } = *extinctions;
        let residual = extinction - self.control.extinction(t);
        let extinctions =
            rules::Extinctions { residual, sampling: route.here.sampling(), mean_free_path };
        let (ratio, outcome) = (extinctions.ratio(), self.rule.at(extinctions.ratio()));
        let goes_on =
            if R::DECIDES { inside & !self.rule.absorption(&extinctions, number) } else { inside };
        let ProductParticle { weight, invariant } = particle;
        // In walks that end, too: the restart overwrites them.
        invariant.take(*weight, self.rule.unbiased_weight(ratio, outcome.survival));
        *weight = *weight * outcome.weight;
        goes_on
    }

    #[inline(always)]
    fn value<L: Lane>(&self, particle: &ProductParticle<L>, left: L::Mask, _: usize) -> L {
        let weight = particle.weight;
        if R::DECIDES { L::select(left, weight, weight.each(0.0)) } else { weight }
    }

    #[inline(always)]
    fn defect<L: Lane>(&self, particle: &ProductParticle<L>, _: L) -> L {
        particle.invariant.defect(particle.weight)
    }
}

kept! {
    /// A particle that keeps its weight until it is killed.
    pub struct Survivor<L> {
        /// `Σ min(r, 0)`, the change that the weight should have had.
        missing: L,
    }
}

/// The walk of a rule that keeps the weight of survivors: Woodcock tracking.
///
/// With `0 ≤ r ≤ 1` the probability to go on is `q = 1 − r`, and a survivor's due is `(1 − r)/q = 1`: the invariant of
/// [`Product`] holds without being followed. A negative r, which the rule does not allow, breaks it.
pub struct Survival<'a, R>(pub Product<'a, R>);

impl<R> Clone for Survival<'_, R> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Survival<'_, R> {}

impl<R: Collision> Walk for Survival<'_, R> {
    type State<L: Lane> = Survivor<L>;

    const IS_FIXED: bool = true;
    const IS_SURVIVAL: bool = true;
    const HAS_DEFECT: bool = true;
    const INLINES_EQ21: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Survivor<L> {
        Survivor { missing: one.each(0.0) }
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        survivor: &mut Survivor<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, t, mean_free_path, extinction, number, .. } = *extinctions;
        let residual = extinction - self.0.control.extinction(t);
        let extinctions =
            rules::Extinctions { residual, sampling: route.here.sampling(), mean_free_path };
        let goes_on = inside & !self.0.rule.absorption(&extinctions, number);
        let (zero, ratio) = (t.each(0.0), extinctions.ratio());
        // NaN stays NaN.
        let is_missing = !zero.at_most(ratio);
        survivor.missing.add_where(is_missing, ratio);
        goes_on
    }

    #[inline(always)]
    fn value<L: Lane>(&self, survivor: &Survivor<L>, left: L::Mask, _: usize) -> L {
        let zero = survivor.missing.each(0.0);
        L::select(left, zero.each(self.0.begin), zero)
    }

    #[inline(always)]
    fn defect<L: Lane>(&self, survivor: &Survivor<L>, _: L) -> L {
        survivor.missing.size()
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw<R: Collision>(
    setup: &Setup<Transmittance>,
    rule: &R,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    let walk = Product::new(rule, setup);
    if R::WEIGHS {
        walks::draw(&walk, &setup.fields.sampling, medium, random)
    } else {
        walks::draw(&Survival(walk), &setup.fields.sampling, medium, random)
    }
}

/// Makes the draws of a request.
pub fn fill<R: Collision>(
    kernel: Kernel,
    setup: &Setup<Transmittance>,
    rule: &R,
    request: Request,
) {
    let walk = Product::new(rule, setup);
    if R::WEIGHS {
        walks::fill(&walk, kernel, setup, request);
    } else {
        walks::fill(&Survival(walk), kernel, setup, request);
    }
}

kept! {
    /// The weight of a particle at the beginning, and the shares that its collisions took.
    pub struct Invariant<L> {
        /// The weight at the beginning.
        pub begin: L,
        /// The shares that collisions took.
        pub taken: L,
        /// The sum of the absolute values of all terms, the scale of rounding.
        pub scale: L,
    }
}

impl<L: Lane> Invariant<L> {
    /// Invariant of a particle that begins with a weight.
    #[inline(always)]
    pub fn open(weight: L) -> Self {
        Self { begin: weight, taken: weight.each(0.0), scale: weight.size() }
    }

    /// Adds the share that a collision takes from a particle that survives it: all but `unbiased_weight`, `(1 − r)/q`.
    #[inline(always)]
    pub fn take(&mut self, weight: L, unbiased_weight: L) {
        let share = weight * (weight.each(1.0) - unbiased_weight);
        self.taken = self.taken + share;
        self.scale = self.scale + share.size();
    }

    /// Adds the share in some lanes.
    #[inline(always)]
    pub fn take_where(&mut self, which: L::Mask, weight: L, unbiased_weight: L) {
        let share = weight * (weight.each(1.0) - unbiased_weight);
        self.taken.add_where(which, share);
        self.scale.add_where(which, share.size());
    }

    /// Resets some lanes.
    #[inline(always)]
    pub fn restart(&mut self, which: L::Mask) {
        self.taken.set_where(which, self.begin.each(0.0));
        self.scale.set_where(which, self.begin.size());
    }

    /// Relative deviation from the invariant at the end; rounding in a correct walk.
    #[inline(always)]
    pub fn defect(&self, weight: L) -> L {
        (weight + self.taken - self.begin).size() / self.scale
    }
}
