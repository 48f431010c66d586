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

impl Page {
    /// The name in case files: `residual-ratio`.
    pub fn name(&self) -> String {
        self.module.replace('_', "-")
    }

    /// The file's own documentation: its leading `//!` lines; a text without such lines is documentation itself.
    pub fn text(&self) -> String {
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
        let thin = super::Page { module: "x", source: "X.\n\nUnbiased for: thin\nmedia.\n\nMore." };
        assert_eq!(thin.unbiased_for().as_deref(), Some("thin media"));
    }
}
