//! First steps of a newcomer: examples that pass, commands that decide, failures with their likely causes, progress.

mod causes;
mod console;
mod decides;
mod examples;

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use tempfile::TempDir;

/// A folder in which the command runs, without a terminal.
struct Place(TempDir);

impl Place {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = TempDir::new().expect("a folder");
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).expect("a file");
        }
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    /// Runs the command with these words; a word in single quotes may have spaces, as in a shell.
    fn run(&self, arguments: &str) -> Output {
        let mut command = Command::cargo_bin("trueflight").expect("the binary");
        command.current_dir(self.path()).env_remove("NO_COLOR").env_remove("GITHUB_ACTIONS");
        command.env("COLUMNS", "200").args(words(arguments)).output().expect("it runs")
    }

    /// Stdout of a command that must end with this exit code.
    fn says(&self, code: i32, arguments: &str) -> String {
        let output = self.run(arguments);
        let [out, err] = [&output.stdout, &output.stderr]
            .map(|text| String::from_utf8(text.clone()).expect("text"));
        assert_eq!(output.status.code(), Some(code), "{arguments}\n{out}{err}");
        out
    }
}

/// The words of a command line.
fn words(line: &str) -> Vec<String> {
    let parts = line.split('\'').enumerate();
    let mut words: Vec<String> = Vec::new();
    for (i, part) in parts {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// The commands that stand after a word in a text, without the program's name.
fn commands(text: &str, word: &str) -> Vec<String> {
    let after = text.lines().filter_map(|line| line.split_once(word)).map(|(_, command)| command);
    let own = after.filter_map(|command| command.trim().strip_prefix("trueflight "));
    own.map(str::to_owned).collect()
}
