//! Scenes of Mitsuba 3, in XML.
//!
//! All rays of the one orthographic camera are equal, with a box filter and one sample per pixel: every pixel is one
//! sample. `-D integrator=volpathmis`, `-D sampling=false`, `-D width=…`, `-D height=…` and `-D seed=…` set these
//! values. Fields are `gridvolume`s placed by `to_world`, since corners in `.vol` files may belong to something else.
//! Roulette is off, for it would change the distribution of a sample. Channels are red, green and blue of the variants
//! `…_rgb`, which take them as they are: `raw` keeps grids of three channels from being converted to spectra.
//!
//! Source: W. Jakob et al., *Mitsuba 3 renderer* (2022), its plugin reference.

use std::fmt::Write;

use super::fields::FILE as GRID;
use super::scene::{ExportedLight, ExportedScene, ExportedView};
use media::phase::Phase;
use numeric::geometry::{Aabb, Bounds, Point};

/// Returns a number of single precision with all of its digits.
#[allow(clippy::cast_possible_truncation)] // it is of single precision
pub(super) fn number(x: f64) -> String {
    format!("{:?}", x as f32)
}

/// Returns the text of a scene file.
pub fn text(scene: &ExportedScene, view: &ExportedView) -> String {
    let depth = scene.scatterings.map_or(-1, |maximum| i64::from(maximum) + 1);
    let mut text = format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
  <default name="integrator" value="volpath"/>
  <default name="sampling" value="true"/>
  <default name="width" value="1024"/>
  <default name="height" value="1024"/>
  <default name="seed" value="1"/>
  <integrator type="$integrator">
    <integer name="max_depth" value="{depth}"/>
    <integer name="rr_depth" value="1000000"/>
  </integrator>
  <medium id="medium" type="{}">
    <boolean name="sample_emitters" value="$sampling"/>
"#,
        if scene.is_homogeneous() { "homogeneous" } else { "heterogeneous" },
    );
    medium(scene, &mut text);
    camera(scene, &mut text);
    boundary(scene, &mut text);
    light(scene, view.light, &mut text);
    text + "</scene>\n"
}

/// Writes the content of the medium's element.
fn medium(scene: &ExportedScene, text: &mut String) {
    if let Some(grid) = scene.grids().first() {
        let Aabb { low, high } = grid.bounds;
        let filter = if grid.nearest { "nearest" } else { "trilinear" };
        let _ = write!(
            text,
            r#"    <volume name="sigma_t" type="gridvolume">
      <string name="filename" value="{GRID}"/>
      <string name="filter_type" value="{filter}"/>
      <string name="wrap_mode" value="clamp"/>
      <boolean name="raw" value="true"/>
      <transform name="to_world">
        {}
        {}
      </transform>
    </volume>
"#,
            vector("scale", high - low),
            vector("translate", low),
        );
    } else {
        let mut extinctions: Vec<f64> =
            scene.channels.iter().map(|channel| channel.field.peak()).collect();
        // Up to version 3.4 Mitsuba refuses constant volumes outside [0, 1].
        let scale = scene.peak();
        if scale > 1.0 {
            for extinction in &mut extinctions {
                *extinction /= scale;
            }
            let _ = writeln!(text, "    <float name=\"scale\" value=\"{}\"/>", number(scale));
        }
        let _ = writeln!(text, "    {}", value("sigma_t", &extinctions));
    }
    let _ = writeln!(text, "    {}", value("albedo", &scene.albedos()));
    let phase = match scene.phase {
        Phase::Isotropic(_) => "<phase type=\"isotropic\"/>".to_owned(),
        Phase::Rayleigh(_) => "<phase type=\"rayleigh\"/>".to_owned(),
        Phase::HenyeyGreenstein(lobe) => {
            format!("<phase type=\"hg\"><float name=\"g\" value=\"{}\"/></phase>", number(lobe.g()))
        }
    };
    let _ = writeln!(text, "    {phase}\n  </medium>");
}

/// Returns a constant colour; the last channel also stands for missing ones.
fn value(name: &str, channels: &[f64]) -> String {
    let colour =
        [0, 1, 2].map(|n| channels.get(n).or(channels.last()).copied().unwrap_or_default());
    let colour = colour.map(number).join(" ");
    format!(
        "<volume name=\"{name}\" type=\"constvolume\"><rgb name=\"value\" value=\"{colour}\"/></volume>"
    )
}

fn vector(what: &str, point: Point) -> String {
    let [x, y, z] = point.0.map(number);
    format!("<{what} x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")
}

