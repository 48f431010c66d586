//! `trueflight run`: the main job.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Context;
use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use trueflight::harness::record::{Record, Verdict};
use trueflight::harness::{Amount, Options, Plan, judge, run};
use trueflight::report::{self, console::View};

use super::baseline::BaselineArguments;
use super::output::{self, Format};
use super::selection::Selection;
use super::{Console, USAGE};

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// Folder for summary.csv, the cases' CSV files and the plots
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    /// Stop drawing after this time, such as 30s or 5m; results then depend on the machine
    #[arg(long, value_name = "T", value_parser = seconds)]
    time: Option<f64>,
    /// Draw exactly what is planned: no check stops the drawing, none prolongs it
    #[arg(long)]
    fixed_draws: bool,
    /// Let every underpowered check make its experiment inconclusive
    #[arg(long)]
    strict: bool,
    #[command(flatten)]
    baseline: BaselineArguments,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Draws, judges, writes, prints.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(console)?;
    let options = Options {
        seconds: arguments.time,
        fixed: arguments.fixed_draws,
        strict: arguments.strict,
        ..selection.options(Amount::Case)?
    };
    // Better to learn now than after the drawing that nothing can be written.
    writable(&arguments.out)?;
    let baselines = arguments.baseline.open()?;
    let record = selection.on_threads(|| {
        let plan = selection.plan(&cases, &options)?;
        Ok(draw(&plan, console))
    })?;
    let artifacts = report::render(&record)?;
    report::write(&artifacts, &arguments.out)?;
    output::print_record(&record, View::Run, arguments.format, console)?;
    if arguments.format == Format::Table && !console.quiet {
        let files = artifacts.len();
        output::print(&format!("{files} files in {}\n", arguments.out.display()))?;
    }
    let (compared, is_worse) = baselines.close(&record, &cases)?;
    if arguments.format == Format::Table && !console.quiet {
        output::print(&compared)?;
    } else if is_worse {
        output::complain(&anyhow::anyhow!("worse than the baseline\n{}", compared.trim_end()));
    }
    Ok(if is_worse { 1 } else { exit_code(&record) })
}

fn draw(plan: &Plan, console: &Console) -> Record {
    let begin = Instant::now();
    let bar = progress(plan, console);
    let draws = run::draw(plan, &|draws| bar.inc(draws));
    bar.finish_and_clear();
    judge::judged(plan, &draws, begin.elapsed().as_secs_f64())
}

fn progress(plan: &Plan, console: &Console) -> ProgressBar {
    let ready = plan.experiments().filter(|(_, planned)| planned.outcome.is_ok());
    let draws = ready.map(|(_, planned)| planned.draws).sum();
    let bar = ProgressBar::with_draw_target(Some(draws), ProgressDrawTarget::hidden());
    if !console.quiet && std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        let template = "drawing {wide_bar} {human_pos}/{human_len} draws, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
    }
    bar
}

/// Fail before refused cases before inconclusive before pass.
fn exit_code(record: &Record) -> u8 {
    let verdicts = || record.results.cases.iter().flat_map(|case| &case.rows);
    let any = |verdict| verdicts().any(|row| row.verdict == Some(verdict));
    if any(Verdict::Fail) {
        return 1;
    }
    let refused = record
        .results
        .cases
        .iter()
        .find(|case| case.rows.iter().all(|row| row.verdict == Some(Verdict::Refused)));
    if let Some(case) = refused {
        output::complain(&anyhow::anyhow!(
            "every experiment of {} is refused, so nothing was tested; \
             `trueflight plan` says why",
            case.name
        ));
        return USAGE;
    }
    if any(Verdict::Inconclusive) { 3 } else { 0 }
}

fn writable(out: &Path) -> anyhow::Result<()> {
    let cure = || format!("cannot write into {}; give another folder with --out", out.display());
    std::fs::create_dir_all(out).with_context(cure)?;
    tempfile::NamedTempFile::new_in(out).with_context(cure)?;
    Ok(())
}

fn seconds(text: &str) -> Result<f64, String> {
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
