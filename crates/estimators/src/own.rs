//! Estimators of a program's own: types that implement [`Estimator`], registered before cases are read.

use super::trial::Entry;
use super::{Estimated, Estimator};
use media::catalogue::{OwnPage, Page, Settings};

/// Reader of an estimator of problem `P` from `{ NAME = { … } }`.
pub struct EstimatorReader<P>(pub fn(&Settings) -> Option<Box<dyn Entry<P>>>);

impl<P: Estimated> EstimatorReader<P> {
    /// The reader of a page.
    pub const fn of<E: Estimator<P>>() -> Self {
        Self(|settings| E::read(settings).map(|page| Box::new(page) as Box<dyn Entry<P>>))
    }
}

/// Registers an estimator of problem `P`. It is named in case files, drawn, judged, plotted and timed like the
/// built-in ones.
///
/// ```
/// use trueflight_estimators::own::estimator;
/// use trueflight_estimators::transmittance::ratio::Ratio;
/// use media::catalogue::Page;
/// use theory::problems::Transmittance;
///
/// // Ratio tracking by another name; any type that implements `Estimator<Transmittance>` will do.
/// let page = Page { module: "my_ratio", source: "Mine." };
/// let mine = estimator::<Transmittance, Ratio>(page); // estimators = [{ my-ratio = {} }]
/// assert_eq!(mine.part, "estimators of transmittance");
/// ```
pub fn estimator<P: Estimated, E: Estimator<P>>(page: Page) -> OwnPage {
    let reader = EstimatorReader::<P>::of::<E>();
    OwnPage::new(format!("estimators of {}", P::title()), page, reader)
}
