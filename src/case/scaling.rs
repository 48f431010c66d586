//! Sweeps of the medium: the numbers of a spec are changed, and the case is read again from the changed spec.
//!
//! Every page names the settings that its field is proportional to, all together ([`Stratified::EXTINCTIONS`]). A factor or
//! a blend of these settings is therefore exact, and theory has the same knowledge of a swept field as of a written
//! one. Numbers are rounded to 15 digits. A field that a program adds is compared with the field that the sweep should
//! have made.
//!
//! [`Stratified::EXTINCTIONS`]: media::Stratified::EXTINCTIONS

use crate::case::spec::Spec;
use crate::case::sweep::SweptQuantity;
use estimators::recipes::{controls, sampling};
use media::catalogue::{Entry, Fault, Node, OwnPages, Value};
use media::{CATALOGUE, Medium, reader};
use numeric::digits::number;

/// Keys of fields.
const FIELDS: [&str; 2] = ["medium", "volume"];

/// Number of places along the ray at which a field that a program adds is compared.
const PLACES: usize = 33;

/// Relative difference, in units of the largest σ_t, that rounding may make in a field that a program adds.
const AGREEMENT: f64 = 1e-9;

impl Spec {
    /// Returns the spec at a value of a sweep of the medium; a mistake that has no place of its own is at the sweep.
    ///
    /// # Errors
    ///
    /// The sweep does not apply to the case.
    pub fn at(&self, what: SweptQuantity, value: f64) -> Result<Self, Fault> {
        let mut spec = self.clone();
        let scaling = Scaling { own_pages: self.own_pages() };
        let settings = spec.problem_mut().map_or(&mut [][..], Vec::as_mut_slice);
        match what {
            SweptQuantity::Density => scaling.density(settings, value)?,
            SweptQuantity::AlbedoScale => scaling.albedo_scale(settings, value)?,
            SweptQuantity::Contrast => scaling.contrast(settings, value)?,
            SweptQuantity::Sampling
            | SweptQuantity::SamplingScale
            | SweptQuantity::Albedo
            | SweptQuantity::Control
            | SweptQuantity::Points => {}
        }
        Ok(spec)
    }
}

/// Returns whether the media of all channels at a value of a sweep are those as written, scaled by the sweep. Only
/// fields that a program adds are compared.
pub fn is_proportional(
    name: &str,
    [written, varied]: [&[Medium]; 2],
    what: SweptQuantity,
    x: f64,
) -> bool {
    let is_built_in = |name: &str| CATALOGUE.get(name).is_some();
    if name.split(", ").all(is_built_in) {
        return true;
    }
    let span = written.first().map(Medium::support).filter(|span| span.length().is_finite());
    let places = span.map(|span| {
        let place = move |i: usize| span.from + span.length() * ((i as f64 + 0.5) / PLACES as f64);
        (0..PLACES).map(place)
    });
    places.into_iter().flatten().all(|t| {
        let at = |medium: &Medium| medium.extinction(t);
        let mean = written.iter().map(at).sum::<f64>() / written.len() as f64;
        written.iter().zip(varied).all(|(written, varied)| {
            let expected = match what {
                SweptQuantity::Density => x * at(written),
                SweptQuantity::Contrast => (1.0 - x) * mean + x * at(written),
                _ => at(written),
            };
            (at(varied) - expected).abs() <= AGREEMENT * (expected.abs() + mean)
        })
    })
}

/// Numbers below a node that a sweep may change.
#[derive(Clone, Copy)]
enum Scope<'a> {
    /// No numbers.
    Nothing,
    /// All numbers.
    Numbers,
    /// Extinctions of the field that a table chooses.
    Field,
    /// Extinctions of the recipe for σ̂ that a table chooses.
    Sampling,
    /// Extinctions of the recipe for σ_c that a table chooses.
    Control,
    /// Numbers of the settings of these names.
    Settings(&'a [&'a str]),
}

/// Changes the settings of a problem.
struct Scaling<'a> {
    own_pages: &'a OwnPages,
}

