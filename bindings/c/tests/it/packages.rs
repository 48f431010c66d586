//! Build systems find the library: CMake beside its sources and where it is installed, pkg-config where it is
//! installed. Machines without these tools skip, and say so.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use crate::build::{command, here, libraries, said};

/// Returns a tool by the environment or its usual name, if it is installed.
fn tool(variable: &str, usual: &str) -> Option<String> {
    let name = std::env::var(variable).unwrap_or_else(|_| usual.to_owned());
    let is_there = Command::new(&name).arg("--version").output().is_ok_and(|o| o.status.success());
    if !is_there {
        println!("skipped: there is no {usual}");
    }
    is_there.then_some(name)
}

/// Runs a command that must succeed, and returns its output.
fn run<I: IntoIterator<Item = A>, A: AsRef<OsStr>>(
    program: impl AsRef<OsStr>,
    arguments: I,
) -> String {
    let mut command = command(program);
    let output = command.args(arguments).output().expect("it runs");
    let text = said(&output);
    assert!(output.status.success(), "{command:?}: {text}");
    text
}

/// Builds a project by CMake, and checks that its programs have the same output as elsewhere.
fn consume(cmake: &str, folder: &Path, more: &[String]) {
    let project = here().join("tests/programs/consumer");
    let place = folder.join("consumer");
    let mut arguments = vec![format!("-S{}", project.display()), format!("-B{}", place.display())];
    arguments.push(format!("-DEXAMPLES={}", here().join("examples").display()));
    arguments.extend_from_slice(more);
    run(cmake, arguments);
    run(cmake, ["--build".into(), place.display().to_string()]);
    assert!(run(place.join("analogue"), [""; 0]).starts_with("`analogue`: pass"));
    assert!(run(place.join("lambda"), [""; 0]).starts_with("`wrong`: fail"));
}

#[test]
fn cmake_finds_it_beside_its_sources() {
    let Some(cmake) = tool("CMAKE", "cmake") else { return };
    let folder = TempDir::new().expect("a folder");
    let sources = format!("-DTRUEFLIGHT_SOURCES={}", here().display());
    let built = format!("-DTRUEFLIGHT_LIBRARY_DIR={}", libraries().display());
    consume(&cmake, folder.path(), &[sources, built]);
}

#[test]
fn cmake_and_pkg_config_find_it_where_it_is_installed() {
    let Some(cmake) = tool("CMAKE", "cmake") else { return };
    for shared in ["OFF", "ON"] {
        let folder = TempDir::new().expect("a folder");
        let prefix = folder.path().join("prefix");
        let built = folder.path().join("build");
        run(
            &cmake,
            [
                format!("-S{}", here().display()),
                format!("-B{}", built.display()),
                format!("-DTRUEFLIGHT_LIBRARY_DIR={}", libraries().display()),
                format!("-DCMAKE_INSTALL_PREFIX={}", prefix.display()),
                "-DCMAKE_INSTALL_LIBDIR=lib".into(),
                format!("-DBUILD_SHARED_LIBS={shared}"),
            ],
        );
        run(&cmake, ["--install".into(), built.display().to_string()]);
        consume(&cmake, folder.path(), &[format!("-DCMAKE_PREFIX_PATH={}", prefix.display())]);
        by_pkg_config(&prefix);
    }
}

/// The template alone, as a packager without CMake would fill it in.
#[test]
fn pkg_config_finds_it_where_it_was_copied() {
    let folder = TempDir::new().expect("a folder");
    let prefix = folder.path();
    let lib = prefix.join("lib/pkgconfig");
    fs::create_dir_all(&lib).expect("a folder");
    fs::create_dir_all(prefix.join("include")).expect("a folder");
    fs::copy(here().join("include/trueflight.h"), prefix.join("include/trueflight.h"))
        .expect("a copy");
    for library in ["libtrueflight_c.a", "libtrueflight_c.so", "libtrueflight_c.dylib"] {
        let built = libraries().join(library);
        if built.exists() {
            fs::copy(built, prefix.join("lib").join(library)).expect("a copy");
        }
    }
    let template = fs::read_to_string(here().join("cmake/trueflight.pc.in")).expect("a template");
    let filled = template
        .replace("@CMAKE_INSTALL_PREFIX@", &prefix.display().to_string())
        .replace("@CMAKE_INSTALL_LIBDIR@", "lib")
        .replace("@CMAKE_INSTALL_INCLUDEDIR@", "include")
        .replace("@PROJECT_VERSION@", env!("CARGO_PKG_VERSION"));
    assert!(!filled.contains('@'), "{filled}");
    fs::write(lib.join("trueflight.pc"), filled).expect("written");
    by_pkg_config(prefix);
}

/// Compiles an example with the flags of pkg-config.
fn by_pkg_config(prefix: &Path) {
    let Some(pkg_config) = tool("PKG_CONFIG", "pkg-config") else { return };
    let mut command = Command::new(pkg_config);
    command.env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig"));
    let output = command.args(["--cflags", "--libs", "trueflight"]).output().expect("it runs");
    let flags = said(&output);
    assert!(output.status.success(), "{flags}");
    let program = prefix.join("program");
    let mut arguments = vec![here().join("examples/analogue.c").display().to_string()];
    arguments.extend(["-o".into(), program.display().to_string()]);
    arguments.extend(flags.split_whitespace().map(str::to_owned));
    arguments.push(format!("-Wl,-rpath,{}", prefix.join("lib").display()));
    arguments.push("-lm".into());
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    run(compiler, arguments);
    assert!(run(program, [""; 0]).starts_with("`analogue`: pass"));
}

#[test]
fn all_versions_are_one() {
    let version = env!("CARGO_PKG_VERSION");
    let project = fs::read_to_string(here().join("CMakeLists.txt")).expect("a project");
    assert!(project.contains(&format!("project(trueflight VERSION {version} ")));
    let root = fs::read_to_string(here().join("../../Cargo.toml")).expect("a manifest");
    assert!(root.contains(&format!("version = \"{version}\"")));
}
