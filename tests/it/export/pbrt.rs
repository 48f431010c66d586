//! Scenes of pbrt-v4 by a parser: syntax, directives, and parameters against the documented names and types.
//!
//! These tests do not run pbrt.

use trueflight::export::Target;

use super::{CASES, scene};

/// Token of the scene format.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Word(String),
    Quoted(String),
    Number(f64),
    Open,
    Close,
}

fn tokens(text: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = match first {
            c if c.is_whitespace() => c.len_utf8(),
            '#' => rest.find('\n').unwrap_or(rest.len()),
            '"' => {
                let end = rest[1..].find('"').expect("a quote is closed") + 1;
                found.push(Token::Quoted(rest[1..end].into()));
                end + 1
            }
            '[' | ']' => {
                found.push(if first == '[' { Token::Open } else { Token::Close });
                1
            }
            _ => {
                let ends = |c: char| c.is_whitespace() || "[]\"#".contains(c);
                let end = rest.find(ends).unwrap_or(rest.len());
                let word = &rest[..end];
                found.push(match word.parse() {
                    Ok(number) => Token::Number(number),
                    Err(_) => Token::Word(word.into()),
                });
                end
            }
        };
        rest = &rest[length..];
    }
    found
}

/// Directive: its name, the texts and numbers that follow, and its parameters.
#[derive(Debug)]
struct Directive {
    name: String,
    texts: Vec<String>,
    numbers: Vec<f64>,
    parameters: Vec<(String, Vec<Token>)>,
}

fn directives(text: &str) -> Vec<Directive> {
    let tokens = tokens(text);
    let mut found: Vec<Directive> = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at] {
            Token::Word(word) if !["true", "false"].contains(&word.as_str()) => {
                let (texts, numbers, parameters) = Default::default();
                found.push(Directive { name: word.clone(), texts, numbers, parameters });
            }
            Token::Quoted(text) => {
                let directive = found.last_mut().expect("a directive comes first");
                if tokens.get(at + 1) == Some(&Token::Open) {
                    let end =
                        tokens[at..].iter().position(|t| *t == Token::Close).expect("a list ends");
                    let values = tokens[at + 2..at + end].to_vec();
                    assert!(!values.contains(&Token::Open), "lists are not nested");
                    directive.parameters.push((text.clone(), values));
                    at += end;
                } else if text.contains(' ') {
                    directive.parameters.push((text.clone(), vec![tokens[at + 1].clone()]));
                    at += 1;
                } else {
                    directive.texts.push(text.clone());
                }
            }
            Token::Number(number) => found.last_mut().expect("a directive").numbers.push(*number),
            other => panic!("{other:?} stands alone"),
        }
        at += 1;
    }
    found
}

/// Documented parameters: directive and kind, then type and name; for media the kind is a parameter.
const DOCUMENTED: &[(&str, &str, &[&str])] = &[
    ("Camera", "orthographic", &["float screenwindow"]),
    (
        "Film",
        "rgb",
        &["string filename", "integer xresolution", "integer yresolution", "bool savefp16"],
    ),
    ("PixelFilter", "box", &["float xradius", "float yradius"]),
    ("Sampler", "independent", &["integer pixelsamples", "integer seed"]),
    ("Integrator", "volpath", &["integer maxdepth"]),
    (
        "MakeNamedMedium",
        "uniformgrid",
        &[
            "string type",
            "integer nx",
            "integer ny",
            "integer nz",
            "point3 p0",
            "point3 p1",
            "float density",
            "spectrum sigma_a",
            "spectrum sigma_s",
            "float g",
        ],
    ),
    (
        "MakeNamedMedium",
        "homogeneous",
        &["string type", "spectrum sigma_a", "spectrum sigma_s", "float g"],
    ),
    ("LightSource", "infinite", &["rgb L"]),
    ("LightSource", "point", &["rgb I", "float scale", "point3 from"]),
    ("AreaLightSource", "diffuse", &["rgb L"]),
    ("Material", "interface", &[]),
    ("Material", "diffuse", &["spectrum reflectance"]),
    ("Shape", "trianglemesh", &["point3 P", "integer indices"]),
    ("Shape", "sphere", &["float radius"]),
];

/// Lists the mistakes in a scene.
fn mistakes(text: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    let (mut open, mut worlds, mut media) = (0, 0, Vec::new());
    for directive in directives(text) {
        let Directive { name, texts, numbers, parameters } = &directive;
        let numbers_wanted = match name.as_str() {
            "LookAt" => 9,
            "Translate" => 3,
            _ => 0,
        };
        if numbers.len() != numbers_wanted {
            wrong.push(format!("{name} has {} numbers", numbers.len()));
        }
        match name.as_str() {
            "LookAt" | "Translate" => {}
            "WorldBegin" => worlds += 1,
            "AttributeBegin" => open += 1,
            "AttributeEnd" => open -= 1,
            "MediumInterface" => {
                let known = |text: &String| text.is_empty() || media.contains(text);
                if texts.len() != 2 || !texts.iter().all(known) {
                    wrong.push(format!("MediumInterface {texts:?}"));
                }
            }
            _ => {
                let typed = |key: &str| parameters.iter().find(|(name, _)| name == key);
                let kind = match typed("string type").map(|(_, values)| values.as_slice()) {
                    Some([Token::Quoted(kind)]) => kind.clone(),
                    _ => texts.first().cloned().unwrap_or_default(),
                };
                if name == "MakeNamedMedium" {
                    media.extend(texts.first().cloned());
                }
                let known = DOCUMENTED.iter().find(|(of, named, _)| of == name && *named == kind);
                let Some((_, _, allowed)) = known else {
                    wrong.push(format!("{name} \"{kind}\" is not documented"));
                    continue;
                };
                for (parameter, values) in parameters {
                    if !allowed.contains(&parameter.as_str()) {
                        wrong.push(format!("{name} \"{kind}\" has no \"{parameter}\""));
                    }
                    wrong.extend(bad_values(parameter, values));
                }
                wrong.extend(bad_counts(parameters));
            }
        }
    }
    if (open, worlds) != (0, 1) {
        wrong.push(format!("{open} attributes are open, {worlds} worlds begin"));
    }
    wrong
}

