//! Every setting of a rod is read, and each mistake is told.

#[test]
fn every_setting_is_checked() {
    let rod = |line: &str| {
        let text = format!(
            "title = \"a rod\"\n[problem.rod]\nmedium.constant.extinction = 1\nspan = [0, 1]\n{line}
            sampling.constant.value = 2\nestimators = [{{ analog = {{}} }}]"
        );
        crate::common::mistakes(&text).map(|error| error.render(false))
    };
    assert_eq!(rod("albedo = 0.5\nforward = 0.2\nabsorbed = true\norders = 2"), None);
    for (line, expected) in [
        ("", "`albedo` is missing"),
        ("albedo = 1.5", "`albedo` is 1.5"),
        ("albedo = 0.5\nforward = -1", "`forward` is -1"),
        ("albedo = 0.5\norders = 7", "`orders` is 7"),
        ("albedo = 0.5\nflux = 5", "`flux` is 5"),
        ("albedo = 0.5\nabsorbed = 1", "`absorbed` is 1"),
        ("albedo = 0.5\ncontrol.mean = {}", "no estimator of this case takes a control"),
        ("albedo = 0.5\nsweep.control.values = [1]", "no estimator of this case takes a control"),
        ("albedo.piecewise-linear = { knots = [0, 1], values = [0.5, 1.1] }", "exceeds 1"),
        ("albedo.gaussian = {}", "`gaussian` is not known"),
    ] {
        let found = rod(line).unwrap_or_else(|| panic!("{line} is accepted"));
        assert!(found.contains(expected), "{line}: {found}");
    }
}
