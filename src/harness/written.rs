//! One estimator as a case file has it.

use super::case::read_expect;
use crate::catalogue::{Page, Settings};
use crate::estimators::trial::Entry;
use crate::estimators::{Estimated, controls, sampling};
use crate::media::Body;

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

impl<P: Estimated> Written<P> {
    /// Reads `{ NAME = { …, sampling, control, expect } }`.
    pub fn read(
        table: &Settings,
        body: Option<&Body>,
        expect_biased: bool,
        shared: bool,
    ) -> Option<Self> {
        let names: Vec<String> = P::CATALOGUE.pages.iter().map(Page::name).collect();
        let (index, settings) = table.choice(&names)?;
        let entry = P::read_estimator(index, &settings);
        let own_expect =
            if settings.has("expect") { read_expect(&settings) } else { Some(expect_biased) };
        let Some(entry) = entry else {
            // The page's own mistakes are listed; what it would have taken is not known.
            settings.entry("sampling");
            settings.entry("control");
            settings.close();
            return None;
        };
        let inputs = entry.inputs();
        let sampling = if inputs.sampling {
            read_if(&settings, "sampling", body, sampling::read)
        } else {
            Some(None)
        };
        let control = if inputs.control {
            read_if(&settings, "control", body, controls::read)
        } else {
            Some(None)
        };
        if inputs.sampling && !settings.has("sampling") && !shared {
            let message = format!("`{}` has no sampling extinction", names[index]);
            let help = "add `sampling.constant.value = …` to it or to the problem, or sweep it";
            settings.fault_at(settings.span.clone(), "", message, help);
        }
        settings.close();
        Some(Self {
            name: names[index].clone(),
            entry,
            sampling: sampling?,
            control: control?,
            expect_biased: own_expect?,
        })
    }
}
