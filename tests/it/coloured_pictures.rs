//! Pictures of three channels: their colours, their errors, and messages about mistakes.

use trueflight::report::render as report;

use crate::render::{ball, found, mistakes, rendered};

/// Returns a ball of constant σ_t in each channel.
pub fn coloured() -> String {
    let channel = |extinction: f64| {
        let bounds = "bounds.sphere = { centre = [0, 0, 0], radius = 1 }";
        format!("{{ constant = {{ extinction = {extinction}, {bounds} }} }}")
    };
    let volume = [0.3, 0.8, 2.0].map(channel).join(", ");
    ball(32, 24.0)
        .lines()
        .take_while(|line| !line.contains("estimators"))
        .map(|line| {
            let is_field = line.contains("volume.constant");
            if is_field { format!("volume = [{volume}]\n") } else { format!("{line}\n") }
        })
        .collect::<String>()
        + "sampling = [{ constant.value = 0.5 }, { constant.value = 1 }, { constant.value = 2 }]
           estimators = [
             { independent = { collisions = \"delta\" } },
             { spectral-mis = { collisions = \"delta\" } },
             { spectral-mis = { collisions = \"ratio\" } },
             { spectral-tracking = { probabilities = \"average\", sampling.constant.value = 2 } },
             { common-ratio = { sampling.constant.value = 2 } },
           ]"
}

/// `T_λ = exp(−σ_λ c)` of a chord c, channel after channel. The mean of (image − truth)² is the variance of a draw over
/// the draws of a pixel: `E[X²] = 3 T` of independent tracking, `T² exp(∫σ²/σ̂)` of the common ratio tracker. Its
/// relative standard deviation is 4 %, from some 1,900 squares of nearly Gaussian errors.
#[test]
fn a_coloured_picture_has_the_right_colours_and_errors() {
    let record = rendered(&coloured(), 1);
    assert_eq!((record.channels, record.reference.image.len()), (3, 3 * 32 * 32));
    let pixel = &record.reference.image[3 * (16 * 32 + 16)..][..3];
    let chord = -pixel[0].ln() / 0.3;
    assert!(chord > 1.9 && chord < 2.0, "{chord}");
    for (value, extinction) in pixel.iter().zip([0.3, 0.8, 2.0]) {
        assert!((value / (-extinction * chord).exp() - 1.0).abs() < 1e-12);
    }
    let corner = &record.reference.image[..3];
    assert_eq!(corner, [1.0; 3], "the sky");
    let pixels = record.covered as f64;
    let independent = |truth: f64, _: f64| 3.0 * truth;
    let common = |truth: f64, extinction: f64| truth * truth * truth.powf(-extinction / 2.0);
    let squares: [&dyn Fn(f64, f64) -> f64; 2] = [&independent, &common];
    for (number, square) in [0, 4].into_iter().zip(squares) {
        let values = record.reference.image.iter().zip([0.3, 0.8, 2.0].into_iter().cycle());
        let covered = values.filter(|(truth, _)| **truth < 1.0);
        let variance: f64 = covered.map(|(t, sigma)| square(*t, sigma) - t * t).sum();
        let found = found(&record, number);
        let ratio = found.rmse.powi(2) * found.draws * 3.0 * pixels / variance;
        assert!((ratio - 1.0).abs() < 0.2, "estimator {number}: {ratio}");
    }
    for (number, exposure) in record.exposures.iter().enumerate() {
        let found = found(&record, number);
        let z = found.bias / (found.rmse / pixels.sqrt());
        assert!(z.abs() < 5.0, "{}: z = {z}", exposure.estimator);
    }
    // Many draws per pixel are made in packets, which score a luminance on request.
    let many = rendered(&coloured().replace("[32, 32]", "[8, 8]").replace("= 40", "= 400"), 1);
    assert!(many.exposures.iter().all(|exposure| exposure.outcome.is_ok()));
    let files = report::artifacts(&record).expect("files");
    assert!(files[1].bytes.starts_with(b"PF\n32 32\n"));
    assert_eq!(files[1].bytes.len(), 14 + 4 * 3 * 32 * 32);
}

#[test]
fn mistakes_in_coloured_pictures_have_their_place_and_cure() {
    let two = coloured().replacen("{ constant = { extinction = 0.3, ", "{ x = { y = 0.3, ", 1);
    assert!(mistakes(&two).contains("`x` is not known here"), "{}", mistakes(&two));
    let cut = coloured().find(", { constant = { extinction = 2").expect("blue");
    let end = coloured()[cut..].find("]\n").expect("the list's end") + cut;
    let two = format!("{}{}", &coloured()[..cut], &coloured()[end..]);
    let said = mistakes(&two);
    assert!(said.contains("`volume` lists 2 channels"), "{said}");
    assert!(said.contains("takes three: red, green and blue"), "{said}");
    let apart = coloured().replacen("radius = 1", "radius = 2", 1);
    assert!(mistakes(&apart).contains("do not fill the same part"), "{}", mistakes(&apart));
    let fewer = coloured().replace("{ constant.value = 0.5 }, ", "");
    let said = mistakes(&fewer);
    assert!(said.contains("`sampling` lists 2 channels, and the medium has 3"), "{said}");
}
