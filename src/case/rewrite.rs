//! Sweeps of the medium itself: the numbers of a case are rewritten, and it is read anew.
//!
//! Every field is proportional to its [`EXTINCTIONS`], all together: what is multiplied or blended here is multiplied or
//! blended exactly, and theory knows of it all that it knows of what is written. Numbers are rounded to 15 digits.

use media::catalogue::{Entry, Fault, Node, Value};
use numeric::digits::number;

/// Changes the table `[problem.NAME]` for a value of a sweep; a mistake that has no place of its own is the sweep's.
pub type Rewrite = fn(&mut [Entry], f64) -> Result<(), Fault>;

/// The settings in 1/length that fields, σ̂ and controls are proportional to, all together.
pub const EXTINCTIONS: [&str; 8] =
    ["extinction", "values", "base", "peak", "coefficients", "amplitudes", "value", "start"];

/// Where fields are written.
const FIELDS: [&str; 2] = ["medium", "volume"];

/// `x → s x` for all of σ_t, σ̂ and σ_c.
///
/// # Errors
///
/// A field without a setting to multiply.
pub fn density(problem: &mut [Entry], factor: f64) -> Result<(), Fault> {
    const EXTINCT: [&str; 4] = ["medium", "volume", "sampling", "control"];
    let scale_all = |entries: &mut dyn Iterator<Item = &mut Entry>| {
        let mut extinct = entries.filter(|entry| EXTINCT.contains(&&*entry.key));
        extinct.try_for_each(|entry| scale(entry, factor))
    };
    scale_all(&mut problem.iter_mut())?;
    scale_all(&mut of_estimators(problem))
}

/// `a → s a` for the albedos of the medium.
///
/// # Errors
///
/// A case without any.
pub fn albedo_scale(problem: &mut [Entry], factor: f64) -> Result<(), Fault> {
    let albedos = problem.iter_mut().filter(|entry| matches!(&*entry.key, "albedo" | "albedos"));
    let scaled: usize = albedos.map(|entry| multiply(&mut entry.node, factor)).sum();
    let help = "give `albedo` or `albedos`";
    if scaled > 0 { Ok(()) } else { Err(idle("the medium has no albedo", help)) }
}

/// `x_λ → (1 − c) x̄ + c x_λ` for what is listed channel by channel, x̄ the mean over the channels; an estimator's σ̂ for
/// all channels about the mean of the case's list.
///
/// # Errors
///
/// Channels that differ in more than that, or nothing that is listed channel by channel.
pub fn contrast(problem: &mut [Entry], contrast: f64) -> Result<(), Fault> {
    const BY_CHANNEL: [&str; 5] = ["medium", "volume", "sampling", "albedos", "forward"];
    let (mut blended, mut grey) = (false, None);
    for entry in problem.iter_mut().filter(|entry| BY_CHANNEL.contains(&&*entry.key)) {
        let Value::Array(channels) = &mut entry.node.value else { continue };
        let mean = Mean::blended(channels, contrast)?;
        blended = true;
        if entry.key == "sampling" {
            grey = Some(mean);
        }
    }
    for entry in of_estimators(problem).filter(|entry| entry.key == "sampling") {
        if let Value::Array(channels) = &mut entry.node.value {
            Mean::blended(channels, contrast)?;
        } else if let Some(grey) = &grey {
            grey.blend(&mut entry.node, contrast)?;
        }
    }
    let help = "list fields, `sampling` or `albedos` channel by channel";
    if blended { Ok(()) } else { Err(idle("no channel differs from another", help)) }
}

/// The settings of the estimators.
fn of_estimators(problem: &mut [Entry]) -> impl Iterator<Item = &mut Entry> {
    let listed = problem.iter_mut().filter(|entry| entry.key == "estimators");
    let tables = listed.flat_map(|entry| match &mut entry.node.value {
        Value::Array(tables) => tables.iter_mut(),
        _ => [].iter_mut(),
    });
    tables.flat_map(entries).flat_map(|estimator| entries(&mut estimator.node))
}

/// The entries of a table; none of anything else.
fn entries(node: &mut Node) -> std::slice::IterMut<'_, Entry> {
    match &mut node.value {
        Value::Table(entries) => entries.iter_mut(),
        _ => [].iter_mut(),
    }
}

