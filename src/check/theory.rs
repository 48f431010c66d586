//! What theory knows of a draw.

use super::builder::Check;
use crate::harness::case::Case;
use crate::harness::catalogue::Catalogue;
use crate::harness::source::CaseError;
use crate::judge::Choice;
use crate::judge::theory::Theory;

impl<S> Check<S> {
    /// Takes mean, variance, kurtosis and lookups from theory and, where theory knows it, the whole distribution.
    ///
    /// The estimator has its name in tables or in the catalogue. It is taken at any value of what the case sweeps, or at a
    /// constant σ̂ where the case sweeps nothing; `None` takes the case's own σ̂. The case is a built-in one or a file. Every
    /// channel of the case is a value of the draw; a luminance may be left out.
    ///
    /// A free flight that leaves the ray is written as the ray's length, as any larger number, as infinity or as −1.
    ///
    /// ```
    /// # use trueflight::rng::Stream;
    /// # fn sigma_t(t: f64) -> f64 {
    /// #     (0.75 * t).cos().powi(10) * ((t / 2.0).sin() + 2.0) / 3.0
    /// # }
    /// # fn my_estimator(rng: &mut Stream) -> f64 {
    /// #     let (mut weight, mut t) = (1.0, -rng.positive_uniform().ln());
    /// #     while t < 20.0 {
    /// #         weight *= 1.0 - sigma_t(t);
    /// #         t -= rng.positive_uniform().ln();
    /// #     }
    /// #     weight
    /// # }
    /// trueflight::check("ratio tracking", |rng| my_estimator(rng))
    ///     .of("transmittance/eq21-overview", "ratio", 1.0)
    ///     .assert_pass();
    /// ```
    pub fn of(self, case: &str, estimator: &str, swept: impl Into<Option<f64>>) -> Self {
        let choice = Choice { estimator, swept: swept.into(), ..Choice::default() };
        match Catalogue::builtin().named(case) {
            Ok(read) => match &read[..] {
                [case] => self.of_case(case, &choice),
                cases => {
                    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
                    let names = names.join(", ");
                    self.without_theory(format!("{case} is several cases; choose one of: {names}"))
                }
            },
            Err(errors) => {
                let said: Vec<String> = errors.iter().map(CaseError::in_full).collect();
                self.without_theory(said.join("\n\n"))
            }
        }
    }

    /// The same of a case that was read before.
    pub fn of_case(mut self, case: &Case, choice: &Choice) -> Self {
        let theory = Theory::of(case, choice, 0.0);
        self.said.theory = Some(theory.map_err(|error| error.to_string()));
        self
    }

    fn without_theory(mut self, why: String) -> Self {
        self.said.theory = Some(Err(why));
        self
    }
}
