//! Rows of an advice: an estimator with its best settings, what it costs, and how far σ̂ may be wrong.

use super::Target;
use super::costs::{Prices, Wanted};
use super::score::CandidateScore;
use super::study::{Best, Study};
use crate::case::sweep::{SweptQuantity, Variation};
use estimators::Knowledge;
use numeric::digits::number;
use theory::prediction::search::{BEYOND, MAX_FACTOR, PlaceKind, UNKNOWN};

/// Difference of two times that is a tie, with exact costs: settings are searched to this accuracy.
const TIE: f64 = 1e-3;
/// Standard error of a sample variance that can be trusted.
const TRUST: f64 = 0.1;
/// Factor on the least σ̂ at which the inequality that it must satisfy is violated.
const BELOW: f64 = 0.99;
/// Number of points of a curve on each side of the best σ̂.
const POINTS: i32 = 8;
/// Range of σ̂ of a curve on each side, as a factor.
const WIDTH: f64 = 10.0;

/// Group of rows that are ranked together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Exact variance, and nothing that is as hard to know as the answer.
    #[default]
    Ranked,
    /// Theory only bounds the variance: the time is a bound.
    Bounded,
    /// Needs τ, which is the answer itself.
    Informed,
}

impl Group {
    /// The word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ranked => "ranked",
            Self::Bounded => "bounded",
            Self::Informed => "informed",
        }
    }
}

/// One estimator with its best settings.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// Number of the candidate.
    pub candidate: usize,
    /// Its constant σ̂ or factor on σ̂; `None` where it is not free.
    pub setting: Variation,
    /// Group that it is ranked in.
    pub group: Group,
    /// Rank in its group, from 1; tied rows have the same.
    pub rank: usize,
    /// True if another row of the group is within the error of the costs.
    pub is_tie: bool,
    /// Estimator with its settings, as in `single (adaptive, a=0.3)`.
    pub estimator: String,
    /// σ̂ in words: `constant`, `local majorants, 8 segments`; empty for none.
    pub sampling: String,
    /// The constant σ̂, 1/length.
    pub constant: Option<f64>,
    /// Factor on a σ̂ that is not constant, other than 1.
    pub factor: Option<f64>,
    /// Control in words; empty for none.
    pub control: String,
    /// Kind of the setting.
    pub kind: PlaceKind,
    /// Variance and cost of a draw.
    pub score: CandidateScore,
    /// Cost to the target error, or the squared error within the budget: rows are ranked by it.
    pub goal: f64,
    /// Cost to the target error, or the budget.
    pub time: f64,
    /// Relative error at that cost.
    pub error: f64,
    /// Costs to the target error, or errors within the budget, of the rays with the least and the most.
    pub of_rays: [f64; 2],
    /// Relative error of the costs.
    pub cost_error: f64,
    /// Factors on σ̂ below and above which V·cost doubles, 0 and infinite for none; `None` where σ̂ is not free.
    pub margins: Option<[f64; 2]>,
    /// Least σ̂ or factor for which the estimator exists with a finite variance, 0 for any; `None` where σ̂ is not free.
    pub minimum: Option<f64>,
    /// Constant σ̂ and the cost to the target error, or the error within the budget, of the first rows with a constant σ̂.
    pub curve: Vec<[f64; 2]>,
    /// Knowledge of the medium that it needs beside lookups.
    pub needs: String,
    /// The lines for a case.
    pub lines: String,
}

impl Row {
    /// Returns the row of a setting, evaluated on all rays; `None` if it is refused on one.
    pub fn new(study: &Study, best: &Best) -> Option<Self> {
        let (candidate, (setting, score)) = (best.candidate, study.on_all(best)?);
        let (at, listed) = (study.cases[0].at(None).ok()?, &study.candidates[candidate]);
        let id = at.id(candidate);
        let edge = |x, sign, level| best.goal.edge(x, sign, level, MAX_FACTOR);
        let margins = |x| [-1.0, 1.0].map(|sign| edge(x, sign, 2.0 * best.goal.of(x)));
        let minimum = setting.map(|(_, x)| x * edge(x, -1.0, UNKNOWN));
        let below = setting.zip(minimum).filter(|&(_, minimum)| minimum > 0.0);
        let below = below.map(|((what, _), minimum)| (candidate, Some((what, BELOW * minimum))));
        let bound = below.and_then(|below| study.violated(below, 0..study.cases.len()));
        let known = at.needs(candidate);
        let own = match () {
            () if listed.is_profile => "|σ_t − σ_c| along the ray".to_owned(),
            () if study.learns(candidate) => "pilot rays".to_owned(),
            () => Knowledge::list(&known),
        };
        let is_learned = study.learns(candidate);
        let has_the_answer = known.iter().any(|one| one.has_the_answer());
        let group = match () {
            () if listed.is_profile || has_the_answer && !is_learned => Group::Informed,
            () if score.is_bound => Group::Bounded,
            () => Group::Ranked,
        };
        let needs = [Some(&*own).filter(|own| !own.is_empty()), bound.as_deref()];
        let of = |what| setting.filter(|setting| setting.0 == what).map(|setting| setting.1);
        let constant = of(SweptQuantity::Sampling);
        let factor = of(SweptQuantity::SamplingScale).filter(|&factor| factor != 1.0);
        let mut row = Self {
            candidate,
            setting,
            group,
            estimator: id.estimator.to_string(),
            sampling: id.sampling.kind,
            constant,
            factor,
            control: id.control,
            kind: best.kind,
            cost_error: study.prices[candidate]?.error,
            margins: setting.map(|(_, x)| margins(x)),
            minimum,
            needs: needs.into_iter().flatten().collect::<Vec<_>>().join(", "),
            lines: lines(&listed.line(), constant, factor),
            ..Self::default()
        };
        row.weigh(score, study.request.target);
        Some(row)
    }

