//! The floor plan: a module uses only floors below its own.
//!
//! The sources are read as text: every path that begins with `crate::`, with `trueflight::` in the
//! binary, or with enough `super::`, is an edge from the file's top-level module to another.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

/// Every top-level module with its floor. `cli` and `main` are the binary.
const FLOORS: &[(&str, u8)] = &[
    ("numeric", 0),
    ("files", 0),
    ("geometry", 0),
    ("rng", 0),
    ("catalogue", 0),
    ("media", 1),
    ("phase", 1),
    ("stats", 1),
    ("problems", 2),
    ("theory", 3),
    ("recipes", 4),
    ("setup", 4),
    ("kernels", 4),
    ("estimators", 4),
    ("mutants", 4),
    ("harness", 5),
    ("baseline", 6),
    ("judge", 6),
    ("bench", 6),
    ("stress", 6),
    ("self_test", 6),
    ("render", 6),
    ("report", 7),
    ("cli", 8),
    ("main", 8),
];

/// The edges that are allowed on one floor: everything counts, recipes make what estimators work on, the setup holds it, kernels draw by it,
/// mutants are twins of estimators, what judges foreign draws is tested by itself, a bench is stored as a run is, and
/// `main` is nothing but the door to `cli`.
const SIDEWAYS: &[(&str, &str)] = &[
    ("geometry", "numeric"),
    ("rng", "numeric"),
    ("mutants", "estimators"),
    ("setup", "recipes"),
    ("estimators", "recipes"),
    ("kernels", "setup"),
    ("estimators", "setup"),
    ("estimators", "kernels"),
    ("mutants", "recipes"),
    ("mutants", "setup"),
    ("mutants", "kernels"),
    ("main", "cli"),
    ("self_test", "judge"),
    ("bench", "baseline"),
];

/// Edges that go down and are forbidden all the same: theory and media hold no generator,
/// estimators no tolerance, and a report sees only the record.
const FORBIDDEN: &[(&str, &str)] = &[
    ("media", "rng"),
    ("phase", "rng"),
    ("problems", "rng"),
    ("theory", "rng"),
    ("theory", "stats"),
    ("kernels", "stats"),
    ("estimators", "stats"),
    ("report", "numeric"),
    ("report", "geometry"),
    ("report", "rng"),
    ("report", "media"),
    ("report", "phase"),
    ("report", "stats"),
    ("report", "problems"),
    ("report", "theory"),
    ("report", "kernels"),
    ("report", "estimators"),
];

/// A file of more lines is two files.
const LONGEST: usize = 400;

struct File {
    /// The path below `src`.
    path: PathBuf,
    text: String,
}

impl File {
    fn all() -> Vec<Self> {
        let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut files = Vec::new();
        let mut folders = vec![src.clone()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = std::fs::read_to_string(&path).expect("a text");
                    let path = path.strip_prefix(&src).expect("below src").to_owned();
                    files.push(Self { path, text });
                }
            }
        }
        files.sort_by(|a, b| a.path.cmp(&b.path));
        assert!(files.len() > 50, "the sources were not found");
        files
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The top-level module.
    fn module(&self) -> String {
        let first = self.path.components().next().expect("a component").as_os_str();
        first.to_string_lossy().trim_end_matches(".rs").to_owned()
    }

    /// How many `super` lead from the file's module to the crate's root.
    fn depth(&self) -> usize {
        let names = self.path.components().count();
        if self.path.ends_with("mod.rs") { names - 1 } else { names }
    }
}

/// Identifiers, `::` and single marks; comments and texts in quotes are left out.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '/' if chars.peek() == Some(&'/') => {
                chars.by_ref().take_while(|&c| c != '\n').for_each(drop);
            }
            '"' => {
                while let Some(c) = chars.next() {
                    match c {
                        '\\' => drop(chars.next()),
                        '"' => break,
                        _ => {}
                    }
                }
            }
            ':' if chars.peek() == Some(&':') => {
                chars.next();
                tokens.push("::".into());
            }
            c if c.is_alphanumeric() || c == '_' => {
                let mut word = String::from(c);
                while let Some(&c) = chars.peek().filter(|c| c.is_alphanumeric() || **c == '_') {
                    word.push(c);
                    chars.next();
                }
                tokens.push(word);
            }
            c if c.is_whitespace() => {}
            c => tokens.push(c.into()),
        }
    }
    tokens
}