impl Scaling<'_> {
    /// `x → s x` for all of σ_t, σ̂ and σ_c; a mistake is a field without a setting to multiply.
    fn density(&self, problem: &mut [Entry], factor: f64) -> Result<(), Fault> {
        let scale = |entry: &mut Entry| match &*entry.key {
            "medium" | "volume" => self.scale(&mut entry.node, Scope::Field, factor),
            "sampling" => self.scale(&mut entry.node, Scope::Sampling, factor),
            "control" => self.scale(&mut entry.node, Scope::Control, factor),
            _ => Ok(()),
        };
        problem.iter_mut().try_for_each(scale)?;
        of_estimators(problem).try_for_each(scale)
    }

    /// `a → s a` for the albedos of the medium; a mistake is a case without any.
    fn albedo_scale(&self, problem: &mut [Entry], factor: f64) -> Result<(), Fault> {
        let mut scaled = 0;
        for entry in problem.iter_mut().filter(|entry| matches!(&*entry.key, "albedo" | "albedos"))
        {
            let scope = share(&entry.node);
            self.walk(&mut entry.node, scope, &mut |x| {
                *x = rounded(*x * factor);
                scaled += 1;
            });
        }
        let help = "give `albedo` or `albedos`";
        if scaled > 0 { Ok(()) } else { Err(idle("the medium has no albedo", help)) }
    }

    /// `x_λ → (1 − c) x̄ + c x_λ` for settings that are listed channel by channel, x̄ the mean over the channels. An
    /// estimator's σ̂ for all channels is blended with the mean of the case's list. It is a mistake if channels differ
    /// in anything else, or if nothing is listed channel by channel.
    fn contrast(&self, problem: &mut [Entry], contrast: f64) -> Result<(), Fault> {
        let (mut blended, mut grey) = (false, None);
        for entry in problem.iter_mut() {
            let Value::Array(channels) = &mut entry.node.value else { continue };
            let scope = match (&*entry.key, channels.first()) {
                ("medium" | "volume", _) => Scope::Field,
                ("sampling", _) => Scope::Sampling,
                ("albedos" | "forward", first) => first.map_or(Scope::Numbers, share),
                _ => continue,
            };
            let mean = self.blended(channels, scope, contrast)?;
            blended = true;
            if entry.key == "sampling" {
                grey = Some(mean);
            }
        }
        for entry in of_estimators(problem).filter(|entry| entry.key == "sampling") {
            if let Value::Array(channels) = &mut entry.node.value {
                self.blended(channels, Scope::Sampling, contrast)?;
            } else if let Some(grey) = &grey {
                self.blend(&mut entry.node, Scope::Sampling, grey, contrast)?;
            }
        }
        let help = "list fields, `sampling` or `albedos` channel by channel";
        if blended { Ok(()) } else { Err(idle("no channel differs from another", help)) }
    }

    /// Multiplies the numbers of a scope.
    fn scale(&self, node: &mut Node, scope: Scope, factor: f64) -> Result<(), Fault> {
        match (&mut node.value, scope) {
            (Value::Array(items), _) => {
                items.iter_mut().try_for_each(|item| self.scale(item, scope, factor))
            }
            (_, Scope::Field) => {
                let mut count = 0;
                self.walk(node, scope, &mut |x| {
                    *x = rounded(*x * factor);
                    count += 1;
                });
                if count > 0 {
                    return Ok(());
                }
                let help = "write one, as a grid's `extinction = 1`, or take a field that has one";
                let message = "this field has no extinction to scale".to_owned();
                let span = node.span.clone();
                Err(Fault { span, path: String::new(), message, help: help.to_owned() })
            }
            (Value::Table(entries), _) => entries.iter_mut().try_for_each(|entry| {
                self.scale(&mut entry.node, self.within(scope, &entry.key), factor)
            }),
            (Value::Number(x), Scope::Numbers) => {
                *x = rounded(*x * factor);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Returns the scope of an entry within a table.
    fn within(&self, scope: Scope, key: &str) -> Scope<'static> {
        match scope {
            Scope::Numbers => Scope::Numbers,
            Scope::Field => Scope::Settings(reader::extinctions(key, self.own_pages)),
            Scope::Sampling => Scope::Settings(sampling::extinctions(key)),
            Scope::Control => Scope::Settings(controls::extinctions(key)),
            Scope::Settings(names) if names.contains(&key) => Scope::Numbers,
            // A control may be a field.
            Scope::Settings(_) if FIELDS.contains(&key) => Scope::Field,
            Scope::Settings(_) | Scope::Nothing => Scope::Nothing,
        }
    }

    /// Blends channels with their mean, and returns the mean.
    fn blended(&self, channels: &mut [Node], scope: Scope, contrast: f64) -> Result<Mean, Fault> {
        let share = 1.0 / channels.len() as f64;
        let mut mean: Option<Mean> = None;
        for channel in channels.iter_mut() {
            let mut numbers = Vec::new();
            let frame = self.walk(channel, scope, &mut |x| numbers.push(*x));
            let sum = mean.get_or_insert_with(|| Mean {
                numbers: vec![0.0; numbers.len()],
                frame: frame.clone(),
            });
            sum.check(&frame, channel)?;
            sum.numbers.iter_mut().zip(numbers).for_each(|(sum, x)| *sum += share * x);
        }
        let mean = mean.ok_or_else(|| idle("no channel is listed", "list one"))?;
        for channel in channels {
            self.blend(channel, scope, &mean, contrast)?;
        }
        Ok(mean)
    }

    /// Blends a channel with a mean.
    fn blend(
        &self,
        node: &mut Node,
        scope: Scope,
        mean: &Mean,
        contrast: f64,
    ) -> Result<(), Fault> {
        let mut means = mean.numbers.iter();
        let frame = self.walk(node, scope, &mut |x| {
            let mean = means.next().copied().unwrap_or(*x);
            *x = rounded((1.0 - contrast) * mean + contrast * *x);
        });
        mean.check(&frame, node)
    }

    /// Visits the numbers of a scope, and returns everything else in words.
    fn walk(&self, node: &mut Node, scope: Scope, visit: &mut dyn FnMut(&mut f64)) -> String {
        let (open, parts, close): (_, Vec<String>, _) = match &mut node.value {
            Value::Number(x) if matches!(scope, Scope::Numbers) => {
                visit(x);
                return "…".to_owned();
            }
            Value::Table(entries) => {
                let mut sorted: Vec<&mut Entry> = entries.iter_mut().collect();
                sorted.sort_by(|a, b| a.key.cmp(&b.key));
                let part = |entry: &mut Entry| {
                    let scope = self.within(scope, &entry.key);
                    format!("{} = {}", entry.key, self.walk(&mut entry.node, scope, visit))
                };
                ("{ ", sorted.into_iter().map(part).collect(), " }")
            }
            Value::Array(items) => {
                ("[", items.iter_mut().map(|item| self.walk(item, scope, visit)).collect(), "]")
            }
            Value::Number(x) => return number(*x),
            Value::Text(text) => return format!("{text:?}"),
            Value::Boolean(flag) => return flag.to_string(),
            Value::Other(what) => return (*what).to_owned(),
        };
        format!("{open}{}{close}", parts.join(", "))
    }
}

/// Mean of channels that differ in the numbers of a scope only.
struct Mean {
    numbers: Vec<f64>,
    /// Everything else in words.
    frame: String,
}

impl Mean {
    fn check(&self, frame: &str, node: &Node) -> Result<(), Fault> {
        if frame == self.frame {
            return Ok(());
        }
        let message = "this differs from the first in more than its extinctions".to_owned();
        let help = "give all channels the same field, with the same keys and places";
        Err(Fault { span: node.span.clone(), path: String::new(), message, help: help.to_owned() })
    }
}

/// Returns the scope of an albedo or of a probability to scatter forward, which is a number or a field.
fn share(node: &Node) -> Scope<'static> {
    match &node.value {
        Value::Array(items) => items.first().map_or(Scope::Numbers, share),
        Value::Table(_) => Scope::Field,
        _ => Scope::Numbers,
    }
}

/// Returns the settings of the estimators.
fn of_estimators(problem: &mut [Entry]) -> impl Iterator<Item = &mut Entry> {
    let listed = problem.iter_mut().filter(|entry| entry.key == "estimators");
    let tables = listed.flat_map(|entry| match &mut entry.node.value {
        Value::Array(tables) => tables.iter_mut(),
        _ => [].iter_mut(),
    });
    tables.flat_map(entries).flat_map(|estimator| entries(&mut estimator.node))
}

/// Returns the entries of a table; no entries for any other node.
fn entries(node: &mut Node) -> std::slice::IterMut<'_, Entry> {
    match &mut node.value {
        Value::Table(entries) => entries.iter_mut(),
        _ => [].iter_mut(),
    }
}

/// Returns the mistake of a sweep that changes nothing in the case.
fn idle(message: &str, help: &str) -> Fault {
    Fault { span: 0..0, path: String::new(), message: message.to_owned(), help: help.to_owned() }
}

/// Rounds to 15 digits, which removes rounding errors in the last one: 1.5600000000000001 becomes 1.56.
fn rounded(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}
