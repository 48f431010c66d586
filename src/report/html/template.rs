//! Templates of HTML and SVG in the syntax of the crate maud. Its procedural macro takes longer to compile than all
//! templates.
//!
//! [`html!`](crate::html!) escapes every value, in text and in attributes. Only [`Markup`] is not escaped again, and markup
//! from a string is made by [`Markup::raw`] alone, which takes nothing but texts of the program.

use std::fmt::{self, Display, Write};

pub use crate::html;

/// HTML, or a part of it, in which all text is escaped.
#[derive(Debug, Clone, Default)]
pub struct Markup(String);

impl Markup {
    /// Returns a text of the program, which is HTML already.
    pub fn raw(html: &'static str) -> Self {
        Self(html.to_owned())
    }

    /// Returns the text.
    pub fn into_string(self) -> String {
        self.0
    }

    /// Adds a text of the program, which is HTML already.
    pub fn mark(&mut self, html: &'static str) {
        self.0.push_str(html);
    }

    /// Adds a value.
    pub fn put<T: Show + ?Sized>(&mut self, value: &T) {
        value.show(self);
    }
}

/// Value that a template shows.
pub trait Show {
    /// Adds the value to a page.
    fn show(&self, page: &mut Markup);
}

impl Show for Markup {
    fn show(&self, page: &mut Markup) {
        page.0.push_str(&self.0);
    }
}

impl Show for &Markup {
    fn show(&self, page: &mut Markup) {
        page.0.push_str(&self.0);
    }
}

impl<T: Display + ?Sized> Show for T {
    fn show(&self, page: &mut Markup) {
        // Writing to a string cannot fail.
        let _ = write!(Escaped(&mut page.0), "{self}");
    }
}

/// Adds text without characters that begin markup or end an attribute.
struct Escaped<'a>(&'a mut String);

impl fmt::Write for Escaped<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for part in text.split_inclusive(['&', '<', '>', '"']) {
            let sign = match part.as_bytes().last() {
                Some(b'&') => "&amp;",
                Some(b'<') => "&lt;",
                Some(b'>') => "&gt;",
                Some(b'"') => "&quot;",
                _ => {
                    self.0.push_str(part);
                    continue;
                }
            };
            self.0.push_str(&part[..part.len() - 1]);
            self.0.push_str(sign);
        }
        Ok(())
    }
}

/// Returns the [`Markup`](crate::report::html::template::Markup) of a template.
///
/// `name.class.other[condition] #id attribute="text" other=(value) third=[option] fourth={ "text" (value) } fifth { … }`
/// is an element, with `;` instead of the braces one that has no end. Inside are elements, `"text"`, `(value)`,
/// `@if … { … } @else { … }`, `@for … in … { … }` and `@let … = …;`. Conditions and loops have no braces before their own,
/// so values of blocks and structures need a name.
#[macro_export]
macro_rules! html {
    ($($template:tt)*) => {{
        #[allow(unused_mut, reason = "a template may be empty")]
        let mut page = $crate::report::html::template::Markup::default();
        $crate::html_nodes! { page; $($template)* }
        page
    }};
}

