//! Estimators of a program's own: types that implement [`Estimator`], registered before cases are read.

use super::trial::Entry;
use super::{Estimated, Estimator};
use crate::catalogue::{Addition, Page, Settings};

/// Reads an estimator of problem `P` from `{ NAME = { … } }`.
pub type EstimatorReader<P> = fn(&Settings) -> Option<Box<dyn Entry<P>>>;

impl Addition {
    /// An estimator of problem `P`: it is named in case files, drawn, judged, plotted and timed as the built-in
    /// ones are.
    ///
    /// ```
    /// use trueflight::catalogue::{Addition, Page};
    /// use trueflight::estimators::transmittance::ratio::Ratio;
    /// use trueflight::{Catalogue, problems::Transmittance};
    ///
    /// // Ratio tracking by another name; any type that implements `Estimator<Transmittance>` will do.
    /// let page = Page { module: "my_ratio", source: "Mine." };
    /// let mine = Addition::estimator::<Transmittance, Ratio>(page);
    /// let catalogue = Catalogue::builtin().with(mine)?; // estimators = [{ my-ratio = {} }]
    /// # Ok::<(), trueflight::harness::catalogue::NameTaken>(())
    /// ```
    pub fn estimator<P: Estimated, E: Estimator<P>>(page: Page) -> Self {
        let read: EstimatorReader<P> =
            |settings| E::read(settings).map(|page| Box::new(page) as Box<dyn Entry<P>>);
        Self::new(format!("estimators of {}", P::MODULE.replace('_', "-")), page, read)
    }
}