/// Writes the camera; all of its rays are equal.
fn camera(scene: &ExportedScene, text: &mut String) {
    let [right, up, onward] = scene.axes();
    let Aabb { low, high } = scene.bounds();
    let size = (high - low).norm() + (scene.eye - low).norm();
    let columns = [right * scene.aperture(), up * scene.aperture(), onward, scene.eye];
    let rows = [0, 1, 2].map(|row| columns.map(|column| number(column.0[row])).join(" "));
    let within = if scene.is_inside { "\n    <ref name=\"medium\" id=\"medium\"/>" } else { "" };
    let _ = write!(
        text,
        r#"  <sensor type="orthographic">
    <transform name="to_world">
      <matrix value="{} 0 0 0 1"/>
    </transform>
    <float name="near_clip" value="{}"/>
    <float name="far_clip" value="{}"/>
    <film type="hdrfilm">
      <integer name="width" value="$width"/>
      <integer name="height" value="$height"/>
      <string name="pixel_format" value="rgb"/>
      <string name="component_format" value="float32"/>
      <rfilter type="box"/>
    </film>
    <sampler type="independent">
      <integer name="sample_count" value="1"/>
      <integer name="seed" value="$seed"/>
    </sampler>{within}
  </sensor>
"#,
        rows.join(" "),
        number(1e-7 * size),
        number(100.0 * size),
    );
}

/// Writes the surface of the medium, and the mirrors within.
fn boundary(scene: &ExportedScene, text: &mut String) {
    let null =
        "    <bsdf type=\"null\"/>\n    <ref name=\"interior\" id=\"medium\"/>\n  </shape>\n";
    let Aabb { low, high } = scene.bounds();
    match scene.shape {
        Bounds::Sphere { centre, radius } => {
            let _ = write!(text, "{}{null}", ball(centre, radius));
        }
        Bounds::Box(_) | Bounds::Everywhere => {
            let (half, middle) = ((high - low) * 0.5, (high + low) * 0.5);
            let _ = write!(
                text,
                "  <shape type=\"cube\">\n    <transform name=\"to_world\">\n      {}\n      {}\n    \
                 </transform>\n{null}",
                vector("scale", half),
                vector("translate", middle),
            );
        }
    }
    if !scene.has_mirrors {
        return;
    }
    let mirror = "    <bsdf type=\"conductor\"><string name=\"material\" value=\"none\"/></bsdf>\n  </shape>\n";
    let length = high.0[2];
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        // Columns of a rectangle in x and y with its normal, z, towards the centre.
        let mut columns = [Point([0.0; 3]); 4];
        columns[0].0[1 - axis] = length;
        columns[2].0[axis] = -sign;
        columns[1].0[2] = length;
        columns[3] = Point([0.0, 0.0, 0.5 * length]);
        columns[3].0[axis] = 0.5 * length * sign;
        if columns[0].cross(columns[1]).dot(columns[2]) < 0.0 {
            columns[0] = columns[0] * -1.0;
        }
        let _ = write!(text, "{}{mirror}", rectangle(columns));
    }
}

/// Returns a rectangle by the columns of its matrix: half of its sides, its normal, its centre.
fn rectangle(columns: [Point; 4]) -> String {
    let rows = [0, 1, 2].map(|row| columns.map(|column| number(column.0[row])).join(" "));
    format!(
        "  <shape type=\"rectangle\">\n    <transform name=\"to_world\">\n      <matrix value=\"{} 0 0 0 1\"/>\n    \
         </transform>\n",
        rows.join(" ")
    )
}

/// Returns the beginning of a sphere's element.
fn ball(centre: Point, radius: f64) -> String {
    let [x, y, z] = centre.0.map(number);
    format!(
        "  <shape type=\"sphere\">\n    <point name=\"center\" x=\"{x}\" y=\"{y}\" z=\"{z}\"/>\n    \
         <float name=\"radius\" value=\"{}\"/>\n",
        number(radius)
    )
}

fn light(scene: &ExportedScene, light: ExportedLight, text: &mut String) {
    let black = "    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0 0 0\"/></bsdf>\n";
    let area = "    <emitter type=\"area\"><rgb name=\"radiance\" value=\"1 1 1\"/></emitter>\n  </shape>\n";
    let plane = |height: f64, onward: f64| {
        // A thousandth wider than the mirrors are apart.
        let half = 0.5005 * scene.bounds().high.0[2];
        let sides = [Point([half, 0.0, 0.0]), Point([0.0, half * onward, 0.0])];
        let [normal, middle] = [onward, height].map(|z| Point([0.0, 0.0, z]));
        format!("{}{black}{area}", rectangle([sides[0], sides[1], normal, middle]))
    };
    let length = scene.bounds().high.0[2];
    let lines = match light {
        ExportedLight::Everywhere => {
            "  <emitter type=\"constant\"><rgb name=\"radiance\" value=\"1 1 1\"/></emitter>\n"
                .to_owned()
        }
        ExportedLight::Above => plane(-0.25 * length, 1.0),
        ExportedLight::Below => plane(1.25 * length, -1.0),
        ExportedLight::Point { position, power } => {
            let [x, y, z] = position.0.map(number);
            let intensity = number(power / (4.0 * std::f64::consts::PI));
            format!(
                "  <emitter type=\"point\">\n    <point name=\"position\" x=\"{x}\" y=\"{y}\" z=\"{z}\"/>\n    \
                 <rgb name=\"intensity\" value=\"{intensity} {intensity} {intensity}\"/>\n  </emitter>\n"
            )
        }
        ExportedLight::Core { radius } => {
            let Bounds::Sphere { centre, .. } = scene.shape else { return };
            // Light that hits it stays in the medium: it is no boundary.
            format!("{}{black}{area}", ball(centre, radius))
        }
    };
    text.push_str(&lines);
}