/// Adds the nodes of a template to a page: the first one, then by itself the rest.
#[doc(hidden)]
#[macro_export]
macro_rules! html_nodes {
    ($page:ident;) => {};

    // Text, values and control.
    ($page:ident; $text:literal $($rest:tt)*) => {
        $page.put($text);
        $crate::html_nodes! { $page; $($rest)* }
    };
    ($page:ident; ($value:expr) $($rest:tt)*) => {
        $page.put(&$value);
        $crate::html_nodes! { $page; $($rest)* }
    };
    ($page:ident; @let $name:pat = $value:expr; $($rest:tt)*) => {
        let $name = $value;
        $crate::html_nodes! { $page; $($rest)* }
    };
    ($page:ident; @for $item:pat in $($rest:tt)*) => {
        $crate::html_nodes! { @block $page [for $item in] $($rest)* }
    };
    ($page:ident; @if $($rest:tt)*) => {
        $crate::html_nodes! { @block $page [if] $($rest)* }
    };
    (@block $page:ident [$($head:tt)*] { $($body:tt)* } @else if $($rest:tt)*) => {
        $crate::html_nodes! {
            @block $page [$($head)* { $crate::html_nodes! { $page; $($body)* } } else if] $($rest)*
        }
    };
    (@block $page:ident [$($head:tt)*] { $($body:tt)* } @else { $($other:tt)* } $($rest:tt)*) => {
        $($head)* {
            $crate::html_nodes! { $page; $($body)* }
        } else {
            $crate::html_nodes! { $page; $($other)* }
        }
        $crate::html_nodes! { $page; $($rest)* }
    };
    (@block $page:ident [$($head:tt)*] { $($body:tt)* } $($rest:tt)*) => {
        $($head)* {
            $crate::html_nodes! { $page; $($body)* }
        }
        $crate::html_nodes! { $page; $($rest)* }
    };
    (@block $page:ident [$($head:tt)*] $next:tt $($rest:tt)*) => {
        $crate::html_nodes! { @block $page [$($head)* $next] $($rest)* }
    };

    // Elements: classes, the anchor, attributes, content.
    ($page:ident; $name:ident . $class:ident $($rest:tt)*) => {
        $page.mark(concat!("<", stringify!($name), " class=\"", stringify!($class)));
        $crate::html_nodes! { @class $page $name $($rest)* }
    };
    ($page:ident; $name:ident $($rest:tt)*) => {
        $page.mark(concat!("<", stringify!($name)));
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
    (@class $page:ident $name:ident . $class:ident [$is_on:expr] $($rest:tt)*) => {
        if $is_on {
            $page.mark(concat!(" ", stringify!($class)));
        }
        $crate::html_nodes! { @class $page $name $($rest)* }
    };
    (@class $page:ident $name:ident . $class:ident $($rest:tt)*) => {
        $page.mark(concat!(" ", stringify!($class)));
        $crate::html_nodes! { @class $page $name $($rest)* }
    };
    (@class $page:ident $name:ident $($rest:tt)*) => {
        $page.mark("\"");
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
    (@within $page:ident $name:ident { $($body:tt)* } $($rest:tt)*) => {
        $page.mark(">");
        { $crate::html_nodes! { $page; $($body)* } }
        $page.mark(concat!("</", stringify!($name), ">"));
        $crate::html_nodes! { $page; $($rest)* }
    };
    (@within $page:ident $name:ident ; $($rest:tt)*) => {
        $page.mark(">");
        $crate::html_nodes! { $page; $($rest)* }
    };
    (@within $page:ident $name:ident # $id:ident $($rest:tt)*) => {
        $page.mark(concat!(" id=\"", stringify!($id), "\""));
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
    (@within $page:ident $name:ident # $id:tt $($rest:tt)*) => {
        $crate::html_nodes! { @within $page $name id=$id $($rest)* }
    };
    (@within $page:ident $name:ident $key:ident $(- $part:ident)* = [$value:expr] $($rest:tt)*) => {
        if let Some(value) = $value {
            $page.mark(concat!(" ", stringify!($key) $(, "-", stringify!($part))*, "=\""));
            $page.put(&value);
            $page.mark("\"");
        }
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
    (@within $page:ident $name:ident $key:ident $(- $part:ident)* = { $($value:tt)* } $($rest:tt)*) => {
        $page.mark(concat!(" ", stringify!($key) $(, "-", stringify!($part))*, "=\""));
        { $crate::html_nodes! { $page; $($value)* } }
        $page.mark("\"");
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
    (@within $page:ident $name:ident $key:ident $(- $part:ident)* = $value:tt $($rest:tt)*) => {
        $crate::html_nodes! { @within $page $name $key $(- $part)* = { $value } $($rest)* }
    };
    (@within $page:ident $name:ident $key:ident $($rest:tt)*) => {
        $page.mark(concat!(" ", stringify!($key)));
        $crate::html_nodes! { @within $page $name $($rest)* }
    };
}

#[cfg(test)]
mod tests {
    #[test]
    fn values_and_texts_cannot_become_markup() {
        let odd = "<b class=\"x\">&amp;'";
        let page = html! { p title=(odd) data-text={ "a<" (odd) } { (odd) "a & b" (html! { i { (odd) } }) } };
        let escaped = "&lt;b class=&quot;x&quot;&gt;&amp;amp;'";
        let expected = format!(
            "<p title=\"{escaped}\" data-text=\"a&lt;{escaped}\">{escaped}a &amp; b<i>{escaped}</i></p>"
        );
        assert_eq!(page.into_string(), expected);
    }

    #[test]
    fn an_element_has_classes_an_anchor_and_attributes() {
        let [on, off] = [true, false];
        let page = html! {
            br;
            h2.a.b[on].c[off] #top {}
            td #(1 + 1) aria-hidden="true" use-of-it=[Some(2)] type=[None::<u8>] hidden {}
            p #{ "p-" (3) } {}
            input name="text" required;
        };
        let expected = "<br><h2 class=\"a b\" id=\"top\"></h2>\
                        <td id=\"2\" aria-hidden=\"true\" use-of-it=\"2\" hidden></td>\
                        <p id=\"p-3\"></p><input name=\"text\" required>";
        assert_eq!(page.into_string(), expected);
    }

    #[test]
    fn conditions_and_loops_choose_nodes() {
        let of = |number: u32, last: Option<&str>| {
            let page = html! {
                @for i in 0..number {
                    @let twice = 2 * i;
                    @if twice == 0 { "zero" } @else if twice == 2 { b { "two" } } @else { (twice) }
                    " "
                }
                @if let Some(last) = last { (last) }
                "."
            };
            page.into_string()
        };
        assert_eq!(of(3, Some("end")), "zero <b>two</b> 4 end.");
        assert_eq!(of(0, None), ".");
    }
}
