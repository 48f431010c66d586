//! Claims about draws by the arguments of `trueflight judge`, and verdicts by them.

use anyhow::Context;

use super::{Arguments, JudgedDraws};
use crate::case::{Case, CaseError, Catalogue};
use crate::judge::{
    CheckedClaim, ChoiceError, Claim, ClaimError, DrawSource, ExperimentChoice, Layout, Lookups,
    Options, Session, Theory, TheoryClaims, estimators_of, theory_of,
};

/// Claims about the draws of a file.
pub(super) struct Claimed {
    /// A claim for each channel, with its name; the name is empty if there is only one.
    claims: Vec<(String, Claim)>,
    theory: Option<Theory>,
    /// Index of the judged channel, if one was chosen.
    channel: Option<usize>,
    is_mean_only: bool,
}

impl Claimed {
    /// Returns whether the claims come from theory.
    pub(super) fn has_theory(&self) -> bool {
        self.theory.is_some()
    }

    /// Returns whether the tolerance is relative to a truth.
    pub(super) fn is_relative(&self) -> bool {
        self.claims.iter().any(|(_, claim)| claim.truth != 0.0)
    }

    /// Validates the options of the gate against the claims.
    pub(super) fn check(&self, options: Options) -> Result<(), ClaimError> {
        let judged = |(index, _): &(usize, _)| self.channel.is_none_or(|channel| channel == *index);
        let claims = self.claims.iter().enumerate().filter(judged);
        claims
            .map(|(_, (_, claim))| *claim)
            .try_for_each(|claim| CheckedClaim::new(claim, options, None).map(drop))
    }

    /// Returns the columns of a file that are judged.
    pub(super) fn layout(&self, column: Option<&str>) -> Layout {
        let channels: Vec<String> = self.claims.iter().map(|(name, _)| name.clone()).collect();
        let theory = self.theory.as_ref();
        let may_lack = theory.is_some_and(|theory| {
            channels.len() > 1 && theory.channels_of(channels.len() - 1).is_some()
        });
        let column = column.and_then(|text| text.parse().ok());
        Layout { column, channels, derived: usize::from(may_lack), channel: self.channel }
    }

    /// Judges the draws of a file, channel by channel.
    pub(super) fn judge(
        &self,
        file: &str,
        draws: &mut DrawSource,
        options: Options,
        length: Option<u64>,
    ) -> anyhow::Result<Vec<JudgedDraws>> {
        let values = draws.values();
        let of_channel = self.channel.map(|channel| &self.claims[channel..=channel]);
        let named = of_channel.unwrap_or(&self.claims[..values]);
        let claims: Vec<Claim> = named.iter().map(|(_, claim)| *claim).collect();
        let has_lookups = claims.first().is_some_and(|first| first.lookups.is_some());
        let taken = self.theory.as_ref().map(|theory| TheoryClaims {
            theory,
            has_lookups,
            is_mean_only: self.is_mean_only,
        });
        let session = Session::new(&claims, options, length, taken)?;
        let judgements = session.judge(draws, options.until())?;
        let named =
            judgements.into_iter().zip(named).map(|(judgement, (channel, _))| JudgedDraws {
                file: file.to_owned(),
                channel: if values > 1 { channel.clone() } else { String::new() },
                judgement,
            });
        Ok(named.collect())
    }
}

