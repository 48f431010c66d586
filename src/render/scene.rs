//! A picture's subject with its estimators: where names become types.

use std::sync::Arc;

use rayon::prelude::*;

use super::expose::{Exposed, Listed, Pixel, Plan, Seen};
use super::reference::Reference;
use super::subject::Subject;
use super::view::View;
use crate::catalogue::Settings;
use crate::estimators::{controls, sampling};
use crate::harness::written::{Usual, Written, read_if, refuse_idle_controls};
use crate::media::Body;
use crate::numeric::Known;
use crate::rng::{Address, name_hash};

/// What a rendering needs to know.
pub struct Request<'a> {
    /// The seed of all random numbers.
    pub seed: u64,
    /// The picture's name.
    pub name: &'a str,
    /// Is told of every row that is done, of the first pass and of the second.
    pub progress: &'a (dyn Fn() + Sync),
}

/// How an estimator is called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Called {
    /// With its settings.
    pub estimator: String,
    /// σ̂ in words.
    pub sampling: String,
    /// The control in words.
    pub control: String,
}

impl Called {
    fn in_one(&self) -> String {
        format!("{}|{}|{}", self.estimator, self.sampling, self.control)
    }
}

/// What was found for all covered pixels.
pub struct Rendered {
    /// The lookups per covered pixel that were to be taken.
    pub budget: u64,
    /// The numbers of the covered pixels.
    pub covered: Vec<usize>,
    /// How the reference was found, and the reference.
    pub reference: (String, Exposed),
    /// What each estimator found, or why it did not.
    pub exposures: Vec<(Called, Result<Exposed, String>)>,
}

/// A scene whose problem is no longer visible.
pub trait AnyScene: Send + Sync {
    /// What the camera sees.
    fn view(&self) -> &View;

    /// Plans and draws.
    fn render(&self, request: &Request) -> Rendered;
}

/// A volume, a camera and estimators of one problem.
pub struct Scene<P: Subject> {
    pub(super) view: View,
    pub(super) shared: P::Shared,
    pub(super) sampling: Option<Box<dyn sampling::Recipe>>,
    pub(super) control: Option<Box<dyn controls::Recipe>>,
    lookups: u64,
    written: Vec<Written<P>>,
    reference: Reference<P>,
}

impl<P: Subject> Scene<P> {
    /// Reads all that `[picture.NAME]` holds.
    pub fn read(settings: &Settings) -> Option<Box<dyn AnyScene>> {
        let view = View::read(settings, P::SHOWS_SKY);
        let shared = P::read_shared(settings, view.as_ref());
        if let (Some(view), Some(shared)) = (&view, &shared) {
            let rays = (0..view.pixels()).filter_map(|pixel| view.covered(pixel));
            if let Some([found, help]) =
                rays.map(|ray| P::allows(shared, &ray)).find_map(Result::err)
            {
                settings.fault("light", found, help);
            }
        }
        // Recipes are read for the ray of the first pixel, and prepared for each.
        let body = view.as_ref().and_then(|view| {
            let (name, volume, ray) = (view.medium.clone(), view.volume.clone(), view.ray(0)?);
            Some(Body::Volume { name, volume, ray })
        });
        let body = body.as_ref();
        let lookups = settings.count("lookups", 1..=1_000_000_000);
        let sampling = read_if(settings, "sampling", body, sampling::read);
        let control = read_if(settings, "control", body, controls::read);
        let usual = Usual { sampling: settings.has("sampling"), ..Usual::default() };
        let estimators = settings.tables("estimators").map(|tables| {
            let read = |table: &Settings| {
                let written = Written::<P>::read(table, body, usual);
                let learns = written.as_ref().and_then(|w| w.sampling.as_ref());
                countable(table, learns.map(AsRef::as_ref))?;
                written
            };
            tables.iter().map(read).collect::<Vec<_>>()
        });
        if let Some(Some(sampling)) = &sampling {
            countable(settings, Some(sampling.as_ref()))?;
        }
        let reference = Reference::read(settings, shared.as_ref(), body, usual);
        let estimators = estimators?;
        if estimators.is_empty() {
            let help = "list one, as in { ratio = {} }";
            settings.fault("estimators", "no estimator is listed", help);
        }
        let written: Option<Vec<Written<P>>> = estimators.into_iter().collect();
        refuse_idle_controls(settings, written.as_deref().unwrap_or_default(), None);
        Some(Box::new(Self {
            view: view?,
            shared: shared?,
            sampling: sampling?,
            control: control?,
            lookups: lookups?,
            written: written?,
            reference: reference?,
        }))
    }

