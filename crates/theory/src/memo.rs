//! A memo of computed answers: experiments with equal keys share them.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

/// Answers by the key that they depend on.
pub struct Memo<K, V> {
    answers: LazyLock<Mutex<HashMap<K, Arc<OnceLock<V>>>>>,
    maximum: usize,
}

impl<K: Eq + Hash, V: Clone> Memo<K, V> {
    /// An empty memo; when it holds `maximum` answers it drops them all.
    pub const fn new(maximum: usize) -> Self {
        Self { answers: LazyLock::new(Mutex::default), maximum }
    }

    /// Returns the answer; it is computed only once, also if several threads need it at the same time.
    pub fn get(&self, key: K, find: impl FnOnce() -> V) -> V {
        let slot = {
            // A panic in another thread leaves whole slots behind.
            let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
            if answers.len() >= self.maximum {
                answers.clear();
            }
            answers.entry(key).or_default().clone()
        };
        slot.get_or_init(find).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn equal_keys_share_an_answer_and_others_have_their_own() {
        static SQUARES: Memo<Vec<u64>, u64> = Memo::new(3);
        let count = AtomicUsize::new(0);
        let square = |x: u64| {
            SQUARES.get(vec![x], || {
                count.fetch_add(1, Ordering::Relaxed);
                x * x
            })
        };
        assert_eq!([2, 3, 2, 3, 2].map(square), [4, 9, 4, 9, 4]);
        assert_eq!(count.load(Ordering::Relaxed), 2);
        // A full memo drops all answers, and computes them again.
        assert_eq!([4, 5, 2].map(square), [16, 25, 4]);
        assert_eq!(count.load(Ordering::Relaxed), 5);
    }
}