/// The first names of a path's continuation: one, or those between braces. Macros are no modules.
fn heads(tokens: &[String]) -> Vec<String> {
    if tokens.first().is_some_and(|token| token == "{") {
        let mut depth = 0;
        let mut heads = Vec::new();
        for (i, token) in tokens.iter().enumerate() {
            match token.as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                break;
            }
            if depth == 1 && (token == "{" || token == ",") {
                heads.extend(tokens.get(i + 1).filter(|next| *next != "}").cloned());
            }
        }
        return heads;
    }
    let is_macro = tokens.get(1).is_some_and(|token| token == "!");
    tokens.first().filter(|_| !is_macro).cloned().into_iter().collect()
}

/// The top-level modules that a file names.
fn used(file: &File) -> BTreeSet<String> {
    let tokens = tokens(&file.text);
    let is = |i: usize, word: &str| tokens.get(i).is_some_and(|token| token == word);
    let mut used = BTreeSet::new();
    let mut i = 0;
    while i < tokens.len() {
        let follows = !(i > 0 && is(i - 1, "::"));
        let from_root = is(i, "crate") || is(i, "trueflight");
        if follows && from_root && is(i + 1, "::") {
            used.extend(heads(&tokens[i + 2..]));
        }
        let mut supers = 0;
        while is(i + 2 * supers, "super") && is(i + 2 * supers + 1, "::") {
            supers += 1;
        }
        if supers > 0 && supers == file.depth() {
            used.extend(heads(&tokens[i + 2 * supers..]));
        }
        i += 1 + 2 * supers;
    }
    used
}

/// The part of a file before its unit tests.
fn product(file: &File) -> File {
    let end = file.text.find("#[cfg(test)]").unwrap_or(file.text.len());
    File { path: file.path.clone(), text: file.text[..end].to_owned() }
}

fn floor(module: &str) -> Option<u8> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|&(_, floor)| floor)
}

#[test]
fn every_top_level_module_has_a_floor() {
    for file in File::all() {
        let module = file.module();
        assert!(module == "lib" || floor(&module).is_some(), "{module} has no floor");
    }
}

#[test]
fn no_module_uses_its_own_floor_or_a_higher_one() {
    let mut wrong = Vec::new();
    for file in File::all().iter().filter(|file| file.module() != "lib").map(product) {
        let module = file.module();
        let own = floor(&module).expect("a floor");
        for other in used(&file).into_iter().filter(|other| *other != module) {
            // Names that are no module of the crate: items re-exported at its root.
            let Some(theirs) = floor(&other) else { continue };
            let edge = (module.as_str(), other.as_str());
            if FORBIDDEN.contains(&edge) || (theirs >= own && !SIDEWAYS.contains(&edge)) {
                wrong.push(format!("{}: {module} ({own}) → {other} ({theirs})", file.name()));
            }
        }
    }
    assert!(wrong.is_empty(), "edges that go up, sideways or astray:\n{}", wrong.join("\n"));
}

#[test]
fn the_reader_of_edges_sees_every_way_to_write_one() {
    let file = |text: &str| File { path: "theory/a.rs".into(), text: text.into() };
    let modules = |text: &str| used(&file(text)).into_iter().collect::<Vec<_>>().join(" ");
    assert_eq!(modules("use crate::media::Medium;"), "media");
    assert_eq!(
        modules("use crate::{media::{self, Body}, rng, stats::{Tally}};"),
        "media rng stats"
    );
    assert_eq!(modules("fn f() { crate::harness::run::draw() }"), "harness");
    assert_eq!(modules("$crate::rng::Stream"), "rng");
    assert_eq!(modules("use super::super::report;"), "report");
    assert_eq!(modules("use super::mesh; // crate::media"), "");
    assert_eq!(modules("\"crate::media\"; crate::page!(mesh)"), "");
}

