//! The estimators of a case or a picture: their own settings, σ̂ and control.

use crate::case::forms::explain_estimator;
use crate::case::id::EstimatorName;
use crate::case::sweep::SweptQuantity;
use estimators::own::EstimatorReader;
use estimators::recipes::sampling::spectral::Spectral;
use estimators::recipes::{controls, sampling};
use estimators::trial::Entry;
use estimators::{Estimated, Traits};
use media::Body;
use media::catalogue::{Mistake, Settings, Value};
use theory::problems::ProblemOption;

/// An estimator as parsed, apart from its own settings, which the problem keeps.
pub struct ParsedEstimator {
    /// The name in the catalogue.
    pub name: String,
    /// Its properties.
    pub traits: Traits,
    /// Its own σ̂.
    pub sampling: Option<Box<dyn sampling::Recipe>>,
    /// Its own control.
    pub control: Option<Box<dyn controls::Recipe>>,
    /// True if the case declares it biased.
    pub expect_biased: bool,
}

/// Settings for all estimators of a case that have none of their own.
#[derive(Debug, Clone, Copy, Default)]
pub struct Defaults {
    /// True if they are declared biased.
    pub expect_biased: bool,
    /// True if the case gives a σ̂ for all.
    pub sampling: bool,
    /// Swept quantity.
    pub swept: Option<SweptQuantity>,
    /// True if every lookup must be counted: then σ̂ may not be learned from lookups that are not.
    pub counts_lookups: bool,
}

/// Reads `expect = "biased"`; `None` after a mistake.
pub fn read_expect(settings: &Settings) -> Option<bool> {
    settings.word_or("expect", &["unbiased", "biased"], "unbiased").map(|word| word == "biased")
}

/// The forms of `sampling` and `control`, for messages.
const RECIPE: &str = "a number, a name in quotes, or a table, as in { constant = { value = … } }";

/// Reads a recipe, if the file has it.
fn read_if<T: ?Sized>(
    settings: &Settings,
    key: &'static str,
    body: Option<&Body>,
    read: fn(&Settings, Option<&Body>) -> Option<Box<T>>,
) -> Result<Option<Box<T>>, Mistake> {
    settings.optional(key, |key| settings.naming(key, RECIPE).and_then(|table| read(&table, body)))
}

/// Reads `sampling`, a table, or a list with one for each channel of a spectral medium, if the file has it.
fn read_sampling(
    settings: &Settings,
    body: Option<&Body>,
) -> Result<Option<Box<dyn sampling::Recipe>>, Mistake> {
    let entry = settings.entry("sampling");
    if !entry.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
        return read_if(settings, "sampling", body, sampling::read);
    }
    let tables = settings.tables("sampling").ok_or(Mistake)?;
    if let Some(body) = body.filter(|body| body.channels().len() != tables.len()) {
        let message = format!(
            "`sampling` lists {} channels, and the medium has {}",
            tables.len(),
            body.channels().len()
        );
        settings.fault("sampling", message, "give one σ̂ for each channel, or one table for all");
        return Err(Mistake);
    }
    let recipes: Vec<_> = tables.iter().map(|table| sampling::read(table, body)).collect();
    let recipes = recipes.into_iter().collect::<Option<Vec<_>>>().ok_or(Mistake)?;
    Ok((!recipes.is_empty()).then(|| Box::new(Spectral::new(recipes)) as Box<_>))
}

impl ParsedEstimator {
    /// Returns a name with the estimator's own settings, as in `single (terminating)`.
    fn label_of(&self, name: &str, albedo: bool) -> EstimatorName {
        EstimatorName { name: name.to_owned(), settings: self.traits.label(albedo) }
    }

    /// Returns the estimator with its settings; without `albedo` the albedo is left out.
    pub fn label(&self, albedo: bool) -> EstimatorName {
        self.label_of(&self.name, albedo)
    }

    /// Returns the label under the name of the estimator that it is by definition without a control.
    pub fn alias(&self) -> Option<EstimatorName> {
        self.traits.without_control.map(|name| self.label_of(name, true))
    }

