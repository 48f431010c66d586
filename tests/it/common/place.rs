//! Folder in which the command runs, and its output there.

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use tempfile::TempDir;

/// Folder in which the command runs, without a terminal.
pub struct Place(TempDir);

impl Place {
    /// Makes a folder with files, each given by its path in it and its text.
    pub fn new(files: &[(&str, &str)]) -> Self {
        let place = Self(TempDir::new().expect("a folder"));
        for (name, text) in files {
            let path = place.path().join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, text).expect("a file");
        }
        place
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Returns the command with these words; a word in single quotes may have spaces, as in a shell.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::cargo_bin("trueflight").expect("the binary");
        command.current_dir(self.path()).env("COLUMNS", "200").args(words(arguments));
        for name in ["NO_COLOR", "GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY"] {
            command.env_remove(name);
        }
        command
    }

    pub fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("it runs")
    }

    /// Returns stdout of a command that must end with this exit code.
    pub fn says(&self, expected: i32, arguments: &str) -> String {
        let output = self.run(arguments);
        assert_eq!(code(&output), expected, "{arguments}\n{}", said(&output));
        stdout(&output)
    }
}

/// Splits a command line into words.
fn words(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for (i, part) in line.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

pub fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// Returns stdout and stderr, one after the other.
pub fn said(output: &Output) -> String {
    stdout(output) + &stderr(output)
}

pub fn assert_says(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no \"{word}\" in:\n{text}");
    }
}