#[test]
fn no_file_is_long() {
    let lines = |file: &File| file.text.lines().count();
    let files = File::all();
    let long: Vec<String> = files
        .iter()
        .filter(|file| lines(file) > LONGEST)
        .map(|file| format!("{}: {} lines", file.name(), lines(file)))
        .collect();
    assert!(long.is_empty(), "files above {LONGEST} lines:\n{}", long.join("\n"));
}

#[test]
fn most_files_are_a_page_and_no_room_is_the_house() {
    let mut lines = Vec::new();
    let mut rooms = BTreeMap::<String, usize>::new();
    for file in File::all() {
        let count = file.text.lines().count();
        lines.push(count);
        *rooms.entry(file.module()).or_default() += count;
    }
    lines.sort_unstable();
    let (median, all) = (lines[lines.len() / 2], lines.iter().sum::<usize>());
    assert!(median <= 150, "half of the files have more than {median} lines");
    for (room, lines) in rooms {
        assert!(5 * lines <= all, "{room} has {lines} of {all} lines");
    }
}

/// The files of the harness in the order in which they may import each other, from its prose.
fn order_in_the_harness(prose: &str) -> Vec<&str> {
    let list = prose.split("//! ```").nth(1).expect("a list");
    // The first word of a line says what its files are about.
    list.lines().skip(1).flat_map(|line| line.split_whitespace().skip(2)).collect()
}

#[test]
fn files_of_the_harness_import_only_those_before_them() {
    let files = File::all();
    let files = || files.iter().filter(|file| file.module() == "harness");
    let prose = files().find(|file| file.path.ends_with("harness/mod.rs")).expect("its prose");
    let order = order_in_the_harness(&prose.text);
    let place = |name: &str| order.iter().position(|listed| *listed == name);
    let (mut wrong, mut edges) = (Vec::new(), 0);
    for file in files().filter(|file| file.path != prose.path).map(product) {
        let part = file.path.components().nth(1).expect("a file").as_os_str().to_string_lossy();
        let own = part.trim_end_matches(".rs");
        let Some(own_place) = place(own) else {
            wrong.push(format!("{own} is not listed"));
            continue;
        };
        let tokens = tokens(&file.text);
        let inside = file.depth() - 1;
        for i in 0..tokens.len() {
            let follows = i > 0 && tokens[i - 1] == "::";
            let up = (0..inside).all(|n| {
                let at = i + 2 * n;
                tokens.get(at).is_some_and(|t| t == "super")
                    && tokens.get(at + 1).is_some_and(|t| t == "::")
            });
            let by_root =
                tokens[i..].starts_with(&["crate", "::", "harness", "::"].map(String::from));
            let from = if by_root { i + 4 } else { i + 2 * inside };
            if follows || !(by_root || up && inside > 0) {
                continue;
            }
            for other in heads(&tokens[from..]).iter().filter(|other| *other != own) {
                let Some(theirs) = place(other) else { continue };
                edges += 1;
                if theirs >= own_place {
                    wrong.push(format!("{} → {other}", file.name()));
                }
            }
        }
    }
    assert!(edges > 50, "{edges} edges were found");
    assert!(wrong.is_empty(), "imports that go back:\n{}", wrong.join("\n"));
}

/// The platform's functions, whose last bits differ from one to the next. `sqrt`, `abs` and the
/// like are exact everywhere.
const INEXACT: &[&str] = &[
    "ln", "ln_1p", "log", "log2", "log10", "exp", "exp2", "exp_m1", "sin", "cos", "tan", "sin_cos",
    "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "powf", "powi", "cbrt", "hypot",
    "mul_add",
];

/// Collects calls of [`INEXACT`] methods, and of anything in `libm`, in what is drawn.
#[derive(Default)]
struct Calls {
    /// Whether the functions visited now run in a draw.
    drawing: bool,
    found: Vec<String>,
}

impl Calls {
    fn within(&mut self, name: &str, visit: impl FnOnce(&mut Self)) {
        let outside = self.drawing;
        self.drawing |= ["draw", "walk", "fly", "outcome", "product"].contains(&name);
        visit(self);
        self.drawing = outside;
    }
}

