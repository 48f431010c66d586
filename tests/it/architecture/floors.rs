//! The floor plan: a module uses only floors below its own.
//!
//! Every path that begins with `crate::`, with `trueflight::` in the binary, or with enough `super::`, is an
//! edge from the file's top-level module to another.

use super::sources::{File, product, used};

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
    ("export", 6),
    ("report", 7),
    ("check", 7),
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
