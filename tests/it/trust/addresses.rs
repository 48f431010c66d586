//! Addresses in documents: hosts are on a list, and no text installs Trueflight from a place that does not have it.

use super::files;
use crate::common::none;

/// Hosts that exist and that documents, licences or formats name.
const HOSTS: [&str; 11] = [
    "arxiv.org",
    "doi.org",
    "docs.rs",
    "mitsuba.readthedocs.io",
    "numpy.org",
    "pbrt.org",
    "rustup.rs",
    "www.apache.org",
    "www.mitsuba-renderer.org",
    "www.openvdb.org",
    "www.w3.org",
];

/// Texts that install or fetch Trueflight from a registry or a repository.
const INVENTED: [&str; 10] = [
    "github.com/trueflight",
    "gitlab.com/trueflight",
    "crates.io/crates/trueflight",
    "docs.rs/trueflight",
    "pypi.org/project/trueflight",
    "cargo add trueflight",
    "cargo install trueflight",
    "pip install trueflight",
    "install --git",
    "trueflight = { version",
];

/// Returns whether a file has addresses of other projects: lock files, which name registries, and pictures.
fn is_left_out(path: &str) -> bool {
    let endings = [".lock", ".png", ".vdb", ".npy", ".exr", ".pfm", ".vol", ".ttf", ".f64"];
    endings.iter().any(|ending| path.ends_with(ending)) || path.ends_with("trust/addresses.rs")
}

#[test]
fn no_address_is_invented() {
    let (mut wrong, mut read) = (Vec::new(), 0);
    for path in files(".") {
        let name = path.to_string_lossy().into_owned();
        let Ok(text) = std::fs::read_to_string(super::root().join(&path)) else { continue };
        if is_left_out(&name) {
            continue;
        }
        read += 1;
        for (number, line) in text.lines().enumerate() {
            let place = format!("{name}:{}", number + 1);
            let invented = INVENTED.iter().filter(|word| line.contains(**word));
            wrong.extend(invented.map(|word| format!("{place}: {word}")));
            for rest in line.split("http").skip(1) {
                let rest = rest.strip_prefix('s').unwrap_or(rest);
                let Some(address) = rest.strip_prefix("://") else { continue };
                let host = address
                    .split(|c: char| !(c.is_ascii_alphanumeric() || ".-".contains(c)))
                    .next();
                let host = host.unwrap_or_default().trim_end_matches('.');
                if !HOSTS.contains(&host) && !host.is_empty() {
                    wrong.push(format!("{place}: {host}"));
                }
            }
            wrong.extend(mail(line).map(|mail| format!("{place}: {mail}")));
        }
    }
    none(&wrong);
    assert!(read > 400, "only {read} files were read");
}

/// Returns the addresses of e-mails in a line: letters, an @, and a name with a dot.
fn mail(line: &str) -> impl Iterator<Item = String> + '_ {
    let words = line.split(|c: char| !(c.is_ascii_alphanumeric() || "@.-_+".contains(c)));
    let is_mail = |word: &&str| {
        let Some((before, after)) = word.split_once('@') else { return false };
        let domain = after.split('.').collect::<Vec<_>>();
        let letters = |part: &&str| part.chars().all(|c| c.is_ascii_lowercase()) && part.len() > 1;
        !before.is_empty() && domain.len() > 1 && domain.iter().all(letters)
    };
    words.filter(is_mail).map(str::to_owned)
}

#[test]
fn an_address_is_recognised() {
    let found = |line: &str| mail(line).collect::<Vec<_>>();
    assert_eq!(found("write to someone@example.com, please"), ["someone@example.com"]);
    assert!(found("uses: actions/checkout@v4, 3 @ 4.5, a @noindent").is_empty());
}
