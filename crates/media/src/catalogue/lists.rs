//! Settings that are lists of numbers.

use std::ops::RangeInclusive;

use super::words::whole;
use super::{Domain, Entry, Settings, Value};
use numeric::digits::number;

/// Maximum number of mistakes of one list that are listed separately.
const TOLD: usize = 5;

const TRIPLE: &str = "a list of three finite numbers [x, y, z]";

impl Settings<'_> {
    /// A required list of numbers, at least `minimum` of them.
    pub fn numbers(&self, key: &'static str, domain: Domain, minimum: usize) -> Option<Vec<f64>> {
        let expected = format!("a list of at least {minimum}, each {}", domain.words());
        let entry = self.required(key, &expected)?;
        self.list_of(entry, domain, &expected).filter(|list| {
            let enough = list.len() >= minimum;
            if !enough {
                self.wrong(entry, &expected);
            }
            enough
        })
    }

    /// A required point or vector `[x, y, z]`.
    pub fn triple(&self, key: &'static str) -> Option<[f64; 3]> {
        let entry = self.required(key, TRIPLE)?;
        self.triple_of(entry, Domain::Finite, TRIPLE)
    }

    /// A point or vector, or `default` where the key is absent.
    pub fn triple_or(&self, key: &'static str, default: [f64; 3]) -> Option<[f64; 3]> {
        let given = self.entry(key);
        given.map_or(Some(default), |entry| self.triple_of(entry, Domain::Finite, TRIPLE))
    }

    /// Three required integers in a range.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
    pub fn counts(&self, key: &'static str, range: RangeInclusive<u64>) -> Option<[usize; 3]> {
        let expected = format!("a list of three, each {}", whole(&range));
        let entry = self.required(key, &expected)?;
        let triple = self.triple_of(entry, Domain::NonNegative, &expected)?;
        if triple.iter().all(|x| x.fract() == 0.0 && range.contains(&(*x as u64))) {
            return Some(triple.map(|x| x as usize));
        }
        self.wrong(entry, &expected);
        None
    }

    /// A required list of points or vectors `[[x, y, z], …]`.
    pub fn triples(&self, key: &'static str) -> Option<Vec<[f64; 3]>> {
        let expected = "a list of triples of finite numbers [[x, y, z], …]";
        let entry = self.required(key, expected)?;
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, expected);
            return None;
        };
        let triples = items.iter().map(|node| {
            let (key, key_span) = (entry.key.clone(), entry.key_span.clone());
            let item = Entry { key, key_span, node: node.clone() };
            self.triple_of(&item, Domain::Finite, "three finite numbers [x, y, z] each")
        });
        triples.collect::<Vec<_>>().into_iter().collect()
    }

    fn triple_of(&self, entry: &Entry, domain: Domain, expected: &str) -> Option<[f64; 3]> {
        let list = self.list_of(entry, domain, expected)?;
        let triple = <[f64; 3]>::try_from(list);
        if triple.is_err() {
            self.wrong(entry, expected);
        }
        triple.ok()
    }

    fn list_of(&self, entry: &Entry, domain: Domain, expected: &str) -> Option<Vec<f64>> {
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, expected);
            return None;
        };
        let mut list = Vec::with_capacity(items.len());
        let mut wrong = items.iter().filter(|item| match item.value {
            Value::Number(x) if domain.contains(x) => {
                list.push(x);
                false
            }
            _ => true,
        });
        let help = format!("each entry is {}", domain.words());
        for item in wrong.by_ref().take(TOLD) {
            let actual = match item.value {
                Value::Number(x) => number(x),
                ref other => other.kind().to_owned(),
            };
            let message = format!("{actual} stands in `{}`", entry.key);
            self.fault_at(item.span.clone(), &entry.key, message, help.as_str());
        }
        if let Some(next) = wrong.next() {
            let more = 1 + wrong.count();
            let message = format!("{more} more entries of `{}` are wrong", entry.key);
            self.fault_at(next.span.clone(), &entry.key, message, help);
        }
        (list.len() == items.len()).then_some(list)
    }
}
