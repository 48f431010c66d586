//! Choice of a field by its name in a case file, and its reader.

use std::sync::Arc;

use super::{CATALOGUE, Field, Layered, OpticalDepth, Profile, READERS, Stratified, Volume};
use crate::catalogue::{OwnPages, Settings};

/// Reads the fields of a page from a case file.
type Read<T> = Box<dyn Fn(&Settings) -> Option<Arc<T>> + Send + Sync>;

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
}

/// The pages of media, those of the program's own last, each with its name.
fn readers<'a>(settings: &Settings<'a>) -> (Vec<String>, Vec<&'a Reader>) {
    let built_in = CATALOGUE.pages.iter().zip(READERS.iter());
    built_in.chain(settings.own_pages().of()).map(|(page, reader)| (page.name(), reader)).unzip()
}

/// Settings of a named field to which σ_t is proportional; empty for an unknown field.
pub fn extinctions(name: &str, own_pages: &OwnPages) -> &'static [&'static str] {
    let built_in = CATALOGUE.pages.iter().zip(READERS.iter());
    let mut all = built_in.chain(own_pages.of());
    all.find(|(page, _)| page.name() == name).map_or(&[], |(_, reader)| reader.extinctions)
}

/// Reads a field along a line, `medium.NAME = { … }`: its name in the catalogue and the field.
pub(super) fn read_line(settings: &Settings) -> Option<(String, Arc<Profile>)> {
    choose_line(settings, |settings, names, offered| {
        settings.chosen_among("medium", names, offered)
    })
}

/// Reads a field along a line; `choose` selects it among the names, some of which are suggested.
pub(super) fn choose_line<'a>(
    settings: &Settings<'a>,
    choose: impl FnOnce(&Settings<'a>, &[String], &[String]) -> Option<(usize, Settings<'a>)>,
) -> Option<(String, Arc<Profile>)> {
    let (mut names, readers) = readers(settings);
    let offered = names.iter().zip(&readers).filter(|(_, reader)| reader.line.is_some());
    let offered: Vec<String> = offered.map(|(name, _)| name.clone()).collect();
    let (index, field) = choose(settings, &names, &offered)?;
    let Some(read) = &readers[index].line else {
        let help = "write `volume` instead of `medium`, and give a `ray`";
        field.fault_at(field.span.clone(), "", "this field has no 1-D form", help);
        return None;
    };
    let profile = read(&field);
    field.close();
    Some((names.swap_remove(index), profile?))
}

/// Reads a field in space, `volume.NAME = { … }`: its name in the catalogue and the field.
pub fn read_volume(settings: &Settings) -> Option<(String, Arc<Volume>)> {
    read_field(settings, "volume")
}

/// Reads a list of fields in space, `volume = [{ NAME = { … } }, …]`, each with its name.
pub fn read_volumes(settings: &Settings) -> Option<Vec<(String, Arc<Volume>)>> {
    let fields: Vec<_> = settings.tables("volume")?.iter().map(read_listed).collect();
    fields.into_iter().collect()
}

/// Reads a field in space of a list.
pub(super) fn read_listed(table: &Settings) -> Option<(String, Arc<Volume>)> {
    choose_volume(table, Settings::choice)
}

/// Reads a field in space, `KEY.NAME = { … }`.
pub fn read_field(settings: &Settings, key: &'static str) -> Option<(String, Arc<Volume>)> {
    choose_volume(settings, |settings, names| settings.chosen(key, names))
}

/// Reads a field in space; `choose` selects it among the names.
fn choose_volume<'a>(
    settings: &Settings<'a>,
    choose: impl FnOnce(&Settings<'a>, &[String]) -> Option<(usize, Settings<'a>)>,
) -> Option<(String, Arc<Volume>)> {
    let (mut names, readers) = readers(settings);
    let (index, field) = choose(settings, &names)?;
    let Some(read) = &readers[index].volume else {
        let help = "write `medium` instead of `volume`, and give a `span`";
        field.fault_at(field.span.clone(), "", "this field has no 3-D form", help);
        return None;
    };
    let volume = read(&field);
    field.close();
    Some((names.swap_remove(index), volume?))
}
