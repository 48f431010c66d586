//! A page of a catalogue, described by its own source file.

/// A page: a name and the source file that defines it.
#[derive(Debug, Clone, Copy)]
pub struct Page {
    /// The module's name, such as `residual_ratio`.
    pub module: &'static str,
    /// The text of the source file, or the page's text alone.
    pub source: &'static str,
}

/// The page of a module beside the caller.
#[macro_export]
macro_rules! page {
    ($module:ident) => {
        $crate::catalogue::Page {
            module: stringify!($module),
            source: include_str!(concat!(stringify!($module), ".rs")),
        }
    };
}

/// Text that draws a page's example from Rust, for the end of the page in rustdoc: `trueflight explain` leaves it out.
///
/// The code names the crate `trueflight`, where its one text is compiled as a test. The crates below cannot compile it, so
/// that pages are marked `#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]`.
#[macro_export]
macro_rules! draw_in_rust {
    () => {
        "`trueflight run case.toml` draws this case from a file, and this code draws it in a program:

```no_run
use trueflight::case::{Case, CaseText};

let case = Case::read(&CaseText::read(\"case.toml\".as_ref())?)?;
let draws = case.at(None)?.draws(0, 1, 1_000)?; // of the first estimator, with seed 1
println!(\"{:?} after {:?} lookups\", draws.values[0], draws.lookups); // of channel 0
# Ok::<(), Box<dyn std::error::Error>>(())
```"
    };
    (picture) => {
        "`trueflight render picture.toml` renders this picture from a file, and this code renders it in a program:

```no_run
use trueflight::render::Picture;

let picture = Picture::open(\"picture.toml\", &Default::default())?;
let record = picture.render(1, &|| {}); // with seed 1
println!(\"{:?}\", record.exposures[0].outcome);
# Ok::<(), Box<dyn std::error::Error>>(())
```"
    };
}

impl Page {
    /// The name in case files: `residual-ratio`.
    pub fn name(&self) -> String {
        self.module.replace('_', "-")
    }

    /// The page's text: the file's own documentation without the example at its end.
    pub fn text(&self) -> String {
        self.parts().0
    }

    /// A complete case or picture that uses the page: the block of TOML that ends the documentation, `None` without one.
    pub fn example(&self) -> Option<String> {
        self.parts().1
    }

    /// Text and example.
    fn parts(&self) -> (String, Option<String>) {
        let all = self.documentation();
        let blocks =
            all.trim_end().strip_suffix("\n```").and_then(|all| all.rsplit_once("```toml\n"));
        match blocks {
            Some((text, example)) if !example.contains("```") => {
                (text.trim_end().to_owned(), Some(format!("{example}\n")))
            }
            _ => (all, None),
        }
    }

    /// The leading `//!` lines of the file; a text without such lines is documentation itself.
    fn documentation(&self) -> String {
        if !self.source.starts_with("//!") {
            return self.source.to_owned();
        }
        let lines = self.source.lines().take_while(|line| line.starts_with("//!"));
        let text: Vec<&str> = lines
            .map(|line| line.trim_start_matches("//!"))
            .map(|line| line.strip_prefix(' ').unwrap_or(line))
            .collect();
        text.join("\n")
    }

    /// The first sentence of the documentation, on one line.
    pub fn summary(&self) -> String {
        let text = self.text();
        let first = text.split("\n\n").next().unwrap_or_default();
        first.replace('\n', " ").trim_end_matches('.').to_owned()
    }

    /// Domain in which an estimator is unbiased: the paragraph `Unbiased for: …` on one line, `None` without one.
    pub fn unbiased_for(&self) -> Option<String> {
        let text = self.text();
        let said =
            text.split("\n\n").find_map(|paragraph| paragraph.strip_prefix("Unbiased for: "))?;
        Some(said.replace('\n', " ").trim_end_matches('.').to_owned())
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_page_describes_itself() {
        let page = page!(settings);
        assert_eq!(page.name(), "settings");
        assert!(page.summary().starts_with("Settings as written"));
        let plain = super::Page { module: "haze", source: "Haze above a floor.\n\nThin." };
        assert_eq!(plain.summary(), "Haze above a floor");
        assert_eq!(plain.unbiased_for(), None);
        assert_eq!(plain.example(), None);
        let shown = super::Page { module: "x", source: "X.\n\n```toml\ntitle = \"x\"\n```\n" };
        assert_eq!((shown.text(), shown.example()), ("X.".into(), Some("title = \"x\"\n".into())));
        let thin = super::Page { module: "x", source: "X.\n\nUnbiased for: thin\nmedia.\n\nMore." };
        assert_eq!(thin.unbiased_for().as_deref(), Some("thin media"));
    }
}