    fn called(&self, written: &Written<P>) -> Called {
        let sampling = self.sampling_of(written).map(|recipe| match recipe.constant() {
            Some(value) => value.to_string(),
            None => recipe.label(),
        });
        Called {
            estimator: written.label(true),
            sampling: sampling.unwrap_or_default(),
            control: self.with_control(written, |recipe| recipe.label()),
        }
    }

    /// σ̂ of an estimator.
    pub(super) fn sampling_of<'a>(
        &'a self,
        written: &'a Written<P>,
    ) -> Option<&'a dyn sampling::Recipe> {
        let wanted = written.entry.inputs().sampling;
        wanted.then(|| written.sampling.as_deref().or(self.sampling.as_deref())).flatten()
    }

    /// Calls `f` with the control of an estimator.
    pub(super) fn with_control<T>(
        &self,
        written: &Written<P>,
        f: impl FnOnce(&dyn controls::Recipe) -> T,
    ) -> T {
        if !written.entry.inputs().control {
            return f(&controls::none::None);
        }
        if let Some(own) = written.control.as_deref().or(self.control.as_deref()) {
            return f(own);
        }
        match written.entry.default_control() {
            Some(default) => f(default.as_ref()),
            None => f(&controls::none::None),
        }
    }

    /// Every covered pixel in turn, on all threads: what `f` answers, in the order of the pixels.
    fn over<T: Send>(
        &self,
        covered: &[usize],
        progress: &(dyn Fn() + Sync),
        f: impl Fn(usize, &Seen<P>) -> T + Sync,
    ) -> Vec<T> {
        let [width, height] = self.view.size;
        let row = |row: usize| {
            let first = covered.partition_point(|&pixel| pixel < row * width);
            let end = covered.partition_point(|&pixel| pixel < (row + 1) * width);
            let seen = (first..end).filter_map(|i| {
                Seen::new(&self.view, &self.shared, covered[i]).map(|seen| f(i, &seen))
            });
            let answers: Vec<T> = seen.collect();
            progress();
            answers
        };
        let rows: Vec<Vec<T>> = (0..height).into_par_iter().map(row).collect();
        rows.into_iter().flatten().collect()
    }

    /// The estimators, and after them that of the reference if it is drawn.
    fn listed(&self, request: &Request) -> Vec<Listed<'_, P>> {
        let mut listed: Vec<Listed<P>> = Vec::new();
        let reference = match &self.reference {
            Reference::Draws { lookups, written } => Some((&**written, *lookups, "reference")),
            _ => None,
        };
        let images = self.written.iter().map(|written| (written, self.lookups, "image"));
        for (written, lookups, kind) in images.chain(reference) {
            let called = self.called(written);
            let twins = listed.iter().filter(|other| other.called == called).count();
            let name = format!("picture|{}|{}|{twins}|{kind}", request.name, called.in_one());
            let address = |what: &str| {
                let experiment = name_hash(&format!("{name}|{what}"));
                Address { seed: request.seed, experiment, block: 0, lane: 0 }
            };
            let recipe = self.sampling_of(written).filter(|_| !P::ALONG_RAY);
            let space = recipe.and_then(|recipe| recipe.in_space(&*self.view.volume)).map(Arc::new);
            let addresses = ["pilot", "draws"].map(address);
            listed.push(Listed { written, called, lookups, space, addresses });
        }
        listed
    }
}

