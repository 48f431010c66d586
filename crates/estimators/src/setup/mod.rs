//! What an estimator works on, prepared once per experiment, and what it may require of it. Floor 4.

pub mod channels;
pub mod domain;
pub mod heroes;
pub mod walker;

use std::sync::Arc;

use crate::recipes::{Refusal, sampling};
use media::{Control, Majorants, OpticalDepth, Piecewise};
use numeric::{Lane, Span};
use theory::problems::Problem;
use theory::{Mesh, Rule, product::Product};

/// A gap shorter than this share of the support is flown through.
const SHORTEST_GAP: f64 = 1.0 / 16.0;

/// A channel (wavelength) of a spectral problem.
#[derive(Clone)]
pub struct SpectralChannel {
    /// Its medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// Its σ̂ on the support.
    pub sampling: Piecewise,
    /// σ̂, 1/length, where it is one constant, as walks that score several channels need; else 0.
    pub majorant: f64,
    /// `ln σ̂`.
    pub ln_majorant: f64,
    /// `∫σ̂`.
    pub collisions: f64,
}

impl SpectralChannel {
    /// Joins the parts; σ̂ is restricted to the support.
    pub fn new(mesh: Arc<Mesh>, sampling: &Piecewise) -> Self {
        let support = mesh.support();
        let sampling = sampling.on(support);
        let majorant = sampling.single_value().unwrap_or(0.0);
        let collisions = majorant * support.length();
        Self { mesh, sampling, majorant, ln_majorant: Lane::ln(majorant), collisions }
    }
}

/// A problem with everything that its estimators need.
pub struct Setup<P> {
    /// What is sought.
    pub problem: Arc<P>,
    /// The medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// σ̂ on the support; zero for estimators that take none.
    pub sampling: Piecewise,
    /// σ̂ in space, for problems whose particles leave the ray.
    pub space: Option<Arc<Majorants>>,
    /// σ_c.
    pub control: Control,
    /// Draws are in units of `exp(−log_unit)`, see [`Problem::log_unit`].
    pub log_unit: f64,
    /// `T_c = exp(−∫σ_c)` over the support, in units of `exp(−log_unit)`.
    pub control_transmittance: f64,
    /// The same from the beginning of the support to each of the problem's distances.
    pub control_curve: Vec<f64>,
    /// `T` over the support, in units of `exp(−log_unit)`.
    pub transmittance: f64,
    /// The share of the support on which σ̂ is 0 because the residual is, see [`Setup::skipping`]; in
    /// space that of the box about the volume.
    pub skipped: f64,
    /// Whether whole laws are asked for; a search for optima leaves them out.
    pub laws: bool,
    /// The channels of spectral problems, of which the first is `mesh` and `sampling`; empty for others.
    pub channels: Vec<SpectralChannel>,
}

impl<P: Problem> Setup<P> {
    /// Joins the parts; σ̂ is restricted to the support.
    pub fn new(
        problem: Arc<P>,
        mesh: Arc<Mesh>,
        sampling: Option<Piecewise>,
        control: Control,
    ) -> Self {
        let support = mesh.support();
        let sampling = sampling.unwrap_or_else(|| Piecewise::constant(0.0, support)).on(support);
        // Both enter draws: this crate's exponential, the same on every machine.
        let depth = mesh.optical_depth().value;
        let log_unit = problem.log_unit(depth);
        let control_over =
            |span: Span| Lane::exp(log_unit - control.optical_depth(span.intersect(support)).value);
        let control_transmittance = control_over(support);
        let upto = |&distance: &f64| control_over(Span::new(support.from, distance));
        let control_curve = problem.distances().iter().map(upto).collect();
        let transmittance = Lane::exp(log_unit - depth);
        Self {
            problem,
            mesh,
            sampling,
            space: None,
            control,
            log_unit,
            control_transmittance,
            control_curve,
            transmittance,
            skipped: 0.0,
            laws: true,
            channels: Vec::new(),
        }
    }

    /// The same with the media and σ̂ of channels after the first, which makes the problem spectral.
    #[must_use]
    pub fn spectral(mut self, further: Vec<(Arc<Mesh>, Option<Piecewise>)>) -> Self {
        let none = Piecewise::constant(0.0, self.mesh.support());
        let first = SpectralChannel::new(self.mesh.clone(), &self.sampling);
        let further = further
            .into_iter()
            .map(|(mesh, sampling)| SpectralChannel::new(mesh, sampling.as_ref().unwrap_or(&none)));
        self.channels = std::iter::once(first).chain(further).collect();
        self
    }

