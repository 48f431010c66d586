//! Folder with two cases, the results of an undisturbed run, and runs that are killed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;
use trueflight::draw::store::Log;
use trueflight::rng::hash;

/// Case with sums of the gate, distributions, bounds, channels, shared lookups, and an experiment that equals another.
pub const RAY: &str = "title = \"a ray\"
[problem.transmittance]
medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
span = [0, 4]
sampling.constant.value = 1.6
estimators = [{ woodcock = {} }, { ratio = {} }, { double = {} }, { next-flight = {} }, { regular = {} }]
";
pub const CURVE: &str = "title = \"a curve\"
[problem.transmittance]
medium.gaussian = { peak = 1.5, centre = 2, width = 0.7 }
span = [0, 4]
distances = 4
sampling.constant.value = 1.2
estimators = [{ double = {} }, { double.control.explorers.points = 9 }]
";

/// Words that ask for the same draws everywhere; they take about half a second.
const ASKED: &str = "run ray.toml curve.toml --seed 5 --draws 15e5 --alpha 1e-6";

pub struct Place {
    /// Path of the program.
    program: String,
    folder: TempDir,
    /// Files that an undisturbed run wrote.
    undisturbed: BTreeMap<String, String>,
    /// Duration of that run.
    pub time: Duration,
    /// Number of random numbers that were taken.
    taken: u64,
}

impl Place {
    pub fn new() -> Self {
        Self::with(env!("CARGO_BIN_EXE_trueflight"))
    }

    /// Makes a folder for another program.
    pub fn with(program: &str) -> Self {
        let program = program.to_owned();
        let folder = TempDir::new().expect("a folder");
        fs::write(folder.path().join("ray.toml"), RAY).expect("a case");
        fs::write(folder.path().join("curve.toml"), CURVE).expect("a case");
        let time = Duration::ZERO;
        let mut place = Self { program, folder, undisturbed: BTreeMap::new(), time, taken: 0 };
        let begin = Instant::now();
        let output = place.say(&format!("{ASKED} --out undisturbed"));
        place.time = begin.elapsed();
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        place.undisturbed = place.results("undisturbed");
        assert!(place.undisturbed.len() > 5, "{:?}", place.undisturbed.keys());
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        command
    }

    /// Runs the command to its end.
    pub fn say(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("it runs")
    }

    /// Begins the command; its output goes nowhere.
    pub fn begin(&self, arguments: &str) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it begins")
    }

    /// Returns the command of the undisturbed run with some more words.
    pub fn asked(more: &str) -> String {
        format!("{ASKED} {more}")
    }

    /// Returns a number below `limit`, another one each time, the same ones in every test.
    pub fn random(&mut self, limit: u64) -> u64 {
        self.taken += 1;
        hash(&self.taken.to_le_bytes()) % limit
    }

    /// Returns a random time within the first `share` of a run.
    pub fn moment(&mut self, share: f64) -> Duration {
        self.time.mul_f64(share * self.random(1 << 20) as f64 / f64::from(1 << 20))
    }

    /// Returns the difference of a folder from the results of the undisturbed run; `None` if they are equal.
    pub fn difference(&self, folder: &str) -> Option<String> {
        let found = self.results(folder);
        if self.path(folder).join("blocks.bin").exists()
            || self.path(folder).join("blocks.new").exists()
        {
            return Some("the file of blocks is left".into());
        }
        let names = self.undisturbed.keys().chain(found.keys());
        let mut differing = names.filter(|&name| found.get(name) != self.undisturbed.get(name));
        differing.next().map(|name| format!("{folder}/{name} differs"))
    }

    /// Returns all files of results, without times.
    fn results(&self, folder: &str) -> BTreeMap<String, String> {
        let mut files = BTreeMap::new();
        collect(&self.path(folder), "", &mut files);
        files
    }

    /// Starts a command that writes into a folder, and waits until it has kept some blocks; `None` if it has ended
    /// before.
    pub fn drawing(&self, arguments: &str, folder: &str) -> Option<Child> {
        let path = self.path(folder).join("blocks.bin");
        let mut run = self.begin(arguments);
        while run.try_wait().expect("a process").is_none() {
            if fs::metadata(&path).is_ok_and(|file| file.len() > 200_000) {
                return Some(run);
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        None
    }

    /// Returns a file of blocks of a run that was killed while it was drawing.
    pub fn journal(&self) -> Vec<u8> {
        let path = self.path("torn/blocks.bin");
        for _ in 0..20 {
            let _ = fs::remove_dir_all(self.path("torn"));
            let Some(mut run) = self.drawing(&Self::asked("--out torn"), "torn") else { continue };
            run.kill().expect("it can be killed");
            run.wait().expect("it has ended");
            if Log::open(&path).is_ok_and(|log| log.blocks(None) > 20) {
                return fs::read(path).expect("a journal");
            }
        }
        panic!("no run was killed while it was drawing");
    }
}

/// Returns the output of a command: stderr, then stdout.
pub fn said(output: &Output) -> String {
    let text = [&output.stderr[..], &output.stdout].concat();
    String::from_utf8(text).expect("text")
}

fn collect(folder: &Path, name: &str, files: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let entry = entry.expect("an entry");
        let name = format!("{name}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            collect(&entry.path(), &name, files);
        } else if name.contains("/.trueflight-") || has_ending(&name, "html") {
            // Skips files that a killed run was writing, which are never read, and the page, which is made of the
            // record and has times.
        } else if !has_ending(&name, "bin") && !has_ending(&name, "png") {
            let text = fs::read_to_string(entry.path()).expect("a text");
            files.insert(name.clone(), without_times(&name, &text));
        }
    }
}

fn has_ending(name: &str, ending: &str) -> bool {
    Path::new(name).extension().is_some_and(|found| found == ending)
}

/// Returns the results part of a record, or rows without the columns of times.
fn without_times(name: &str, text: &str) -> String {
    if name.ends_with("record.json") {
        return text.split("\"timing\"").next().unwrap_or_default().to_owned();
    }
    if !has_ending(name, "csv") {
        return text.to_owned();
    }
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    let is_timed = |column: usize| {
        rows.first()
            .is_some_and(|head| trueflight::report::run::fields::TIMED.contains(&&head[column]))
    };
    let kept = |row: &csv::StringRecord| -> Vec<String> {
        (0..row.len()).filter(|&i| !is_timed(i)).map(|i| row[i].to_owned()).collect()
    };
    rows.iter().map(|row| kept(row).join(",") + "\n").collect()
}
