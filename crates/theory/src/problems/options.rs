//! Options of problems: settings of a case that choose what a draw of its problem is.

use media::catalogue::{Settings, Value};

/// A setting that chooses the form of a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProblemOption {
    /// `distances`: a curve along the ray.
    Distances,
    /// `light`: a light that a camera sees through the medium.
    Light,
    /// `sensor`: light of each order of scattering at one end of the medium.
    Sensor,
    /// `albedos`: one albedo for each channel.
    Albedos,
    /// A list as `medium` or `volume`: one field for each channel.
    Media,
}

impl ProblemOption {
    /// Name of the option, which is its key in case files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Distances => "distances",
            Self::Light => "light",
            Self::Sensor => "sensor",
            Self::Albedos => "albedos",
            Self::Media => "media",
        }
    }

    /// The setting in words, as in "give `albedos`".
    pub fn words(self) -> &'static str {
        match self {
            Self::Distances => "`distances`",
            Self::Light => "a `light`",
            Self::Sensor => "a `sensor`",
            Self::Albedos => "`albedos`",
            Self::Media => "a list of several media",
        }
    }

    /// Returns whether the settings of a problem have the option.
    pub fn is_given(self, settings: &Settings) -> bool {
        let is_list = |key| {
            let entry = settings.entry(key);
            entry.is_some_and(|entry| matches!(entry.node.value, Value::Array(_)))
        };
        match self {
            Self::Media => is_list("medium") || is_list("volume"),
            other => settings.has(other.name()),
        }
    }
}

/// Returns whether a list of media is among some options.
pub(super) const fn has_media(options: &[ProblemOption]) -> bool {
    let mut index = 0;
    while index < options.len() {
        if matches!(options[index], ProblemOption::Media) {
            return true;
        }
        index += 1;
    }
    false
}

/// Options in words, as in "`albedos` and a list of several media".
pub fn listed(options: &[ProblemOption]) -> String {
    joined(options, ProblemOption::words).unwrap_or_else(|| "no options".to_owned())
}

/// Words of options with commas and an "and"; `None` without options.
pub(super) fn joined(
    options: &[ProblemOption],
    word: fn(ProblemOption) -> &'static str,
) -> Option<String> {
    let words: Vec<&str> = options.iter().map(|&option| word(option)).collect();
    let (last, others) = words.split_last()?;
    let and = if others.is_empty() { "" } else { " and " };
    Some(format!("{}{and}{last}", others.join(", ")))
}

/// Chooses among the forms of a problem, each given by its options: the form with all options of a case and the fewest
/// others. The case lacks the settings of the others. `None` after options that no form has together.
pub fn chosen(forms: &[&[ProblemOption]], settings: &Settings) -> Option<usize> {
    let mut given: Vec<ProblemOption> = Vec::new();
    for option in forms.iter().copied().flatten() {
        if !given.contains(option) && option.is_given(settings) {
            given.push(*option);
        }
    }
    let has_all = |form: &usize| given.iter().all(|option| forms[*form].contains(option));
    let actual = (0..forms.len()).filter(has_all).min_by_key(|&form| forms[form].len());
    if actual.is_none() {
        let possible: Vec<String> = forms[1..].iter().map(|form| listed(form)).collect();
        let message = format!("{} do not go together", listed(&given));
        let help = format!("give one of: {}", possible.join("; "));
        settings.fault_at(settings.span.clone(), "", message, help);
    }
    actual
}

#[cfg(test)]
mod tests {
    use super::ProblemOption::{Albedos, Light, Media, Sensor};
    use super::*;
    use media::catalogue::fixture::{list, read, table};

    #[test]
    fn a_case_has_the_form_with_the_fewest_options_that_has_all_of_its_own() {
        let forms: [&[ProblemOption]; 5] =
            [&[], &[Light], &[Albedos], &[Light, Albedos, Media], &[Sensor]];
        let (light, sensor) = (("light", table([])), ("sensor", table([])));
        let albedos = || ("albedos", list(&[0.5, 0.6]));
        let medium = || ("medium", list(&[1.0, 2.0]));
        let of = |settings: &Settings| chosen(&forms, settings);
        assert_eq!(read([("medium", table([]))], of), (Some(0), vec![]));
        assert_eq!(read([light.clone()], of), (Some(1), vec![]));
        assert_eq!(read([albedos()], of), (Some(2), vec![]));
        assert_eq!(read([albedos(), medium()], of), (Some(3), vec![]));
        assert_eq!(read([albedos(), light.clone()], of), (Some(3), vec![]));
        let wrong = "a `light` and a `sensor` do not go together".to_owned();
        assert_eq!(read([light, sensor], of), (None, vec![wrong]));
    }
}
