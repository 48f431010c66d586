//! Faults, tried many times each: every resume and merge is identical to the undisturbed run, or refused.

use std::fs;

use trueflight::draw::store::{Header, Key, Log, entry};

use super::place::{Place, said};

/// Results of the tries of one fault.
#[derive(Default)]
pub struct Counts {
    /// Number of runs that ended as the undisturbed one.
    pub identical: usize,
    /// Messages of refused runs.
    pub refused: Vec<String>,
    /// Messages of runs that were neither.
    wrong: Vec<String>,
}

impl Counts {
    pub fn tried(&self) -> usize {
        self.identical + self.refused.len() + self.wrong.len()
    }

    /// Panics if any run is neither identical nor refused with a reason.
    pub fn hold(&self) {
        assert!(self.tried() > 0, "nothing was tried");
        crate::common::none(&self.wrong);
    }

    /// Counts a command that writes into a folder; `reason` is the expected message of a refusal.
    fn count(&mut self, place: &Place, command: &str, folder: &str, reason: &[&str]) {
        let output = place.say(command);
        let said = said(&output);
        let written = place.path(folder).join("record.json").exists();
        match (output.status.code(), place.difference(folder)) {
            (Some(0), None) => self.identical += 1,
            (Some(2), _) if !written && reason.iter().any(|word| said.contains(word)) => {
                self.refused.push(said);
            }
            (code, difference) => {
                self.wrong.push(format!("{command}: {code:?}, {difference:?}, {said}"));
            }
        }
    }
}

/// Kills runs repeatedly, and resumes each time until they are done.
pub fn kills(place: &mut Place, kills: usize) -> Counts {
    let (mut counts, mut killed) = (Counts::default(), 0);
    while killed < kills {
        let _ = fs::remove_dir_all(place.path("killed"));
        loop {
            let has_begun = place.path("killed/blocks.bin").exists();
            let command = if has_begun {
                "run --resume killed".to_owned()
            } else {
                Place::asked("--out killed")
            };
            let mut run = place.begin(&command);
            std::thread::sleep(place.moment(0.6));
            let is_done = run.try_wait().expect("a process").is_some();
            if !is_done {
                run.kill().expect("it can be killed");
                killed += 1;
            }
            let output = run.wait_with_output().expect("it has ended");
            // A kill may come after the results and before the end of the process.
            let is_over = is_done || place.path("killed/draws.bin").exists();
            if is_done && output.status.code() != Some(0) {
                counts.wrong.push(format!("{command}: {}", said(&output)));
            }
            if is_over || killed >= kills {
                break;
            }
        }
        if place.path("killed/blocks.bin").exists() {
            counts.count(place, "run --resume killed", "killed", &[]);
        } else if !place.path("killed/draws.bin").exists() {
            // The last kill came before anything was written.
            counts.count(place, &Place::asked("--out killed"), "killed", &[]);
        } else if let Some(difference) = place.difference("killed") {
            counts.wrong.push(difference);
        } else {
            counts.identical += 1;
        }
    }
    // A chain of kills has one result, which counts for all of its kills.
    counts.identical += killed.saturating_sub(counts.tried());
    counts
}

fn resume_with(place: &Place, counts: &mut Counts, bytes: &[u8], reason: &[&str]) {
    let _ = fs::remove_dir_all(place.path("spoilt"));
    fs::create_dir(place.path("spoilt")).expect("a folder");
    fs::write(place.path("spoilt/blocks.bin"), bytes).expect("a journal");
    counts.count(place, "run --resume spoilt", "spoilt", reason);
}

const FOREIGN: &[&str] = &["is no file of blocks"];

/// Cuts journals at a random byte.
pub fn cuts(place: &mut Place, tries: usize) -> Counts {
    let (mut counts, journal) = (Counts::default(), place.journal());
    for at in 0..tries {
        // Every fourth cut is in the header, or near it.
        let limit = if at % 4 == 0 { 600 } else { journal.len() };
        let length = place.random(limit as u64);
        #[allow(clippy::cast_possible_truncation)] // below the journal's length
        resume_with(place, &mut counts, &journal[..length as usize], FOREIGN);
    }
    counts
}

/// Flips one bit of journals.
pub fn flips(place: &mut Place, tries: usize) -> Counts {
    let (mut counts, journal) = (Counts::default(), place.journal());
    for at in 0..tries {
        let mut spoilt = journal.clone();
        let limit = if at % 4 == 0 { 600 } else { spoilt.len() };
        #[allow(clippy::cast_possible_truncation)] // below the journal's length
        let bit = place.random(8 * limit as u64) as usize;
        spoilt[bit / 8] ^= 1 << (bit % 8);
        resume_with(place, &mut counts, &spoilt, FOREIGN);
    }
    counts
}

