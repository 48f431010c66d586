//! A complete program: the command `trueflight` with one more medium and one more estimator.
//!
//! `cargo run --release --example own_binary -- run examples/own_binary/two-rays.toml` draws, judges and plots;
//! `bench`, `list`, `explain two-rays` and the other commands take both names, too.

use std::process::ExitCode;

use trueflight::case::catalogue::NameTaken;
use trueflight::catalogue::{OwnPage, Page, Settings};
use trueflight::estimators::own::estimator;
use trueflight::media::own::Formula;
use trueflight::problems::Transmittance;
use trueflight::{Catalogue, page};

mod two_rays;

/// Returns the built-in pages with two of this program.
///
/// # Errors
///
/// A name is taken.
pub fn catalogue() -> Result<Catalogue, NameTaken> {
    let haze = Page { module: "haze", source: "Haze that thins out: σ_t = 1/(1 + t²)." };
    let read = |_: &Settings| Some(Formula::new(|t: f64| 1.0 / (1.0 + t * t)));
    let two_rays = estimator::<Transmittance, two_rays::TwoRays>(page!(two_rays));
    Catalogue::builtin().with(OwnPage::line(haze, &[], read))?.with(two_rays)
}

fn main() -> ExitCode {
    match catalogue() {
        Ok(catalogue) => trueflight::cli::main(&catalogue),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
