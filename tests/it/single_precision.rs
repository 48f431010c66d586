//! Single precision beside double: doubles find the truth, and single precision fails where it should.

use lab::stress::narrow::scene::StressScene;
use lab::stress::narrow::walks::FamilyEntry;
use lab::stress::narrow::{Along, BothPrecisions, FAMILIES, compare};

fn entries() -> impl Iterator<Item = &'static FamilyEntry> {
    FAMILIES.iter().flat_map(|family| family.entries)
}

fn at(entry: &FamilyEntry, [depth, collisions, from]: [f64; 3], budget: f64) -> BothPrecisions {
    let scene = StressScene { depth, collisions, from };
    compare(entry, &scene, (7, budget)).expect("a setup")
}

#[test]
fn doubles_find_the_mean_of_every_estimator() {
    for depth in [0.3, 4.0] {
        for entry in entries() {
            let found = at(entry, [depth, 9.0 * depth, 2.0], 1e5);
            let z = found.z.unwrap_or_else(|| panic!("{}: {found:?}", entry.name));
            assert!(z.abs() < 5.0, "{} at τ = {depth}: {z}", entry.name);
            assert!(found.bias.abs() < 1e-4 + 5.0 * found.error, "{}: {found:?}", entry.name);
        }
    }
}

#[test]
fn what_is_far_from_the_origin_fails_in_single_precision_and_what_is_near_does_not() {
    for entry in entries() {
        let near = at(entry, [2.0, 20.0, 0.0], 2e5);
        assert!(near.holds() || entry.varied != Along::ALL, "{}: {near:?}", entry.name);
        if ["ratio", "next-flight", "source-driven", "attenuation-driven"].contains(&entry.name) {
            let far = at(entry, [2.0, 20.0, 1e6], 2e5);
            assert!(far.exceeds(), "{}: {far:?}", entry.name);
        }
    }
}

#[test]
fn long_walks_fail_in_single_precision_and_short_ones_do_not() {
    let ratio = entries().find(|entry| entry.name == "ratio").expect("an estimator");
    let (short, long) = (at(ratio, [2.0, 10.0, 0.0], 2e4), at(ratio, [2.0, 1e6, 0.0], 1.0));
    assert!(short.bias.abs() < 1e-5, "{short:?}");
    assert!(long.bias.abs() > long.noise, "{long:?}");
}
