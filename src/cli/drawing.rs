//! Drawing a plan with a bar of progress, and the limits of it.

use std::time::Instant;

use indicatif::ProgressBar;
use trueflight::harness::record::Record;
use trueflight::harness::{Plan, judge, run};

use super::{Console, output};

/// Draws a plan and judges it.
pub fn draw(plan: &Plan, console: &Console) -> Record {
    let begin = Instant::now();
    let bar = progress(plan, console);
    let draws = run::draw(plan, &|draws| bar.inc(draws));
    bar.finish_and_clear();
    judge::judged(plan, &draws, begin.elapsed().as_secs_f64())
}

fn progress(plan: &Plan, console: &Console) -> ProgressBar {
    let ready = plan.experiments().filter(|(_, planned)| planned.outcome.is_ok());
    let draws = ready.map(|(_, planned)| planned.draws).sum();
    output::progress("drawing", "draws", draws, console)
}

/// A time such as 30s, 5m or 1h, in seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix(['s', 'm', 'h']) {
        Some(number) if text.ends_with('m') => (number, 60.0),
        Some(number) if text.ends_with('h') => (number, 3600.0),
        Some(number) => (number, 1.0),
        None => (text, 1.0),
    };
    match number.parse::<f64>() {
        Ok(time) if time > 0.0 && time.is_finite() => Ok(time * unit),
        _ => Err("it takes a time such as 30s, 5m or 1h".into()),
    }
}

/// What a run may cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// So many seconds.
    Seconds(f64),
    /// So many draws of all experiments together.
    Draws(u64),
}

/// A time with its unit, or a number of draws.
pub fn budget(text: &str) -> Result<Budget, String> {
    let budget = if text.ends_with(['s', 'm', 'h']) {
        seconds(text).map(Budget::Seconds)
    } else {
        super::selection::draws(text).map(Budget::Draws)
    };
    budget.map_err(|_| "it takes a time such as 30s or 5m, or a number of draws such as 1e8".into())
}
