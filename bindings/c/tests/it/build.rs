//! Compiles programs and runs them.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// Returns the folder of the crate.
pub fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the folder of `libtrueflight_c.a` and `.so`: Cargo puts them beside the tests.
pub fn libraries() -> PathBuf {
    let own = std::env::current_exe().expect("a path");
    let folder = own.parent().expect("a folder").to_owned();
    assert!(folder.join("libtrueflight_c.a").exists(), "no library in {}", folder.display());
    folder
}

/// Returns a compiler's name, from the environment as build tools read it.
fn compiler(source: &Path) -> String {
    let is_c = source.extension().is_some_and(|extension| extension == "c");
    let (variable, usual) = if is_c { ("CC", "cc") } else { ("CXX", "c++") };
    std::env::var(variable).unwrap_or_else(|_| usual.to_owned())
}

/// Library that a program is linked with.
#[derive(Clone, Copy)]
pub enum Link {
    Static,
    Shared,
}

/// Program, which is removed with its folder.
pub struct Program {
    folder: TempDir,
}

impl Program {
    /// Compiles a source of this crate, with warnings as errors and more arguments for the compiler.
    pub fn new(source: &str, link: Link, more: &[&str]) -> Self {
        let (folder, source) = (TempDir::new().expect("a folder"), here().join(source));
        let libraries = libraries();
        let mut command = Command::new(compiler(&source));
        let standard =
            if source.extension().is_some_and(|end| end == "c") { "c99" } else { "c++17" };
        command.arg(format!("-std={standard}"));
        command.args(["-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]).args(more);
        command.arg("-I").arg(here().join("include")).arg(&source);
        command.arg("-o").arg(folder.path().join("program"));
        match link {
            Link::Static => command.arg(libraries.join("libtrueflight_c.a")),
            Link::Shared => {
                command.arg("-L").arg(&libraries).arg("-ltrueflight_c");
                command.arg(format!("-Wl,-rpath,{}", libraries.display()))
            }
        };
        command.args(["-lpthread", "-ldl", "-lm"]);
        let output = command.output().expect("a C compiler");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", source.display());
        Self { folder }
    }

    /// Runs it; returns its exit code and its output on both channels.
    pub fn run(&self) -> (Option<i32>, String) {
        self.run_with(&[])
    }

    /// Runs it with arguments; returns its exit code and its output on both channels.
    pub fn run_with(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let mut command = command(self.folder.path().join("program"));
        let output = command.args(arguments).output().expect("it runs");
        (output.status.code(), said(&output))
    }
}

/// Returns a command with the library path of the linked libraries: Cargo's own path for tests has older ones.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.env_remove("LD_LIBRARY_PATH").env_remove("DYLD_FALLBACK_LIBRARY_PATH");
    command
}

/// Returns the output of a command on both channels.
pub fn said(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}
