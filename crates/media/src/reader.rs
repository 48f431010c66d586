//! Choice of a field by its name in a case file, and its reader.

use std::sync::{Arc, LazyLock};

use super::{CATALOGUE, Field, Layered, OpticalDepth, Profile, Stratified, Volume};
use crate::catalogue::{OwnPages, Settings};

/// Reads the fields of a page from a case file.
type Read<T> = Box<dyn Fn(&Settings) -> Option<Arc<T>> + Send + Sync>;

/// A field and its name in the catalogue.
type NamedField<T> = (String, Arc<T>);

/// Reader of the fields of a page: along a ray, in space, or both.
pub struct Reader {
    extinctions: &'static [&'static str],
    line: Option<Read<Profile>>,
    volume: Option<Read<Volume>>,
}

impl Reader {
    /// Reader without fields yet; `extinctions` are the settings to which σ_t is proportional, all together.
    pub fn new(extinctions: &'static [&'static str]) -> Self {
        Self { extinctions, line: None, volume: None }
    }

    /// Reader of a field of one coordinate: along a line, and as layers in space.
    pub fn layered<P: Stratified>() -> Self {
        Self::new(P::EXTINCTIONS).line(P::read).volume(Layered::<P>::read)
    }

    /// Adds the form along a line, `medium.NAME = { … }`.
    #[must_use]
    pub fn line<F: OpticalDepth + 'static>(
        self,
        read: impl Fn(&Settings) -> Option<F> + Send + Sync + 'static,
    ) -> Self {
        let read = move |settings: &Settings| read(settings).map(|f| Arc::new(f) as Arc<Profile>);
        Self { line: Some(Box::new(read)), ..self }
    }

    /// Adds the form in space, `volume.NAME = { … }`.
    #[must_use]
    pub fn volume<F: Field>(
        self,
        read: impl Fn(&Settings) -> Option<F> + Send + Sync + 'static,
    ) -> Self {
        let read = move |settings: &Settings| read(settings).map(|f| Arc::new(f) as Arc<Volume>);
        Self { volume: Some(Box::new(read)), ..self }
    }

    /// Adds another form in space beside the layers, for settings that `is_other` recognises. It has no `axis`; `help`
    /// says how layers are written.
    #[must_use]
    pub fn or_volume<F: Field>(
        self,
        is_other: impl Fn(&Settings) -> bool + Send + Sync + 'static,
        read: impl Fn(&Settings) -> Option<F> + Send + Sync + 'static,
        help: &'static str,
    ) -> Self {
        let layers = self.volume;
        let read = move |settings: &Settings| -> Option<Arc<Volume>> {
            if !is_other(settings) {
                return layers.as_ref()?(settings);
            }
            if settings.has("axis") {
                settings.fault("axis", "`axis` has no say here", help);
            }
            read(settings).map(|field| Arc::new(field) as Arc<Volume>)
        };
        Self { volume: Some(Box::new(read)), ..self }
    }
}

/// Readers of the built-in pages, in the order of the catalogue.
static READERS: LazyLock<Vec<Reader>> =
    LazyLock::new(|| CATALOGUE.values.iter().map(|reader| reader()).collect());

/// The pages of media, those of the program's own last.
fn pages(own_pages: &OwnPages) -> impl Iterator<Item = (String, &Reader)> {
    let built_in = CATALOGUE.pages.iter().zip(READERS.iter());
    built_in.chain(own_pages.of()).map(|(page, reader)| (page.name(), reader))
}

/// Settings of a named field to which σ_t is proportional; empty for an unknown field.
pub fn extinctions(name: &str, own_pages: &OwnPages) -> &'static [&'static str] {
    pages(own_pages).find(|(page, _)| page == name).map_or(&[], |(_, reader)| reader.extinctions)
}

/// Reads a field along a line: `medium.NAME = { … }`, or without a key `{ NAME = { … } }`. Returns its name in the
/// catalogue and the field.
pub(super) fn read_line(
    settings: &Settings,
    key: Option<&'static str>,
) -> Option<NamedField<Profile>> {
    let other = "this field has no 1-D form";
    let help = "write `volume` instead of `medium`, and give a `ray`";
    read(settings, key, |reader| reader.line.as_ref(), [other, help])
}

/// Reads a field in space, `KEY.NAME = { … }`, or without a key `{ NAME = { … } }`. Returns its name in the catalogue
/// and the field.
pub fn read_volume(settings: &Settings, key: Option<&'static str>) -> Option<NamedField<Volume>> {
    let other = "this field has no 3-D form";
    let help = "write `medium` instead of `volume`, and give a `span`";
    read(settings, key, |reader| reader.volume.as_ref(), [other, help])
}

/// Reads a list of fields in space, `volume = [{ NAME = { … } }, …]`, each with its name.
pub fn read_volumes(settings: &Settings) -> Option<Vec<NamedField<Volume>>> {
    let fields: Vec<_> =
        settings.tables("volume")?.iter().map(|table| read_volume(table, None)).collect();
    fields.into_iter().collect()
}

/// Reads a field of a form; pages without that form are explained.
fn read<T: ?Sized>(
    settings: &Settings,
    key: Option<&'static str>,
    form: fn(&Reader) -> Option<&Read<T>>,
    other: [&str; 2],
) -> Option<NamedField<T>> {
    let own_pages = settings.own_pages();
    let with_form = pages(own_pages).filter_map(|(name, reader)| Some((name, form(reader)?)));
    let (mut names, reads): (Vec<String>, Vec<&Read<T>>) = with_form.unzip();
    let explain = |name: &str| {
        pages(own_pages).any(|(page, _)| page == name).then(|| other.map(str::to_owned))
    };
    let (index, field) = match key {
        Some(key) => settings.chosen_explained(key, &names, &explain),
        None => settings.choice_explained(&names, &explain),
    }?;
    let read = reads[index](&field);
    field.close();
    Some((names.swap_remove(index), read?))
}
