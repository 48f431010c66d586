//! Likely causes of a failure of a stack of images.

use super::judgement::Judgement;
use gate::causes::Pattern;
use gate::stats::verdict::Verdict;

impl Judgement {
    /// Which checks fail, and on which side; passes that depend on each other have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.order.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        pattern.number = self.refuted_by.is_some();
        if self.variance.is_some_and(|variance| variance.is_refuted) {
            pattern.note("variance", Some(1.0));
        }
        let failing =
            self.whole.iter().chain(&self.tiles).filter(|tile| tile.verdict == Verdict::Fail);
        for tile in failing {
            pattern.note("mean", Some(tile.mean - tile.truth));
        }
        pattern
    }
}
