//! The header equals the output of cbindgen.

use std::fs;
use std::path::Path;

#[test]
fn the_header_is_that_of_the_sources() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut made = Vec::new();
    let config = cbindgen::Config::from_file(here.join("cbindgen.toml")).expect("a configuration");
    let builder = cbindgen::Builder::new().with_config(config);
    let sources = ["status", "random", "handle", "claim", "draws", "verdict"];
    let builder = sources
        .iter()
        .fold(builder, |builder, name| builder.with_src(here.join(format!("src/{name}.rs"))));
    builder.generate().expect("a header").write(&mut made);
    let made = String::from_utf8(made).expect("UTF-8");
    let place = here.join("include/trueflight.h");
    if std::env::var_os("UPDATE_HEADER").is_some() {
        fs::write(&place, &made).expect("written");
    }
    let kept = fs::read_to_string(place).expect("a header");
    assert!(
        kept == made,
        "UPDATE_HEADER=1 cargo test -p trueflight-c header writes the header anew"
    );
}
