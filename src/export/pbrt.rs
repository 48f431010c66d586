//! Scenes of pbrt-v4.
//!
//! Grids are `uniformgrid` media, which are zero beyond the box: between the outermost samples and its faces σ_t falls
//! to half, and `truth.json` takes that into account. Lights have the colour (1, 1, 1). pbrt draws wavelengths for each
//! sample, so that only the mean of a sample is known, not its distribution. pbrt has no channels: where a case has
//! several, each is a grey scene of its own.
//!
//! Source: M. Pharr, W. Jakob, G. Humphreys, *Physically Based Rendering*, 4th edition (2023), and the description
//! of its scene format.

use std::fmt::Write;

use super::mitsuba::number;
use super::scene::{ChannelMedium, ExportedField, ExportedLight, ExportedScene, ExportedView};
use media::phase::Phase;
use numeric::geometry::{Aabb, Bounds, Point};

/// Number of scatterings of a path without a limit.
const DEEP: u32 = 1_000_000;

/// Returns the text of a scene file of a name: of the first channel.
pub fn text(scene: &ExportedScene, view: &ExportedView, file: &str) -> String {
    let ([_, up, onward], half) = (scene.axes(), number(scene.aperture()));
    let mut text = format!(
        "LookAt {} {} {}\n\
         Camera \"orthographic\" \"float screenwindow\" [ -{half} {half} -{half} {half} ]\n\
         Film \"rgb\" \"string filename\" [ \"{}.exr\" ] \"integer xresolution\" [ 1024 ] \"integer yresolution\" \
         [ 1024 ] \"bool savefp16\" [ false ]\n\
         PixelFilter \"box\" \"float xradius\" [ 0.5 ] \"float yradius\" [ 0.5 ]\n\
         Sampler \"independent\" \"integer pixelsamples\" [ 1 ] \"integer seed\" [ 1 ]\n\
         Integrator \"volpath\" \"integer maxdepth\" [ {} ]\n",
        triple(scene.eye),
        triple(scene.eye + onward),
        triple(up),
        file.trim_end_matches(".pbrt"),
        scene.scatterings.unwrap_or(DEEP),
    );
    if scene.is_inside {
        // The camera is in the medium that is named before it.
        let first = format!("{}MediumInterface \"\" \"medium\"\n", medium(scene));
        text = text.replacen("Camera ", &(first + "Camera "), 1);
    }
    text.push_str("WorldBegin\n");
    if !scene.is_inside {
        text.push_str(&medium(scene));
    }
    light(scene, view.light, &mut text);
    text.push_str("AttributeBegin\nMaterial \"interface\"\nMediumInterface \"medium\" \"\"\n");
    match scene.shape {
        Bounds::Sphere { centre, radius } => text.push_str(&ball(centre, radius)),
        Bounds::Box(_) | Bounds::Everywhere => text.push_str(&cuboid(scene.bounds())),
    }
    text + "AttributeEnd\n"
}

fn triple(point: Point) -> String {
    point.0.map(number).join(" ")
}

/// Returns a constant spectrum.
fn even(name: &str, x: f64) -> String {
    format!("\"spectrum {name}\" [ 200 {0} 900 {0} ]", number(x))
}

fn medium(scene: &ExportedScene) -> String {
    let lobe = match scene.phase {
        Phase::HenyeyGreenstein(lobe) => lobe.g(),
        _ => 0.0,
    };
    let mut text = "MakeNamedMedium \"medium\" ".to_owned();
    let ChannelMedium { field, albedo: a } = &scene.channels[0];
    let [absorbs, scatters] = match field {
        ExportedField::Grid(grid) => {
            let [nx, ny, nz] = grid.size;
            let Aabb { low, high } = grid.bounds;
            let values: Vec<String> = grid.values.iter().map(|&x| number(f64::from(x))).collect();
            let _ = write!(
                text,
                "\"string type\" \"uniformgrid\" \"integer nx\" [ {nx} ] \"integer ny\" [ {ny} ] \"integer nz\" \
                 [ {nz} ]\n  \"point3 p0\" [ {} ] \"point3 p1\" [ {} ]\n  \"float density\" [ {} ]\n  ",
                triple(low),
                triple(high),
                values.join(" "),
            );
            [1.0 - a, *a]
        }
        ExportedField::Even(extinction) => {
            text.push_str("\"string type\" \"homogeneous\"\n  ");
            [(1.0 - a) * extinction, a * extinction]
        }
    };
    let (absorbs, scatters) = (even("sigma_a", absorbs), even("sigma_s", scatters));
    let _ = writeln!(text, "{absorbs} {scatters} \"float g\" [ {} ]", number(lobe));
    text
}

fn cuboid(Aabb { low, high }: Aabb) -> String {
    let corner = |n: usize| Point(std::array::from_fn(|axis| [low, high][n >> axis & 1].0[axis]));
    let corners: Vec<String> = (0..8).map(corner).map(triple).collect();
    format!(
        "Shape \"trianglemesh\" \"point3 P\" [ {} ]\n  \"integer indices\" [ 0 2 3 0 3 1  4 5 7 4 7 6  0 1 5 0 5 4  \
         2 6 7 2 7 3  0 4 6 0 6 2  1 3 7 1 7 5 ]\n",
        corners.join("  ")
    )
}

fn ball(centre: Point, radius: f64) -> String {
    format!(
        "Translate {}\nShape \"sphere\" \"float radius\" [ {} ]\n",
        triple(centre),
        number(radius)
    )
}

fn light(scene: &ExportedScene, light: ExportedLight, text: &mut String) {
    let lines = match light {
        ExportedLight::Everywhere => "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n".to_owned(),
        ExportedLight::Point { position, power } => {
            let medium = if scene.shape.contains(position.0) {
                "MediumInterface \"\" \"medium\"\n"
            } else {
                ""
            };
            format!(
                "AttributeBegin\n{medium}LightSource \"point\" \"rgb I\" [ 1 1 1 ] \"float scale\" [ {} ] \"point3 from\" \
                 [ {} ]\nAttributeEnd\n",
                number(power / (4.0 * std::f64::consts::PI)),
                triple(position),
            )
        }
        ExportedLight::Core { radius } => {
            let Bounds::Sphere { centre, .. } = scene.shape else { return };
            format!(
                "AttributeBegin\nMediumInterface \"\" \"medium\"\nMaterial \"diffuse\" {}\n\
                 AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n{}AttributeEnd\n",
                even("reflectance", 0.0),
                ball(centre, radius)
            )
        }
        // Slabs need mirrors, which pbrt does not have: they are refused.
        ExportedLight::Above | ExportedLight::Below => return,
    };
    text.push_str(&lines);
}
