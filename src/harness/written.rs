//! One estimator as a case file has it.

use super::case::{read_expect, read_kernel};
use super::sweep::What;
use crate::catalogue::{Page, Settings};
use crate::estimators::trial::Entry;
use crate::estimators::{Estimated, Order, Setup, controls, sampling};
use crate::media::Body;
use crate::problems::Problem;
use crate::theory::Prediction;

/// An estimator as written.
pub struct Written<P> {
    /// The name in the catalogue.
    pub name: String,
    /// The estimator with its own settings.
    pub entry: Box<dyn Entry<P>>,
    /// Its own σ̂.
    pub sampling: Option<Box<dyn sampling::Recipe>>,
    /// Its own control.
    pub control: Option<Box<dyn controls::Recipe>>,
    /// Whether the case declares it biased.
    pub expect_biased: bool,
    /// The kernel that is wished.
    pub order: Order,
}

/// What a case says of all its estimators, unless they say otherwise.
#[derive(Debug, Clone, Copy, Default)]
pub struct Usual {
    /// Whether they are declared biased.
    pub expect_biased: bool,
    /// The kernel of those that have it.
    pub order: Order,
    /// Whether there is a σ̂ for all.
    pub sampling: bool,
}

/// What an experiment is called.
#[derive(Debug, Clone, PartialEq)]
pub struct Names {
    /// The estimator with its settings.
    pub estimator: String,
    /// The constant σ̂.
    pub sampling: Option<f64>,
    /// σ̂ in words.
    pub sampling_kind: String,
    /// The control in words.
    pub control: String,
    /// The estimator that it is by definition, where that is another one.
    pub alias: Option<String>,
}

/// What theory says of the draws of a kernel.
pub fn predict<P: Problem>(entry: &dyn Entry<P>, setup: &Setup<P>, order: Order) -> Prediction {
    let prediction = entry.predict(setup);
    if order == Order::Free { prediction.order_free() } else { prediction }
}

/// Reads a table, if the file has it; `None` after a mistake.
#[allow(clippy::option_option)] // the outer `None` is a recorded mistake
pub fn read_if<T: ?Sized>(
    settings: &Settings,
    key: &'static str,
    body: Option<&Body>,
    read: fn(&Settings, Option<&Body>) -> Option<Box<T>>,
) -> Option<Option<Box<T>>> {
    match settings.table_if(key) {
        Some(table) => read(&table, body).map(Some),
        None if settings.has(key) => None,
        None => Some(None),
    }
}

impl<P: Problem> Written<P> {
    /// The estimator with its settings, as in `single (terminating, order-free)`.
    pub fn label(&self, albedo: bool) -> String {
        self.label_of(&self.name, albedo)
    }

    /// The same under the name of the estimator that it is by definition without a control.
    pub fn alias(&self) -> Option<String> {
        self.entry.without_control().map(|name| self.label_of(name, true))
    }

    fn label_of(&self, name: &str, albedo: bool) -> String {
        let mut settings = self.entry.label(albedo);
        if self.order() == Order::Free {
            let comma = if settings.is_empty() { "" } else { ", " };
            settings = format!("{settings}{comma}{}", Order::Free.word());
        }
        if settings.is_empty() { name.to_owned() } else { format!("{name} ({settings})") }
    }

    /// In which order the collisions of its draws come.
    pub fn order(&self) -> Order {
        if self.entry.is_order_free() { self.order } else { Order::Along }
    }
}

impl<P: Estimated> Written<P> {
    /// Reads `{ NAME = { …, sampling, control, expect, kernel } }`.
    pub fn read(table: &Settings, body: Option<&Body>, usual: Usual) -> Option<Self> {
        let names: Vec<String> = P::CATALOGUE.pages.iter().map(Page::name).collect();
        let (index, settings) = table.choice(&names)?;
        let entry = P::read_estimator(index, &settings);
        let own_expect =
            if settings.has("expect") { read_expect(&settings) } else { Some(usual.expect_biased) };
        let own_kernel = settings.has("kernel");
        let order = if own_kernel { read_kernel(&settings) } else { Some(usual.order) };
        let Some(entry) = entry else {
            // The page's own mistakes are listed; what it would have taken is not known.
            settings.entry("sampling");
            settings.entry("control");
            settings.close();
            return None;
        };
        // What the page takes with other settings is read, and not used.
        let (inputs, page) = (entry.inputs(), entry.may_take());
        let sampling = if page.sampling {
            let read = read_if(&settings, "sampling", body, sampling::read);
            read.map(|sampling| sampling.filter(|_| inputs.sampling))
        } else {
            Some(None)
        };
        let control = if page.control {
            let read = read_if(&settings, "control", body, controls::read);
            read.map(|control| control.filter(|_| inputs.control))
        } else {
            Some(None)
        };
        if inputs.sampling && !settings.has("sampling") && !usual.sampling {
            let message = format!("`{}` has no sampling extinction", names[index]);
            let help = "add `sampling.constant.value = …` to it or to the problem, or sweep it";
            settings.fault_at(settings.span.clone(), "", message, help);
        }
        if own_kernel && order == Some(Order::Free) && !entry.is_order_free() {
            let message = format!("`{}` has no order-free kernel", names[index]);
            settings.fault("kernel", message, "product estimators have one; leave `kernel` out");
        }
        settings.close();
        Some(Self {
            name: names[index].clone(),
            entry,
            sampling: sampling?,
            control: control?,
            expect_biased: own_expect?,
            order: order?,
        })
    }
}

/// A control, or a sweep of one, that no estimator takes is a mistake.
pub fn refuse_idle_controls<P: Estimated>(
    settings: &Settings,
    written: &[Written<P>],
    swept: Option<What>,
) {
    if written.is_empty() || written.iter().any(|written| written.entry.inputs().control) {
        return;
    }
    let message = "no estimator of this case takes a control";
    let help = "leave it out, or list one that does: see `trueflight list estimators`";
    if settings.has("control") {
        settings.fault("control", message, help);
    }
    if matches!(swept, Some(What::Control | What::Points)) {
        settings.fault("sweep", message, help);
    }
}