impl Arguments {
    /// Returns the claims, from numbers or from a case.
    pub(super) fn claimed(&self, catalogue: &Catalogue) -> anyhow::Result<Claimed> {
        let Some(name) = &self.case else {
            let claims = vec![(String::new(), self.claim_by_numbers()?)];
            return Ok(Claimed { claims, theory: None, channel: None, is_mean_only: false });
        };
        let cases = catalogue.named(name).map_err(|errors| {
            let shown: Vec<String> = errors.iter().map(CaseError::in_full).collect();
            anyhow::anyhow!("--case: {}", shown.join("\n\n"))
        })?;
        let [case] = &cases[..] else {
            let names: Vec<&str> = cases.iter().map(|case: &Case| case.name.as_str()).collect();
            anyhow::bail!("--case {name} is several cases; choose one of: {}", names.join(", "));
        };
        let Some(estimator) = &self.estimator else {
            let names = estimators_of(case).join(", ");
            anyhow::bail!(
                "{}: say which estimator made the draws, by --estimator: {names}",
                case.name
            );
        };
        let (swept, nearest) = (self.swept, self.nearest);
        let choice = ExperimentChoice { estimator, swept, nearest, channel: None, seed: self.seed };
        let theory = theory_of(case, &choice, self.rounding)?;
        let channel = self.channel_of(case, &theory)?;
        let takes_all = !self.mean_only && self.batch == 1;
        if takes_all && (self.variance.is_some() || self.kurtosis.is_some()) {
            anyhow::bail!(
                "--case has a variance and a kurtosis; leave out --variance and --kurtosis, or add \
                 --mean-only"
            );
        }
        let has_lookups = theory.channels.first().is_some_and(|(_, claim)| claim.lookups.is_some());
        if self.lookups.is_some() && (!has_lookups || !takes_all) {
            let why = match (takes_all, self.batch) {
                (true, _) => "theory has no number of lookups for this estimator",
                (false, 1) => "--mean-only takes the truth alone",
                (false, _) => "--batch takes the truth alone",
            };
            anyhow::bail!("{why}; leave --lookups out");
        }
        let claims = theory
            .channels
            .iter()
            .map(|(name, claim)| Ok((name.clone(), self.claim_by_theory(*claim, takes_all)?)));
        let claims: Result<Vec<_>, ClaimError> = claims.collect();
        Ok(Claimed { claims: claims?, theory: Some(theory), channel, is_mean_only: self.mean_only })
    }

    /// Returns the index of the chosen channel.
    fn channel_of(&self, case: &Case, theory: &Theory) -> anyhow::Result<Option<usize>> {
        let names = theory.names();
        let place = |name: &String| names.iter().position(|other| other == name);
        let wrong = || ChoiceError::Channel { case: case.name.clone(), channels: names.clone() };
        match &self.channel {
            Some(name) => Ok(Some(place(name).ok_or_else(wrong)?)),
            // A column is one channel, and only the caller knows which.
            None if self.column.is_some() && names.len() > 1 => anyhow::bail!(
                "--column is one channel of {}; say which, by --channel: {}",
                case.name,
                names.join(", ")
            ),
            None => Ok(None),
        }
    }

    fn claim_by_theory(&self, theory: Claim, takes_all: bool) -> Result<Claim, ClaimError> {
        let lookups = theory.lookups.filter(|_| self.lookups.is_some());
        let (variance, kurtosis) = (self.variance, self.kurtosis);
        let claim = if takes_all {
            Claim { lookups, ..theory }
        } else {
            let numbers = Claim { variance, kurtosis, ..Claim::of_truth(theory.truth) };
            numbers.validated()?.about(theory)
        };
        claim.within(self.range)
    }

    fn claim_by_numbers(&self) -> anyhow::Result<Claim> {
        let lookups = match (&self.lookups, self.expected_lookups) {
            (Some(_), None) => anyhow::bail!(
                "what the lookups should be is not known; give --expected-lookups or --case"
            ),
            (_, mean) => mean,
        };
        let truth = self.truth.context(
            "what the draws should be on average is not known; give it by --truth T, or by a case with --case CASE \
             --estimator NAME",
        )?;
        let variance = self.lookups_variance;
        let claim = Claim {
            variance: self.variance,
            kurtosis: self.kurtosis,
            range: self.range,
            lookups: lookups.map(|mean| Lookups { mean, variance, error: 0.0 }),
            rounding: self.rounding,
            ..Claim::of_truth(truth)
        };
        Ok(claim.validated()?)
    }
}