/// Returns the values that are not of the type of their parameter.
fn bad_values(parameter: &str, values: &[Token]) -> Option<String> {
    let kind = parameter.split(' ').next().unwrap_or_default();
    let is_number = |token: &Token| matches!(token, Token::Number(x) if x.is_finite());
    let is_whole = |token: &Token| matches!(token, Token::Number(x) if x.fract() == 0.0);
    let all = |of: &dyn Fn(&Token) -> bool| !values.is_empty() && values.iter().all(of);
    let fits = match kind {
        "float" => all(&is_number),
        "integer" => all(&is_whole),
        "point3" | "rgb" => all(&is_number) && values.len().is_multiple_of(3),
        // Wavelengths and values alternate.
        "spectrum" => all(&is_number) && values.len() == 4,
        "string" => matches!(values, [Token::Quoted(_)]),
        "bool" => matches!(values, [Token::Word(_)]),
        _ => false,
    };
    (!fits).then(|| format!("\"{parameter}\" has {} values {:?}", values.len(), values.first()))
}

/// Returns the lists with incompatible lengths.
fn bad_counts(parameters: &[(String, Vec<Token>)]) -> Option<String> {
    let values = |key: &str| parameters.iter().find(|(name, _)| name == key).map(|(_, v)| v);
    let whole = |key: &str| match values(key)?.as_slice() {
        [Token::Number(x)] => Some(*x),
        _ => None,
    };
    if let Some(density) = values("float density") {
        let size = whole("integer nx")? * whole("integer ny")? * whole("integer nz")?;
        return (density.len() as f64 != size)
            .then(|| format!("{} of {size} samples", density.len()));
    }
    let (points, indices) = (values("point3 P")?, values("integer indices")?);
    let most = points.len() as f64 / 3.0 - 1.0;
    let fits = |t: &Token| matches!(t, Token::Number(n) if (0.0..=most).contains(n));
    let right = indices.len().is_multiple_of(3) && indices.iter().all(fits);
    (!right).then(|| "the triangles have no such points".to_owned())
}

#[test]
fn every_scene_is_in_the_documented_format() {
    let mut read = 0;
    let coloured = ["transmittance/spectral-layers", "furnace/spectral-like-colours"];
    for case in CASES.iter().chain(&coloured).filter(|case| !case.starts_with("slab")) {
        // pbrt does not have Rayleigh scattering.
        if *case == "furnace/known-bugs" {
            continue;
        }
        let scene = scene(case, Target::Pbrt, Some(16)).unwrap_or_else(|e| panic!("{case}: {e}"));
        for question in &scene.exported.truth.questions {
            let found = mistakes(&scene.text(&question.scene));
            assert!(found.is_empty(), "{case}: {found:?}");
            assert!(question.with_emitter_sampling.is_none(), "samples of pbrt have wavelengths");
            read += 1;
        }
    }
    assert!(read >= 12, "{read} scenes");
}

#[test]
fn the_parser_finds_mistakes() {
    let scene = scene("transmittance/eq21-overview", Target::Pbrt, Some(16)).expect("exported");
    let good = scene.text("transmittance.pbrt");
    assert!(mistakes(&good).is_empty());
    let bad = [
        ("\"integer nz\" [ 16 ]", "\"integer nz\" [ 17 ]", "samples"),
        ("\"float density\"", "\"float densities\"", "no \"float densities\""),
        ("uniformgrid", "grid", "not documented"),
        ("WorldBegin", "", "worlds"),
        ("AttributeEnd", "", "open"),
        ("\"medium\" \"\"", "\"smoke\" \"\"", "MediumInterface"),
        ("1 7 5 ]", "1 7 8 ]", "points"),
        ("\"rgb L\" [ 1 1 1 ]", "\"rgb L\" [ 1 1 ]", "values"),
        ("\"integer maxdepth\" [ 1000000 ]", "\"integer maxdepth\" [ 1.5 ]", "values"),
    ];
    for (from, to, words) in bad {
        assert!(good.contains(from), "{from} is not in the scene");
        let found = mistakes(&good.replacen(from, to, 1));
        assert!(found.iter().any(|mistake| mistake.contains(words)), "{from}: {found:?}");
    }
}
