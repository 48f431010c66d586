//! Answers that were worked out before: experiments that ask the same share theirs.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

/// Answers by what they depend on.
pub struct Memo<K, V> {
    answers: LazyLock<Mutex<HashMap<K, Arc<OnceLock<V>>>>>,
    most: usize,
}

impl<K: Eq + Hash, V: Copy> Memo<K, V> {
    /// Without answers; more than so many are forgotten, all together.
    pub const fn new(most: usize) -> Self {
        Self { answers: LazyLock::new(Mutex::default), most }
    }

    /// The answer, which is worked out once and only once, whoever asks.
    pub fn get(&self, key: K, find: impl FnOnce() -> V) -> V {
        let slot = {
            // A panic of someone else leaves whole slots behind.
            let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
            if answers.len() >= self.most {
                answers.clear();
            }
            answers.entry(key).or_default().clone()
        };
        *slot.get_or_init(find)
    }
}
