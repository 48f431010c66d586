//! Short forms of a case, expanded before it is read.
//!
//! | written | says |
//! |---|---|
//! | `sampling = 2`, `sampling.constant = 2` | `sampling.constant.value = 2`; likewise `control` |
//! | `medium = 2`, `medium.constant = 2` | `medium.constant.extinction = 2`; likewise `volume` |
//! | `volume = "cloud.vol"`, a name with a dot | `volume.grid.file = "cloud.vol"` |
//! | `sampling = [1, 2]`, `medium = [1, 2]` | a list with such a table for each channel |
//! | `sweep.WHAT = [1, 2, 3]` | `sweep.WHAT.values = [1, 2, 3]`, for all that is swept |
//! | `estimators = "ratio"` | `estimators = ["ratio"]` |
//!
//! A name alone, as in `control = "mean"`, is read by [`Settings`](media::catalogue::Settings), wherever a name is.
//! The tree is the same for both spellings: sweeps of the medium, theory and draws do not see the short form.

use std::cell::RefCell;
use std::mem;
use std::ops::Range;

use media::catalogue::{Entry, Fault, Node, Value};
use numeric::digits::number;

/// Keys that choose a page, each with the only required setting of its page `constant`.
const CONSTANTS: [(&str, &str); 4] = [
    ("medium", "extinction"),
    ("volume", "extinction"),
    ("sampling", "value"),
    ("control", "value"),
];

/// Expands the short forms of a case or picture; a setting that is almost a short form is a mistake with its cure.
pub fn spell_out(root: &mut [Entry], faults: &RefCell<Vec<Fault>>) {
    let writer = Writer { faults };
    for top in root.iter_mut().filter(|entry| matches!(&*entry.key, "problem" | "picture")) {
        for problem in entries(&mut top.node) {
            let path = format!("{}.{}", top.key, problem.key);
            writer.problem(entries(&mut problem.node), &path);
        }
    }
}

/// Returns the entries of a table; no entries for any other node.
fn entries(node: &mut Node) -> &mut [Entry] {
    if let Value::Table(entries) = &mut node.value { entries } else { &mut [] }
}

/// Moves a value into a list or table of its own, which takes its place.
fn wrap(node: &mut Node, within: impl FnOnce(Node) -> Value) {
    let value = mem::replace(&mut node.value, Value::Boolean(false));
    node.value = within(Node { value, span: node.span.clone() });
}

/// Returns a function that makes a table with one key.
fn keyed(key: &str) -> impl FnOnce(Node) -> Value {
    |node| Value::Table(vec![Entry { key: key.to_owned(), key_span: node.span.clone(), node }])
}

/// Returns a list of one value.
fn listed(node: Node) -> Value {
    Value::Array(vec![node])
}

/// Writes the long forms, and records mistakes.
struct Writer<'a> {
    faults: &'a RefCell<Vec<Fault>>,
}

impl Writer<'_> {
    /// Expands `[problem.NAME]`, which stands at a path.
    fn problem(&self, settings: &mut [Entry], path: &str) {
        self.constants(settings, &CONSTANTS, path);
        for Entry { key, node, .. } in settings {
            match &**key {
                "estimators" => {
                    if let Value::Text(_) = node.value {
                        wrap(node, listed);
                    }
                    let Value::Array(list) = &mut node.value else { continue };
                    for (index, item) in list.iter_mut().enumerate() {
                        self.estimator(item, &format!("{path}.estimators[{index}]"));
                    }
                }
                "sweep" => entries(node).iter_mut().for_each(|what| self.sweep(what, path)),
                "reference" => {
                    for entry in entries(node).iter_mut().flat_map(|way| entries(&mut way.node)) {
                        self.estimator(&mut entry.node, &format!("{path}.reference"));
                    }
                }
                _ => {}
            }
        }
    }

    /// Expands `{ NAME = { sampling, control } }`.
    fn estimator(&self, node: &mut Node, path: &str) {
        for Entry { key, node, .. } in entries(node) {
            self.constants(entries(node), &CONSTANTS[2..], &format!("{path}.{key}"));
        }
    }

    /// Expands the `medium`, `volume`, `sampling` and `control` of a table.
    fn constants(&self, settings: &mut [Entry], known: &[(&str, &str)], path: &str) {
        for Entry { key, node, .. } in settings {
            let Some((_, setting)) = known.iter().find(|(name, _)| name == key) else { continue };
            if let Value::Array(items) = &mut node.value {
                for item in items {
                    self.constant(item, [key, setting], path);
                }
            } else {
                self.constant(node, [key, setting], path);
            }
        }
    }

    /// Expands a number in the place of a page, or of the settings of the page `constant`.
    fn constant(&self, node: &mut Node, [key, setting]: [&str; 2], path: &str) {
        if let Value::Number(_) = node.value {
            wrap(node, keyed(setting));
            wrap(node, keyed("constant"));
            return;
        }
        let quoted = match &node.value {
            Value::Text(text) => text.trim().parse::<f64>().ok(),
            _ => None,
        };
        if let Some(x) = quoted {
            let message = format!("`{key}` is a number in quotes");
            let help = format!("write `{key} = {}`", number(x));
            self.fault(node.span.clone(), format!("{path}.{key}"), message, help);
            node.value = Value::Number(x);
            return self.constant(node, [key, setting], path);
        }
        if setting == "extinction" && matches!(&node.value, Value::Text(name) if name.contains('.'))
        {
            wrap(node, keyed("file"));
            wrap(node, keyed("grid"));
            return;
        }
        let [only] = entries(node) else { return };
        let name = only.key.clone();
        match (&*name, &only.node.value) {
            ("constant", Value::Number(_)) => wrap(&mut only.node, keyed(setting)),
            ("value" | "extinction" | "sigma" | "sigma_t" | "density", Value::Number(x)) => {
                let message = format!("`{name}` stands in `{key}` without the page `constant`");
                let x = number(*x);
                let help = format!("write `{key} = {x}` or `{key}.constant.{setting} = {x}`");
                let place = only.node.span.clone();
                self.fault(place, format!("{path}.{key}.{name}"), message, help);
                // Reading continues as if the name were right.
                setting.clone_into(&mut only.key);
                wrap(node, keyed("constant"));
            }
            ("field", _) => self.constants(entries(&mut only.node), &CONSTANTS[..2], path),
            _ => {}
        }
    }

    /// Expands `sweep.WHAT`.
    fn sweep(&self, what: &mut Entry, path: &str) {
        if let Value::Number(x) = what.node.value {
            let (key, x) = (&what.key, number(x));
            let fixed = matches!(&**key, "sampling" | "control" | "albedo");
            let instead =
                if fixed { format!(", or `{key} = {x}` without a sweep") } else { String::new() };
            let help = format!("write a list, as in `sweep.{key} = [{x}]`{instead}");
            let message = format!("`{key}` is a number, {x}");
            self.fault(what.node.span.clone(), format!("{path}.sweep.{key}"), message, help);
            wrap(&mut what.node, listed);
        }
        if let Value::Array(_) = what.node.value {
            wrap(&mut what.node, keyed("values"));
        }
    }

    fn fault(&self, span: Range<usize>, path: String, message: String, help: String) {
        self.faults.borrow_mut().push(Fault { span, path, message, help });
    }
}
