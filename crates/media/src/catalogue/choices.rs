//! Settings that choose among names: words, and tables that name a page.
//!
//! A name without settings may be written alone or with an empty table, at any place: `shadow = "exact"` and
//! `shadow.exact = {}` are equivalent.

use std::ops::Range;

use super::words::{brief, quoted, suggestion};
use super::{Entry, Settings, Value};

/// The form in which a table is written.
#[derive(Debug, Clone, Copy)]
pub(super) enum Form<'a> {
    /// A table.
    Table,
    /// A text in the place of a table that would name a page.
    Name(&'a str),
    /// The empty table of a page that was written by its name alone.
    Named,
    /// The empty table of a page that has a value in its place: index of the mistake that reports it.
    Value(usize),
}

/// Explains a name that is not among those of a choice: the message and the cure; `None` without a better explanation
/// than the list of names.
pub type Explanation<'a> = &'a dyn Fn(&str) -> Option<[String; 2]>;

impl<'a> Settings<'a> {
    /// A required word, one of `words`.
    pub fn word(&self, key: &'static str, words: &[&'static str]) -> Option<&'static str> {
        let expected = format!("one of {}", quoted(words));
        let entry = self.required(key, &expected)?;
        self.word_of(entry, words, &expected)
    }

    /// One of `words`, or `default` where the key is absent.
    pub fn word_or(
        &self,
        key: &'static str,
        words: &[&'static str],
        default: &'static str,
    ) -> Option<&'static str> {
        let expected = format!("one of {}", quoted(words));
        self.entry(key).map_or(Some(default), |entry| self.word_of(entry, words, &expected))
    }

    /// The value of one of some words; that of the first where the key is absent.
    pub fn one_of<T: Copy>(&self, key: &'static str, values: &[(&'static str, T)]) -> Option<T> {
        let words: Vec<&str> = values.iter().map(|(word, _)| *word).collect();
        let word = self.word_or(key, &words, words[0])?;
        values.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
    }

    fn word_of(
        &self,
        entry: &Entry,
        words: &[&'static str],
        expected: &str,
    ) -> Option<&'static str> {
        let (text, span, settings) = match &entry.node.value {
            Value::Text(text) => (text, &entry.node.span, None),
            Value::Table(table) if table.len() == 1 => {
                (&table[0].key, &table[0].key_span, Some(&table[0].node))
            }
            _ => {
                self.wrong(entry, expected);
                return None;
            }
        };
        let Some(word) = words.iter().find(|word| *word == text).copied() else {
            let message = format!("`{}` is \"{}\"", entry.key, brief(text));
            self.fault_at(span.clone(), &entry.key, message, suggestion(text, words, expected));
            return None;
        };
        let takes_none = |value: &Value| matches!(value, Value::Table(table) if table.is_empty());
        if let Some(node) = settings.filter(|node| !takes_none(&node.value)) {
            let message = format!("`{word}` takes no settings here");
            let help = format!("write `{} = \"{word}\"`", entry.key);
            self.fault_at(node.span.clone(), &entry.key, message, help);
            return None;
        }
        Some(word)
    }

    /// A required table that names a page, or the page's name alone.
    pub fn naming(&self, key: &'static str, expected: &str) -> Option<Settings<'a>> {
        let entry = self.required(key, expected)?;
        match &entry.node.value {
            Value::Table(_) => self.open(entry),
            Value::Text(name) => {
                let (span, path) = (entry.node.span.clone(), self.path_of(&entry.key));
                Some(self.written(Form::Name(name), span, path))
            }
            _ => {
                self.wrong(entry, expected);
                None
            }
        }
    }

    /// An empty table, written in another form.
    fn written(&self, form: Form<'a>, span: Range<usize>, path: String) -> Settings<'a> {
        let mut settings = self.child(&[], span, path);
        settings.form = form;
        settings
    }

    /// The tables of a required list; each names a page, and the name may stand alone.
    pub fn tables(&self, key: &'static str) -> Option<Vec<Settings<'a>>> {
        const WANTED: &str = "a list of names and tables, as in [\"ratio\", { ratio = { … } }]";
        let entry = self.required(key, WANTED)?;
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, WANTED);
            return None;
        };
        let mut tables = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let path = self.path_of(&format!("{key}[{index}]"));
            match &item.value {
                Value::Table(table) => tables.push(self.child(table, item.span.clone(), path)),
                Value::Text(name) => {
                    tables.push(self.written(Form::Name(name), item.span.clone(), path));
                }
                other => {
                    let message = format!("{} stands in `{key}`", other.kind());
                    let help = "each entry is a name in quotes or a table, as in { ratio = {} }";
                    self.fault_at(item.span.clone(), key, message, help);
                }
            }
        }
        Some(tables)
    }

    /// A table with exactly one key, which names one of `names`: `{ gaussian = { … } }`. Returns
    /// the position of the name and the table behind it.
    pub fn choice(&self, names: &[String]) -> Option<(usize, Settings<'a>)> {
        self.choice_explained(names, &|_| None)
    }

    /// A choice in which some other names are explained.
    pub fn choice_explained(
        &self,
        names: &[String],
        explain: Explanation,
    ) -> Option<(usize, Settings<'a>)> {
        let list = quoted(names);
        let position = |name: &str, span: &Range<usize>| {
            let index = names.iter().position(|known| known == name);
            if index.is_none() {
                let words: Vec<&str> = names.iter().map(String::as_str).collect();
                let [message, help] = explain(name).unwrap_or_else(|| {
                    let message = format!("`{}` is not known here", brief(name));
                    [message, suggestion(name, &words, &format!("one of {list}"))]
                });
                self.fault_at(span.clone(), "", message, help);
            }
            index
        };
        if let Form::Name(name) = self.form {
            let index = position(name, &self.span)?;
            let path = self.path_of(name);
            return Some((index, self.written(Form::Named, self.span.clone(), path)));
        }
        let [entry] = self.table else {
            let (span, message) = match self.table {
                [] => (self.span.clone(), "nothing is chosen here".to_owned()),
                [_, second, ..] => {
                    (second.key_span.clone(), format!("`{}` is one too many", second.key))
                }
                [_] => unreachable!("one entry is matched above"),
            };
            self.fault_at(span, "", message, format!("choose one of {list}"));
            return None;
        };
        let index = position(&entry.key, &entry.key_span)?;
        if let Value::Table(_) = entry.node.value {
            return self.open(entry).map(|settings| (index, settings));
        }
        self.wrong(entry, "a table, as in { … }");
        let form = Form::Value(self.faults.borrow().len() - 1);
        let path = self.path_of(&entry.key);
        Some((index, self.written(form, entry.node.span.clone(), path)))
    }

    /// A required table that chooses one of several names, as in `phase.isotropic = {}`, or the name alone.
    pub fn chosen(&self, key: &'static str, names: &[String]) -> Option<(usize, Settings<'a>)> {
        self.chosen_explained(key, names, &|_| None)
    }

    /// A required choice, in which some other names are explained.
    pub fn chosen_explained(
        &self,
        key: &'static str,
        names: &[String],
        explain: Explanation,
    ) -> Option<(usize, Settings<'a>)> {
        let expected = format!("one of {}", quoted(names));
        self.naming(key, &expected)?.choice_explained(names, explain)
    }

    /// Records that a key is missing, with its cure.
    pub(super) fn missing(&self, key: &str, expected: &str) {
        let message = format!("`{key}` is missing");
        match self.form {
            Form::Table | Form::Name(_) => {
                self.fault_at(self.span.clone(), "", message, format!("add `{key}`, {expected}"));
            }
            Form::Named => {
                let full = self.in_full(key);
                let help = format!("the name alone is not enough: write `{full}`, {expected}");
                self.fault_at(self.span.clone(), "", message, help);
            }
            Form::Value(index) => {
                let mut faults = self.faults.borrow_mut();
                if let Some(fault) =
                    faults.get_mut(index).filter(|fault| fault.help.starts_with("it takes"))
                {
                    fault.help = format!("write `{}`, {expected}", self.in_full(key));
                }
            }
        }
    }

    /// A key with the table that it belongs to, as in `phase.henyey-greenstein = { g = … }`.
    fn in_full(&self, key: &str) -> String {
        let mut parts = self.path.rsplit('.');
        let (name, owner) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
        if owner.is_empty() || owner.ends_with(']') {
            format!("{{ {name} = {{ {key} = … }} }}")
        } else {
            format!("{owner}.{name} = {{ {key} = … }}")
        }
    }
}
