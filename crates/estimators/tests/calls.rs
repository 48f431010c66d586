//! Draws call the crate's own functions, and are compiled for the machine.

use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

/// A source file.
struct File {
    /// The path below the folder of the crates.
    path: PathBuf,
    text: String,
}

impl File {
    /// Returns the sources of all crates.
    fn all() -> Vec<Self> {
        let root =
            Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the crates");
        let mut files = Vec::new();
        let mut folders = vec![root.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = std::fs::read_to_string(&path).expect("a text");
                    files.push(Self {
                        path: path.strip_prefix(root).expect("below it").into(),
                        text,
                    });
                }
            }
        }
        assert!(files.len() > 50, "the sources were not found");
        files
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn is_in(&self, folder: &str) -> bool {
        self.path.starts_with(folder)
    }
}

/// The platform's functions with results that differ in their last bits between platforms. `sqrt`, `abs` and the
/// like are exact everywhere.
const INEXACT: &[&str] = &[
    "ln", "ln_1p", "log", "log2", "log10", "exp", "exp2", "exp_m1", "sin", "cos", "tan", "sin_cos",
    "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "powf", "powi", "cbrt", "hypot",
    "mul_add",
];

/// Collects calls of [`INEXACT`] methods, and of anything in `libm`, in functions that draw.
#[derive(Default)]
struct Calls {
    /// True while the visited functions run in a draw.
    drawing: bool,
    result: Vec<String>,
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
            self.result.push(format!(".{name}()"));
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let foreign = matches!(names.first().map(String::as_str), Some("libm" | "f64" | "f32"));
        let inexact = names.last().is_some_and(|name| INEXACT.contains(&name.as_str()));
        if self.drawing && foreign && inexact {
            self.result.push(names.join("::"));
        }
        visit::visit_path(self, path);
    }
}

fn calls(file: &File, drawing: bool) -> Vec<String> {
    let syntax = syn::parse_file(&file.text).unwrap_or_else(|e| panic!("{}: {e}", file.name()));
    let mut calls = Calls { drawing, ..Calls::default() };
    calls.visit_file(&syntax);
    calls.result
}

#[test]
fn what_is_drawn_never_calls_the_platforms_functions() {
    let mut wrong = Vec::new();
    for file in File::all() {
        let whole = [
            "theory/src/rules.rs",
            "transmittance/product.rs",
            "transmittance/scoring.rs",
            "transmittance/next_flight.rs",
            "transmittance/unidirectional_mis.rs",
            "rng/mod.rs",
        ];
        let drawing =
            file.is_in("media/src/phase") || whole.iter().any(|path| file.path.ends_with(path));
        if drawing || file.is_in("estimators/src") || file.is_in("lab/src/mutants") {
            let result = calls(&file, drawing);
            wrong.extend(result.iter().map(|call| format!("{}: {call}", file.name())));
        }
        if file.path.ends_with("media/src/piecewise.rs") {
            let result = calls(&file, false);
            wrong.extend(result.iter().map(|call| format!("{}: {call}", file.name())));
        }
    }
    assert!(wrong.is_empty(), "use numeric::elementary instead:\n{}", wrong.join("\n"));
}

/// Returns the lines before functions named `draw` that are not inlined into code for the machine: there a fused
/// multiplication would be a call of the mathematical library.
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
    let of_estimators = files.iter().filter(|file| file.is_in("estimators/src"));
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
