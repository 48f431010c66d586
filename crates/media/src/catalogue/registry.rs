//! Registry: a list of pages, each with the value that its module gives, such as the reader of its settings.

use super::{Page, Settings};

/// Pages of one kind, each with a value of type `T`. [`registry!`](crate::registry) lists them, one line a page.
///
/// A registry is a `static`. The functions that it points to are then compiled in its own crate; those of a `const` would be
/// compiled again in every crate that uses it, kernels included.
#[derive(Debug)]
pub struct Registry<T: 'static> {
    /// The pages, in the order of registration.
    pub pages: &'static [Page],
    /// Values of the pages, in the same order.
    pub values: &'static [T],
}

impl<T> Registry<T> {
    /// A registry of pages and as many values.
    pub const fn new<const N: usize>(pages: &'static [Page; N], values: &'static [T; N]) -> Self {
        Self { pages, values }
    }

    /// The pages, each with its value.
    pub fn entries<'a>(&self) -> impl Iterator<Item = (&'a Page, &'a T)> + use<'a, T> {
        let (pages, values): (&'a [Page], &'a [T]) = (self.pages, self.values);
        pages.iter().zip(values)
    }

    /// The names in case files.
    pub fn names(&self) -> Vec<String> {
        self.pages.iter().map(Page::name).collect()
    }

    /// Returns the value of the page with a name; `None` if no page has it.
    pub fn get(&self, name: &str) -> Option<&'static T> {
        self.entries().find(|(page, _)| page.name() == name).map(|(_, value)| value)
    }

    /// Reads `{ NAME = { … } }` by the value of the named page. Keys that are not read are mistakes.
    pub fn read<R>(
        &self,
        table: &Settings,
        read: impl FnOnce(&T, &Settings) -> Option<R>,
    ) -> Option<R> {
        let (index, settings) = table.choice(&self.names())?;
        self.read_page(index, &settings, read)
    }

    /// Reads the required `KEY.NAME = { … }` in the same way.
    pub fn read_key<R>(
        &self,
        settings: &Settings,
        key: &'static str,
        read: impl FnOnce(&T, &Settings) -> Option<R>,
    ) -> Option<R> {
        let (index, settings) = settings.chosen(key, &self.names())?;
        self.read_page(index, &settings, read)
    }

    fn read_page<R>(
        &self,
        index: usize,
        settings: &Settings,
        read: impl FnOnce(&T, &Settings) -> Option<R>,
    ) -> Option<R> {
        let value = read(&self.values[index], settings);
        settings.close();
        value
    }
}

/// Lists pages for a [`Registry`](crate::catalogue::Registry), one line a page, which names its module once. A line is
/// the path of the page's value, as in `registry![mean::CHECK, variance::CHECK]`, or of a type. A type `X` has the value
/// `Reader::of::<X>()` in `registry![Reader of constant::Constant, mean::Mean]`.
#[macro_export]
macro_rules! registry {
    ($Value:ident of $($module:ident :: $Type:ident),+ $(,)?) => {
        $crate::catalogue::Registry::new(
            &[$($crate::page!($module)),+],
            &[$($Value::of::<$module::$Type>()),+],
        )
    };
    ($($module:ident $(:: $item:ident)+),+ $(,)?) => {
        $crate::catalogue::Registry::new(
            &[$($crate::page!($module)),+],
            &[$($module $(:: $item)+),+],
        )
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{page, words};

    type Suggest = fn(&str, &[&str], &str) -> String;

    const TOOLS: Registry<Suggest> = registry![words::suggestion];

    #[test]
    fn a_page_has_the_value_of_its_module() {
        assert_eq!(TOOLS.names(), ["words"]);
        let suggest = TOOLS.get("words").expect("the page");
        assert_eq!(suggest("pgae", &["page"], "x"), "did you mean `page`? (x)");
        assert!(TOOLS.get("word").is_none());
    }

    struct Length(usize);

    impl Length {
        const fn of<T>() -> Self {
            Self(size_of::<T>())
        }
    }

    #[test]
    fn a_type_gives_the_value_of_its_page() {
        const SIZES: Registry<Length> = registry![Length of page::Page];
        assert_eq!(SIZES.get("page").map(|length| length.0), Some(size_of::<Page>()));
    }
}