/// Multiplies what fields, σ̂ and controls are proportional to.
fn scale(entry: &mut Entry, factor: f64) -> Result<(), Fault> {
    let items = match &mut entry.node.value {
        Value::Array(items) => items.iter_mut(),
        _ => std::slice::from_mut(&mut entry.node).iter_mut(),
    };
    for item in items {
        if FIELDS.contains(&&*entry.key) {
            if multiply(item, factor) == 0 {
                let help = "write one, as a grid's `extinction = 1`, or take a field that has one";
                let message = "this field has no extinction to scale".to_owned();
                let span = item.span.clone();
                return Err(Fault { span, path: String::new(), message, help: help.to_owned() });
            }
        } else if EXTINCTIONS.contains(&&*entry.key) {
            walk(item, true, &mut |x| *x = rounded(*x * factor));
        } else {
            entries(item).try_for_each(|entry| scale(entry, factor))?;
        }
    }
    Ok(())
}

/// Multiplies numbers, or what a field is proportional to; answers how many.
fn multiply(node: &mut Node, factor: f64) -> usize {
    let mut count = 0;
    walk(node, !has_tables(node), &mut |x| {
        *x = rounded(*x * factor);
        count += 1;
    });
    count
}

/// The mean of settings that differ in numbers alone which fields are proportional to.
struct Mean {
    numbers: Vec<f64>,
    /// All else that they say.
    frame: String,
}

impl Mean {
    /// Blends channels with their mean, and answers that.
    fn blended(channels: &mut [Node], contrast: f64) -> Result<Self, Fault> {
        let mean = Self::of(channels)?;
        channels.iter_mut().try_for_each(|channel| mean.blend(channel, contrast))?;
        Ok(mean)
    }

    fn of(channels: &mut [Node]) -> Result<Self, Fault> {
        let share = 1.0 / channels.len() as f64;
        let mut mean: Option<Self> = None;
        for channel in channels {
            let mut numbers = Vec::new();
            let frame = walk(channel, !has_tables(channel), &mut |x| numbers.push(*x));
            let sum = mean.get_or_insert_with(|| Self {
                numbers: vec![0.0; numbers.len()],
                frame: frame.clone(),
            });
            sum.check(&frame, channel)?;
            sum.numbers.iter_mut().zip(numbers).for_each(|(sum, x)| *sum += share * x);
        }
        mean.ok_or_else(|| idle("no channel is listed", "list one"))
    }

    fn check(&self, frame: &str, node: &Node) -> Result<(), Fault> {
        if frame == self.frame {
            return Ok(());
        }
        let message = "this differs from the first in more than its extinctions".to_owned();
        let help = "give all channels the same field, with the same keys and places";
        Err(Fault { span: node.span.clone(), path: String::new(), message, help: help.to_owned() })
    }

    fn blend(&self, node: &mut Node, contrast: f64) -> Result<(), Fault> {
        let mut means = self.numbers.iter();
        let frame = walk(node, !has_tables(node), &mut |x| {
            let mean = means.next().copied().unwrap_or(*x);
            *x = rounded((1.0 - contrast) * mean + contrast * *x);
        });
        self.check(&frame, node)
    }
}

/// Whether a setting is made of fields, not of numbers.
fn has_tables(node: &Node) -> bool {
    match &node.value {
        Value::Array(items) => items.iter().any(has_tables),
        value => matches!(value, Value::Table(_)),
    }
}

/// Visits the numbers that are free to change, all of them or those of extinctions, and answers the rest in words.
fn walk(node: &mut Node, free: bool, visit: &mut dyn FnMut(&mut f64)) -> String {
    let (open, parts, close): (_, Vec<String>, _) = match &mut node.value {
        Value::Number(x) if free => {
            visit(x);
            return "…".to_owned();
        }
        Value::Table(entries) => {
            let mut sorted: Vec<&mut Entry> = entries.iter_mut().collect();
            sorted.sort_by(|a, b| a.key.cmp(&b.key));
            let part = |entry: &mut Entry| {
                let free = free || EXTINCTIONS.contains(&&*entry.key);
                format!("{} = {}", entry.key, walk(&mut entry.node, free, visit))
            };
            ("{ ", sorted.into_iter().map(part).collect(), " }")
        }
        Value::Array(items) => {
            ("[", items.iter_mut().map(|item| walk(item, free, visit)).collect(), "]")
        }
        Value::Number(x) => return number(*x),
        Value::Text(text) => return format!("{text:?}"),
        Value::Boolean(flag) => return flag.to_string(),
        Value::Other(what) => return (*what).to_owned(),
    };
    format!("{open}{}{close}", parts.join(", "))
}

/// A sweep of what the case has not.
fn idle(message: &str, help: &str) -> Fault {
    Fault { span: 0..0, path: String::new(), message: message.to_owned(), help: help.to_owned() }
}

/// Without the noise of the last digit: 1.5600000000000001 reads better as 1.56.
fn rounded(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}