    /// Sets the score, and what follows from it.
    fn weigh(&mut self, score: CandidateScore, target: Target) {
        let goal = score.goal(target);
        (self.time, self.error) = match target {
            Target::Error(_) => (goal, if goal > 0.0 { (score.work / goal).sqrt() } else { 0.0 }),
            Target::Budget(budget) => (budget, goal.sqrt()),
        };
        let of_rays = score.works.iter().map(|work| match target {
            Target::Error(error) => work / (error * error),
            Target::Budget(budget) => (work / budget).sqrt(),
        });
        self.of_rays =
            of_rays.fold([f64::INFINITY, 0.0], |[low, high], x| [low.min(x), high.max(x)]);
        (self.goal, self.score) = (goal, score);
    }

    /// Returns the draws to the target error, or within the budget.
    pub fn draws(&self) -> f64 {
        if self.score.cost > 0.0 { (self.time / self.score.cost).ceil() } else { 1.0 }
    }

    /// Returns the draws until the sample variance, and so the estimated error, has a standard error of 10 %.
    pub fn trusted(&self) -> Option<f64> {
        self.score.kurtosis.map(|kurtosis| (kurtosis - 1.0).max(1.0) / (TRUST * TRUST))
    }

    /// Adds the costs to the target, or the errors, around the constant σ̂.
    pub fn draw(&mut self, study: &Study) {
        let Some(best) = self.constant else { return };
        let goal = study.goal(self.candidate, 1.0);
        let step = |i: i32| best * WIDTH.powf(f64::from(i) / f64::from(POINTS));
        let points = (-POINTS..=POINTS).map(|i| [step(i), goal.of(step(i))]);
        let points = points.filter(|[_, y]| *y < BEYOND);
        self.curve = match study.request.target {
            Target::Error(_) => points.collect(),
            Target::Budget(_) => points.map(|[x, y]| [x, y.sqrt()]).collect(),
        };
    }
}

/// Returns the lines for a case: σ̂, if it is one constant, and the list of estimators.
fn lines(line: &str, constant: Option<f64>, factor: Option<f64>) -> String {
    let constant = constant.map(|value| format!("sampling = {}\n", number(value)));
    let factor = factor.map(|factor| format!("sweep.sampling-scale = [{}]\n", number(factor)));
    format!("{}estimators = [{{ {line} }}]", constant.or(factor).unwrap_or_default())
}

/// Corrects the prices of rows by draws at their advised settings, unless prices are given.
pub fn correct(rows: &mut [Row], study: &mut Study, prices: &mut Prices) {
    let expected = |row: &Row| {
        let line = study.candidates[row.candidate].line();
        Some((line, (row.candidate, row.setting), study.prices[row.candidate]?))
    };
    // Every row has a price.
    let expected: Vec<Wanted> = rows.iter().filter_map(expected).collect();
    let result = prices.corrected(&study.cases[study.cases.len() / 2], &expected);
    for (row, price) in rows.iter_mut().zip(result).filter_map(|(row, price)| Some((row, price?))) {
        study.prices[row.candidate] = Some(price);
        if let Some(score) = study.score_of_all((row.candidate, row.setting)) {
            row.cost_error = price.error;
            row.weigh(score, study.request.target);
        }
    }
}

/// Sorts rows by group and goal, and marks ties.
pub fn rank(rows: &mut [Row]) {
    rows.sort_by(|a, b| a.group.cmp(&b.group).then(a.goal.total_cmp(&b.goal)));
    for group in rows.chunk_by_mut(|a, b| a.group == b.group) {
        let mut first = 0;
        for i in 0..group.len() {
            let both = group[i].cost_error + group[first].cost_error;
            let is_tie = i > 0 && group[i].goal <= group[first].goal * (1.0 + both.max(TIE));
            if is_tie {
                group[first].is_tie = true;
            } else {
                first = i;
            }
            (group[i].rank, group[i].is_tie) = (first + 1, is_tie);
        }
    }
}