    /// Reads the common settings of `{ NAME = { …, sampling, control, expect } }`, beside the estimator's own.
    fn read(
        name: &str,
        traits: Option<Traits>,
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<Self> {
        let own_expect = if settings.has("expect") {
            read_expect(settings)
        } else {
            Some(defaults.expect_biased)
        };
        let Some(traits) = traits else {
            // The page's mistakes are listed; the inputs that it would have taken are unknown.
            settings.entry("sampling");
            settings.entry("control");
            settings.close();
            return None;
        };
        // Inputs that the page takes with other settings are read, and not used.
        let Traits { inputs, may_take, .. } = traits;
        let sampling = if may_take.sampling {
            let read = read_sampling(settings, body);
            read.map(|sampling| sampling.filter(|_| inputs.sampling))
        } else {
            Ok(None)
        };
        let control = if may_take.control {
            let read = read_if(settings, "control", body, controls::read);
            read.map(|control| control.filter(|_| inputs.control))
        } else {
            Ok(None)
        };
        if inputs.sampling && !settings.has("sampling") && !defaults.sampling {
            let message = format!("`{name}` has no sampling extinction");
            let help = "add `sampling = …` to it or to the problem, or sweep it";
            settings.fault_at(settings.span.clone(), "", message, help);
        }
        settings.close();
        Some(Self {
            name: name.to_owned(),
            traits,
            sampling: sampling.ok()?,
            control: control.ok()?,
            expect_biased: own_expect?,
        })
    }
}

/// Estimators that a problem offers, without its type.
struct Offer {
    problem: &'static str,
    options: &'static [ProblemOption],
    /// Names of the built-in ones, then of the program's own.
    names: Vec<String>,
}

/// Reads the own settings of the estimator at a place of an offer, keeps its entry, and returns its traits; `None` after
/// a mistake.
type Keep<'a> = dyn FnMut(usize, &Settings) -> Option<Traits> + 'a;

/// Entries of estimators of a problem.
type Entries<P> = Vec<Box<dyn Entry<P>>>;

/// Calls `read` with the estimators of problem `P`, and returns the entries that it kept. Here alone the reader depends on
/// the problem's type: all else is compiled once for all problems.
fn reading<P: Estimated, T>(
    settings: &Settings,
    read: &dyn Fn(&Offer, &mut Keep) -> Option<T>,
) -> Option<(T, Entries<P>)> {
    let own_pages = settings.own_pages().of::<EstimatorReader<P>>();
    let mut offer = Offer { problem: P::MODULE, options: P::OPTIONS, names: Vec::new() };
    let mut readers = Vec::new();
    for (page, reader) in P::CATALOGUE.entries().chain(own_pages) {
        offer.names.push(page.name());
        readers.push(reader);
    }
    let mut entries = Vec::new();
    let actual = read(&offer, &mut |index, settings| {
        let entry = readers[index].0(settings)?;
        let traits = entry.traits();
        entries.push(entry);
        Some(traits)
    })?;
    Some((actual, entries))
}

impl Offer {
    /// Reads `{ NAME = { … } }`: an estimator, and the common settings beside its own.
    fn read(
        &self,
        keep: &mut Keep,
        table: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<ParsedEstimator> {
        let problem = self.problem.replace('_', "-");
        let explain = |name: &str| explain_estimator(&problem, self.options, name);
        let (index, settings) = table.choice_explained(&self.names, &explain)?;
        let traits = keep(index, &settings);
        ParsedEstimator::read(&self.names[index], traits, &settings, body, defaults)
    }
}

/// Reads `{ NAME = { … } }`: an estimator of problem `P`, and the common settings beside its own.
pub fn read<P: Estimated>(
    table: &Settings,
    body: Option<&Body>,
    defaults: Defaults,
) -> Option<(ParsedEstimator, Box<dyn Entry<P>>)> {
    let read = |offer: &Offer, keep: &mut Keep| offer.read(keep, table, body, defaults);
    let (parsed, mut entries) = reading(table, &read)?;
    Some((parsed, entries.pop()?))
}

/// Refuses a σ̂ that learns from lookups if every lookup must be counted; `None` after a mistake.
fn countable(
    settings: &Settings,
    defaults: Defaults,
    sampling: Option<&dyn sampling::Recipe>,
) -> Option<()> {
    if defaults.counts_lookups && sampling.is_some_and(sampling::Recipe::learns) {
        let help = "give `sampling.constant.value = …`: in a picture every lookup counts";
        settings.fault("sampling", "this σ̂ is learned by lookups that nobody counts", help);
        return None;
    }
    Some(())
}

/// Estimators of a case or a picture, in its order, with σ̂ and control for all.
pub struct Estimators {
    /// The estimators.
    pub list: Vec<ParsedEstimator>,
    sampling: Option<Box<dyn sampling::Recipe>>,
    control: Option<Box<dyn controls::Recipe>>,
}

/// Estimators of problem `P`, and the entries that make their draws.
pub type EstimatorsOf<P> = (Estimators, Vec<Box<dyn Entry<P>>>);

impl Estimators {
    /// Reads `sampling`, `control` and `estimators` of problem `P`, with the entries that make the draws.
    pub fn read<P: Estimated>(
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<EstimatorsOf<P>> {
        reading(settings, &|offer, keep| Self::read_of(offer, keep, settings, body, defaults))
    }

    fn read_of(
        offer: &Offer,
        keep: &mut Keep,
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<Self> {
        let sampling = read_sampling(settings, body);
        let control = read_if(settings, "control", body, controls::read);
        let list = settings.tables("estimators").map(|tables| {
            let mut read = |table: &Settings| {
                let parsed = offer.read(keep, table, body, defaults)?;
                countable(table, defaults, parsed.sampling.as_deref())?;
                Some(parsed)
            };
            tables.iter().map(&mut read).collect::<Vec<_>>()
        });
        if let Ok(Some(sampling)) = &sampling {
            countable(settings, defaults, Some(sampling.as_ref()))?;
        }
        let list = list?;
        if list.is_empty() {
            let help = "list one, as in { ratio = {} }";
            settings.fault("estimators", "no estimator is listed", help);
        }
        let list: Vec<_> = list.into_iter().collect::<Option<_>>()?;
        refuse_idle_controls(settings, &list, defaults.swept);
        Some(Self { list, sampling: sampling.ok()?, control: control.ok()? })
    }

    /// Returns the σ̂ of an estimator; `None` if it takes none.
    pub fn sampling_of<'a>(
        &'a self,
        parsed: &'a ParsedEstimator,
    ) -> Option<&'a dyn sampling::Recipe> {
        let expected = parsed.traits.inputs.sampling;
        expected.then(|| parsed.sampling.as_deref().or(self.sampling.as_deref())).flatten()
    }