/// Resumes from journals of other draws, and from files that are not journals.
pub fn strangers(place: &mut Place) -> Counts {
    let (mut counts, journal) = (Counts::default(), place.journal());
    for bytes in [&b""[..], b"trueflight", b"trueflight blocks 1\n", &[0; 4096]] {
        resume_with(place, &mut counts, bytes, FOREIGN);
    }
    // Blocks behind the header of other draws: they have other keys.
    let draws = "run ray.toml --draws 2e5 --out other --shard 1/1 --fresh";
    assert!(place.say(draws).status.success());
    let other = fs::read(place.path("other/blocks.bin")).expect("a share");
    let spliced = [&journal[..journal.len() / 2], &other[other.len() / 2..]].concat();
    resume_with(place, &mut counts, &spliced, FOREIGN);
    // The text of a case changes under an interrupted run.
    let ray = fs::read_to_string(place.path("ray.toml")).expect("a case");
    fs::write(place.path("ray.toml"), ray.replace("0.2, 1.5", "0.3, 1.5")).expect("a case");
    resume_with(place, &mut counts, &journal, &["the case ray had another text"]);
    fs::write(place.path("ray.toml"), ray).expect("a case");
    counts
}

/// Merges parts that are missing, doubled, unfinished, spoilt, or of another run; and, first, valid ones.
pub fn wrong_parts(place: &mut Place, tries: usize) -> Counts {
    let mut counts = Counts::default();
    let draw = |place: &Place, name: &str, more: &str| {
        let output = place.say(&Place::asked(&format!("--out {name} {more}")));
        assert!(output.status.success(), "{}", said(&output));
    };
    for part in 1..=3 {
        draw(place, &format!("part-{part}"), &format!("--shard {part}/3"));
    }
    draw(place, "fixed", "--shard 2/3 --fixed-draws");
    draw(place, "of-five", "--shard 2/5");
    draw(place, "doubled", "--shard 1/3 --threads 1");
    counts.count(place, "merge part-1 part-2 part-3 --out merged", "merged", &[]);
    counts.count(place, "merge part-3 doubled part-2 --out swapped", "swapped", &[]);
    let part = Log::open(&place.path("part-2/blocks.bin")).expect("a part");
    let header: Header = part.get(Key::Header).expect("readable").expect("a header");
    // Valid logs without blocks, one of another version.
    let version = "0.0.1".to_owned();
    for (name, header) in [("old", &Header { version, ..header.clone() }), ("empty", &header)] {
        fs::create_dir(place.path(name)).expect("a folder");
        let entries = [entry(Key::Header, header), entry(Key::End, &())];
        let path = place.path(name).join("blocks.bin");
        Log::write(&path, entries).expect("written");
    }
    let whole = fs::read(place.path("part-2/blocks.bin")).expect("a part");
    fs::create_dir_all(place.path("spoilt")).expect("a folder");
    let wrong = [
        ("part-1 part-2", "missing: 3/3"),
        ("part-2", "missing: 1/3, 3/3"),
        ("part-1 part-1 part-2 part-3", "are both part 1/3"),
        ("part-1 doubled part-2 part-3", "are both part 1/3"),
        ("part-1 fixed part-3", "drawn with --fixed-draws"),
        ("part-1 of-five part-3", "of-five is part 2/5, part-1 one of 3"),
        ("part-1 old part-3", "drawn by version 0.0.1"),
        ("part-1 empty part-3", "has other blocks"),
        ("part-1 nowhere part-3", "nowhere is no part"),
    ];
    for (parts, reason) in wrong {
        let _ = fs::remove_dir_all(place.path("wrong"));
        counts.count(place, &format!("merge {parts} --out wrong"), "wrong", &[reason]);
    }
    let journal = place.journal();
    try_spoilt(place, &mut counts, &journal, &["is an interrupted run, not a part"]);
    for _ in 0..(tries.saturating_sub(wrong.len() + 1) / 2).max(1) {
        #[allow(clippy::cast_possible_truncation)] // below the part's length
        let mut random = || place.random(whole.len() as u64) as usize;
        let (end, at) = (random(), random());
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        let torn = ["is torn or damaged at byte", "is not finished", FOREIGN[0]];
        try_spoilt(place, &mut counts, &whole[..end], &torn);
        try_spoilt(place, &mut counts, &flipped, &torn);
    }
    // A truncated part is resumed, and then merges.
    try_spoilt(place, &mut counts, &whole[..whole.len() / 2], &["is torn or damaged at byte"]);
    let output = place.say("run --resume spoilt");
    assert!(output.status.success(), "{}", said(&output));
    let spoilt = Log::open(&place.path("spoilt/blocks.bin")).expect("a part");
    assert_eq!(spoilt.blocks(None), part.blocks(None));
    counts.count(place, "merge part-1 spoilt part-3 --out mended", "mended", &[]);
    counts
}

fn try_spoilt(place: &Place, counts: &mut Counts, bytes: &[u8], reason: &[&str]) {
    let _ = fs::remove_dir_all(place.path("wrong"));
    fs::write(place.path("spoilt/blocks.bin"), bytes).expect("a part");
    let merge = "merge part-1 spoilt part-3 --out wrong";
    counts.count(place, merge, "wrong", reason);
}