    /// The same with σ̂ in space, where particles leave the ray: one constant, or what a recipe makes,
    /// times a factor.
    ///
    /// # Errors
    ///
    /// A recipe that only knows rays.
    pub fn in_space(
        mut self,
        constant: Option<f64>,
        recipe: Option<&dyn sampling::Recipe>,
        factor: f64,
    ) -> Result<Self, Refusal> {
        let Some(volume) = self.problem.volume() else { return Ok(self) };
        let majorants = match (constant, recipe) {
            (Some(value), _) => Some(Majorants::constant(value, volume)),
            (None, Some(recipe)) => recipe.in_space(volume),
            (None, None) => return Ok(self),
        };
        let Some(majorants) = majorants else {
            let needs = "σ̂ in space: `constant`, or `local-majorants` with a `grid`";
            let found = recipe.map_or_else(String::new, sampling::Recipe::label);
            return Err(Refusal::mismatch(needs, format!("σ̂ is given along the ray ({found})")));
        };
        let majorants = majorants.scaled(factor);
        self.skipped = majorants.empty_share();
        self.space = Some(Arc::new(majorants));
        Ok(self)
    }

    /// The same with σ̂ = 0 where medium and control are: at both ends of the support, and on gaps
    /// that are long enough to be worth a piece of σ̂. Collisions there would multiply weights by 1;
    /// so would all where the residual is 0 throughout, which leaves nothing of σ̂.
    #[must_use]
    pub fn skipping(mut self) -> Self {
        let support = self.mesh.support();
        let is_worth = |stretch: &Span| {
            let is_at_end = stretch.from == support.from || stretch.to == support.to;
            is_at_end || stretch.length() >= SHORTEST_GAP * support.length()
        };
        let mut stretches = self.empty_stretches();
        stretches.retain(is_worth);
        stretches.retain(|&stretch| self.sampling.optical_depth(stretch).value > 0.0);
        if !stretches.is_empty() {
            self.sampling = self.sampling.zero_on(&stretches);
            self.skipped = stretches.iter().map(|s| s.length()).sum::<f64>() / support.length();
        }
        self
    }

    /// The longest stretches on which medium and control are 0, or the whole support where they are
    /// the same.
    fn empty_stretches(&self) -> Vec<Span> {
        let cut = self.mesh.refined(&self.control.breaks(), &|_, _| Vec::new());
        let is_nothing = |t: f64, sigma: f64| sigma == 0.0 && self.control.extinction(t) == 0.0;
        let is_residual = |t: f64, sigma: f64| sigma != self.control.extinction(t);
        let (mut stretches, mut is_same) = (Vec::<Span>::new(), true);
        for panel in cut.panels() {
            let nodes = || panel.t.iter().zip(panel.extinction);
            is_same &= !nodes().any(|(&t, &sigma)| is_residual(t, sigma));
            if !nodes().all(|(&t, &sigma)| is_nothing(t, sigma)) {
                continue;
            }
            match stretches.last_mut() {
                Some(last) if last.to == panel.span.from => last.to = panel.span.to,
                _ => stretches.push(panel.span),
            }
        }
        if is_same {
            stretches = vec![self.mesh.support()];
        }
        // What hides between the nodes shows in the integral.
        stretches.retain(|&stretch| {
            let medium = self.mesh.medium().optical_depth(stretch);
            let control = self.control.optical_depth(stretch);
            (medium.value - control.value).abs() <= medium.error + control.error
        });
        stretches
    }

    /// `r`, where medium, control and σ̂ are each one constant on the support.
    pub fn constant_ratio(&self) -> Option<f64> {
        let control = match &self.control {
            Control::None => 0.0,
            Control::Pieces(pieces) => pieces.single_value()?,
            Control::Field(_) => return None,
        };
        let sampling = self.sampling.single_value().filter(|&value| value > 0.0)?;
        let mut extinctions = self.mesh.panels().flat_map(|panel| panel.extinction);
        let first = *extinctions.next()?;
        extinctions.all(|&x| x == first).then_some((first - control) / sampling)
    }

    /// The product estimator with the given rule, for theory.
    pub fn product<'a>(&'a self, rule: &'a dyn Rule) -> Product<'a> {
        let product = Product::new(&self.mesh, &self.sampling, &self.control, rule);
        Product { laws: self.laws, log_unit: self.log_unit, ..product }
    }
}