    /// Returns the control that the case gives for an estimator.
    pub fn given_control<'a>(
        &'a self,
        parsed: &'a ParsedEstimator,
    ) -> Option<&'a dyn controls::Recipe> {
        let expected = parsed.traits.inputs.control;
        expected.then(|| parsed.control.as_deref().or(self.control.as_deref())).flatten()
    }

    /// Returns the control of an estimator.
    pub fn control_of<'a>(&'a self, parsed: &'a ParsedEstimator) -> &'a dyn controls::Recipe {
        let default = parsed.traits.default_control.as_deref();
        let default = default.filter(|_| parsed.traits.inputs.control);
        self.given_control(parsed).or(default).unwrap_or(&controls::none::None)
    }
}

/// Records a mistake for a control, or a sweep of one, that no estimator takes.
fn refuse_idle_controls(
    settings: &Settings,
    estimators: &[ParsedEstimator],
    swept: Option<SweptQuantity>,
) {
    if estimators.is_empty() || estimators.iter().any(|e| e.traits.inputs.control) {
        return;
    }
    let message = "no estimator of this case takes a control";
    let help = "leave it out, or list one that does: see `trueflight list estimators`";
    if settings.has("control") {
        settings.fault("control", message, help);
    }
    if matches!(swept, Some(SweptQuantity::Control | SweptQuantity::Points)) {
        settings.fault("sweep", message, help);
    }
}