impl Visit<'_> for Calls {
    fn visit_item_mod(&mut self, item: &syn::ItemMod) {
        if item.ident != "tests" {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &syn::ItemFn) {
        self.within(&item.sig.ident.to_string(), |calls| visit::visit_item_fn(calls, item));
    }

    fn visit_impl_item_fn(&mut self, item: &syn::ImplItemFn) {
        self.within(&item.sig.ident.to_string(), |calls| visit::visit_impl_item_fn(calls, item));
    }

    fn visit_expr_method_call(&mut self, call: &syn::ExprMethodCall) {
        let name = call.method.to_string();
        if self.drawing && INEXACT.contains(&name.as_str()) {
            self.found.push(format!(".{name}()"));
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let foreign = matches!(names.first().map(String::as_str), Some("libm" | "f64" | "f32"));
        let inexact = names.last().is_some_and(|name| INEXACT.contains(&name.as_str()));
        if self.drawing && foreign && inexact {
            self.found.push(names.join("::"));
        }
        visit::visit_path(self, path);
    }
}

fn calls(file: &File, drawing: bool) -> Vec<String> {
    let syntax = syn::parse_file(&file.text).unwrap_or_else(|e| panic!("{}: {e}", file.name()));
    let mut calls = Calls { drawing, ..Calls::default() };
    calls.visit_file(&syntax);
    calls.found
}

#[test]
fn what_is_drawn_never_calls_the_platforms_functions() {
    let mut wrong = Vec::new();
    for file in File::all() {
        let whole = [
            "theory/rules.rs",
            "kernels/scoring.rs",
            "kernels/walk.rs",
            "transmittance/next_flight.rs",
            "transmittance/unidirectional_mis.rs",
            "rng.rs",
        ];
        let module = file.module();
        let drawing = module == "phase" || whole.iter().any(|path| file.path.ends_with(path));
        if drawing || ["kernels", "estimators", "mutants"].contains(&module.as_str()) {
            let found = calls(&file, drawing);
            wrong.extend(found.iter().map(|call| format!("{}: {call}", file.name())));
        }
        if file.path.ends_with("media/piecewise.rs") {
            let found = calls(&file, false);
            wrong.extend(found.iter().map(|call| format!("{}: {call}", file.name())));
        }
    }
    assert!(wrong.is_empty(), "use numeric::elementary instead:\n{}", wrong.join("\n"));
}

/// The lines before functions named `draw` whose code cannot go into what is compiled for the machine:
/// there a fused multiplication would be a call of the mathematical library.
fn left_outside(text: &str) -> Vec<&str> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let pairs = lines.windows(2).filter(|pair| {
        let begins =
            pair[1].trim_start_matches("pub ").starts_with("fn draw<") && pair[1].ends_with('(');
        begins && !pair[0].starts_with("#[inline")
    });
    pairs.map(|pair| pair[0]).collect()
}

#[test]
fn every_estimators_draw_is_compiled_for_the_machine() {
    let files = File::all();
    let of_estimators = files.iter().filter(|file| file.module() == "estimators");
    let outside = of_estimators.filter(|file| !left_outside(&file.text).is_empty());
    let wrong: Vec<String> = outside.map(File::name).collect();
    assert!(wrong.is_empty(), "write #[inline(always)] before draw:\n{}", wrong.join("\n"));
    assert_eq!(left_outside("/// Draws.\npub fn draw<M: Extinction>(\n"), ["/// Draws."]);
    assert!(left_outside("#[inline(always)]\nfn draw<M: Extinction>(\n").is_empty());
}

#[test]
fn the_reader_of_calls_sees_them() {
    let file = |text: &str| File { path: "estimators/a.rs".into(), text: text.into() };
    assert_eq!(calls(&file("fn draw() { (-x).exp() }"), false), [".exp()"]);
    assert_eq!(calls(&file("fn draw() { libm::log(x) + f64::sin(y) }"), false).len(), 2);
    assert!(calls(&file("fn draw() { elementary::exp(-x) }"), false).is_empty());
    assert!(calls(&file("fn predict() { x.exp() }"), false).is_empty());
    assert!(calls(&file("mod tests { fn draw() { x.exp() } }"), false).is_empty());
}