/// The lookups of pilot rays are nobody's: pictures compare at equal lookups.
fn countable(settings: &Settings, sampling: Option<&dyn sampling::Recipe>) -> Option<()> {
    if sampling.is_some_and(sampling::Recipe::learns) {
        let help = "give `sampling.constant.value = …`: in a picture every lookup counts";
        settings.fault("sampling", "this σ̂ is learned by lookups that nobody counts", help);
        return None;
    }
    Some(())
}

impl<P: Subject> AnyScene for Scene<P> {
    fn view(&self) -> &View {
        &self.view
    }

    fn render(&self, request: &Request) -> Rendered {
        let covered: Vec<usize> =
            (0..self.view.pixels()).filter(|&pixel| self.view.covered(pixel).is_some()).collect();
        let listed = self.listed(request);
        // First pass: what a draw costs at every pixel, and how far it is spread.
        let forecasts = self.over(&covered, request.progress, |number, seen| {
            let forecast = |listed: &Listed<P>| self.forecast(number, seen, listed);
            listed.iter().map(forecast).collect::<Vec<_>>()
        });
        let plan = |(index, listed): (usize, &Listed<P>)| {
            let points = self.with_control(listed.written, |recipe| recipe.lookups());
            Plan::new(forecasts.iter().map(|all| &all[index]), points, listed.lookups)
        };
        let plans: Vec<Result<Plan, String>> = listed.iter().enumerate().map(plan).collect();
        // Second pass: the draws.
        let pixels = self.over(&covered, request.progress, |number, seen| {
            let draw = |(listed, plan): (&Listed<P>, &Result<Plan, String>)| {
                let draws = plan.as_ref().ok()?.draws_of(number);
                self.draw(number, seen, listed, draws)
            };
            let drawn: Vec<Option<Pixel>> = listed.iter().zip(&plans).map(draw).collect();
            (drawn, self.answer(seen))
        });
        let (pixels, answers): (Vec<_>, Vec<_>) = pixels.into_iter().unzip();
        let mut exposures: Vec<(Called, Result<Exposed, String>)> = Vec::new();
        for (index, (listed, plan)) in listed.iter().zip(&plans).enumerate() {
            let of_pixel = |all: &Vec<Option<Pixel>>| all[index];
            let exposed = plan.as_ref().map_err(String::clone).and_then(|plan| {
                let pixels: Option<Vec<Pixel>> = pixels.iter().map(of_pixel).collect();
                pixels.map(|pixels| plan.expose(&pixels)).ok_or_else(|| "no image".to_owned())
            });
            exposures.push((listed.called.clone(), exposed));
        }
        let reference = self.reference_of(&mut exposures, &answers);
        Rendered { budget: self.lookups, covered, reference, exposures }
    }
}

impl<P: Subject> Scene<P> {
    /// The exact or quadrature answer of a pixel; `None` where the reference is drawn.
    fn answer(&self, seen: &Seen<P>) -> Option<Known> {
        let found = match self.reference {
            Reference::Exact => seen.problem.exact(),
            Reference::Quadrature { panels } => seen.problem.by_quadrature(panels),
            Reference::Draws { .. } => None,
        };
        found.map(|known| Known::new(known.value * seen.sky, known.error * seen.sky))
    }

    fn reference_of(
        &self,
        exposures: &mut Vec<(Called, Result<Exposed, String>)>,
        answers: &[Option<Known>],
    ) -> (String, Exposed) {
        let how = match &self.reference {
            Reference::Exact => "closed form".to_owned(),
            Reference::Quadrature { panels } => {
                format!("Gauss quadrature, {} nodes", 32 * panels)
            }
            Reference::Draws { .. } => {
                let Some((called, outcome)) = exposures.pop() else {
                    return (String::new(), Exposed::default());
                };
                return match outcome {
                    Ok(exposed) => (format!("many draws of {}", called.estimator), exposed),
                    Err(refusal) => (format!("none: {refusal}"), Exposed::default()),
                };
            }
        };
        let answers = || answers.iter().flatten();
        let exposed = Exposed {
            values: answers().map(|known| known.value).collect(),
            square_errors: answers().map(|known| known.error * known.error).collect(),
            ..Exposed::default()
        };
        (how, exposed)
    }
}
