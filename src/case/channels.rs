//! Problems in one channel: a list of one is read as its one entry.
//!
//! | written | read as |
//! |---|---|
//! | `medium = [x]`, `volume = [x]`, `sampling = [x]`, `forward = [x]` | `medium = x`, … |
//! | `albedos = [x]`, `phases = [x]` | `albedo = x`, `phase = x` |
//!
//! A problem with one channel is the problem without channels: the same experiments, with the same names and draws. Lists
//! stay where an estimator is listed that only problems in several channels have.

use std::mem;

use estimators::FormCatalogue;
use media::catalogue::{Entry, Node, OwnPages, Value};
use theory::problems::ProblemOption;

/// Keys that list something for each channel, and the key of one channel.
const LISTS: [(&str, &str); 6] = [
    ("medium", "medium"),
    ("volume", "volume"),
    ("albedos", "albedo"),
    ("phases", "phase"),
    ("sampling", "sampling"),
    ("forward", "forward"),
];

/// Reads lists of one channel as their entries, in all problems and pictures of a file.
pub fn read_single_channels(root: &mut [Entry], own_pages: &OwnPages) {
    for top in root.iter_mut().filter(|entry| matches!(&*entry.key, "problem" | "picture")) {
        let Value::Table(problems) = &mut top.node.value else { continue };
        for Entry { key, node, .. } in problems {
            let Value::Table(settings) = &mut node.value else { continue };
            if has_one_channel(settings) && !needs_channels(key, settings, own_pages) {
                read_entries(settings);
            }
        }
    }
}

/// Returns whether media, albedos and phase functions are given for one channel, some of them in a list.
fn has_one_channel(settings: &[Entry]) -> bool {
    let lists = settings.iter().filter(|entry| LISTS[..4].iter().any(|(key, _)| *key == entry.key));
    let lengths = lists.filter_map(|entry| match &entry.node.value {
        Value::Array(items) => Some(items.len()),
        _ => None,
    });
    let lengths: Vec<usize> = lengths.collect();
    !lengths.is_empty() && lengths.iter().all(|&length| length == 1)
}

/// Returns whether an estimator is listed that only the forms of a problem in several channels have.
fn needs_channels(problem: &str, settings: &[Entry], own_pages: &OwnPages) -> bool {
    let forms = estimators::catalogues().into_iter().filter(|form| form.problem == problem);
    let (several, one): (Vec<_>, Vec<_>) = forms.partition(|form| {
        let options = form.options;
        options.contains(&ProblemOption::Albedos) || options.contains(&ProblemOption::Media)
    });
    let has = |form: &FormCatalogue, name: &str| {
        let part = format!("estimators of {}", form.title);
        let own = own_pages.all().iter().filter(|own| own.part == part).map(|own| &own.page);
        form.pages.iter().chain(own).any(|page| page.name() == name)
    };
    let mut names = settings.iter().filter(|entry| entry.key == "estimators").flat_map(names);
    names.any(|name| {
        several.iter().any(|form| has(form, name)) && !one.iter().any(|form| has(form, name))
    })
}

/// Names in a list of estimators.
fn names(estimators: &Entry) -> impl Iterator<Item = &str> {
    let items: &[Node] = if let Value::Array(items) = &estimators.node.value { items } else { &[] };
    items.iter().filter_map(|item| match &item.value {
        Value::Text(name) => Some(name.as_str()),
        Value::Table(entries) => Some(entries.first()?.key.as_str()),
        _ => None,
    })
}

/// Replaces lists of one by their entries, in settings of a problem and of its estimators.
fn read_entries(settings: &mut [Entry]) {
    for (list, key) in LISTS {
        if list != key && settings.iter().any(|entry| entry.key == key) {
            continue;
        }
        for entry in settings.iter_mut().filter(|entry| entry.key == list) {
            if read_entry(&mut entry.node) {
                key.clone_into(&mut entry.key);
            }
        }
    }
    for Entry { key, node, .. } in settings {
        if matches!(&**key, "estimators" | "reference") {
            read_sampling(node);
        }
    }
}

/// Replaces lists of one σ̂ at any depth.
fn read_sampling(node: &mut Node) {
    match &mut node.value {
        Value::Array(items) => items.iter_mut().for_each(read_sampling),
        Value::Table(entries) => {
            for Entry { key, node, .. } in entries {
                if key != "sampling" || !read_entry(node) {
                    read_sampling(node);
                }
            }
        }
        _ => {}
    }
}

/// Replaces a list of one by its entry; `false` for anything else.
fn read_entry(node: &mut Node) -> bool {
    let Value::Array(items) = &mut node.value else { return false };
    let [only] = &mut items[..] else { return false };
    *node = Node {
        value: mem::replace(&mut only.value, Value::Boolean(false)),
        span: only.span.clone(),
    };
    true
}
