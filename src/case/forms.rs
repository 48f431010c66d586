//! Forms of problems: the type of draws that a case's options ask for, and messages about names that a form does not
//! have.

use std::cell::RefCell;
use std::path::Path;

use estimators::FormCatalogue;
use media::catalogue::{Entry, Settings};
use theory::problems::ProblemOption;
use theory::problems::options::{chosen, listed};

/// Explains the name of an estimator that another form of a problem has: message and cure. `own` are the options of the
/// case's form.
pub fn explain_estimator(problem: &str, own: &[ProblemOption], name: &str) -> Option<[String; 2]> {
    let forms = estimators::catalogues().into_iter().filter(|form| form.problem == problem);
    let has_name = |form: &FormCatalogue| form.pages.iter().any(|page| page.name() == name);
    let forms: Vec<_> = forms.filter(has_name).collect();
    let cure = |form: &FormCatalogue| {
        let without = |from: &[ProblemOption], others: &[ProblemOption]| -> Vec<ProblemOption> {
            from.iter().filter(|option| !others.contains(option)).copied().collect()
        };
        let (missing, surplus) = (without(form.options, own), without(own, form.options));
        match (missing.as_slice(), surplus.as_slice()) {
            (missing, []) => format!("give {}", listed(missing)),
            ([], surplus) => format!("leave {} out", listed(surplus)),
            (missing, surplus) => {
                format!("give {} and leave {} out", listed(missing), listed(surplus))
            }
        }
    };
    let needs: Vec<String> = forms.iter().map(|form| needed(form.options)).collect();
    let cures: Vec<String> = forms.iter().map(cure).collect();
    let message = format!("`{name}` needs {}", needs.join(", or "));
    (!forms.is_empty()).then(|| [message, cures.join("; or ")])
}

/// Returns the requirement of a form on a case, in words.
fn needed(options: &[ProblemOption]) -> String {
    use ProblemOption::{Albedos, Light, Media};
    match options {
        [] => "a case without options".to_owned(),
        [Albedos | Media] | [Albedos, Media] => "several channels".to_owned(),
        [Light, Albedos, Media] => "several channels and a `light`".to_owned(),
        others => listed(others),
    }
}

/// Returns the form that a problem's settings ask for; `None` where no form has all options.
pub fn chosen_form(problem: &str, settings: &[Entry]) -> Option<FormCatalogue> {
    let faults = RefCell::default();
    let settings = Settings::new(settings, Path::new(""), &faults);
    let forms = estimators::catalogues().into_iter().filter(|form| form.problem == problem);
    let mut forms: Vec<_> = forms.collect();
    let options: Vec<_> = forms.iter().map(|form| form.options).collect();
    Some(forms.swap_remove(chosen(&options, &settings)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimator_of_another_form_says_what_it_needs() {
        let says = |own: &[ProblemOption], name: &str| explain_estimator("rod", own, name);
        let text = |[message, help]: [&str; 2]| Some([message.to_owned(), help.to_owned()]);
        assert_eq!(says(&[], "hero"), text(["`hero` needs several channels", "give `albedos`"]));
        assert_eq!(
            says(&[ProblemOption::Light], "terminating"),
            text(["`terminating` needs a case without options", "leave a `light` out"])
        );
        assert_eq!(
            says(&[], "full-mis"),
            text([
                "`full-mis` needs a `light`, or a `sensor`",
                "give a `light`; or give a `sensor`"
            ])
        );
        assert_eq!(says(&[], "no-such"), None);
    }
}
