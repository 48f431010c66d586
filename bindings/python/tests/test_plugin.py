"""The pytest plugin: one alpha for the whole run, seeds, and an outcome of its own."""

import pytest

TESTS = """
import numpy as np
import pytest

@pytest.mark.parametrize("power", [1, 2])
def test_honest(unbiased, power):
    verdict = unbiased(lambda n, rng: rng.random(n) ** power, truth=1 / (power + 1), range=(0, 1))
    assert verdict.alpha == pytest.approx(ALPHA / 5 / 2) and verdict.seed == SEED
    second = unbiased(unbiased.rng.random(50_000), truth=0.5, range=(0, 1))
    assert second.alpha == pytest.approx(ALPHA / 5 / 6) and second.name.endswith("#2")

def test_biased(unbiased):
    unbiased(lambda n, rng: rng.random(n) * 1.1, truth=0.5, range=(0, 2))

@pytest.fixture
def mine(unbiased):
    return unbiased

def test_undecided(mine):
    mine(mine.rng.random(20), truth=0.5, range=(0, 1))

def test_own_alpha(unbiased):
    with pytest.raises(TypeError, match="give it by --tf-alpha"):
        unbiased([0.5], truth=0.5, alpha=0.5)

def test_without():
    pass
"""


@pytest.fixture
def run(pytester):
    def run(*arguments, alpha=1e-3, seed=1, text=TESTS):
        pytester.makepyfile(f"ALPHA, SEED = {alpha}, {seed}\n{text}")
        return pytester.runpytest_subprocess(*arguments)

    return run


def test_outcomes_and_what_is_printed(run):
    result = run()
    assert result.ret == pytest.ExitCode.TESTS_FAILED
    assert result.parseoutcomes() == {"passed": 4, "failed": 1, "inconclusive": 1}
    result.stdout.fnmatch_lines(
        [
            "trueflight: --tf-alpha=0.001 --tf-seed=1",
            "trueflight: 5 test(s) share it, 0.0002 each",
            "*py ..FI..*",
            "*AssertionError: check `*::test_biased`: fail: the mean is off by +*",
            "*  seed      1",
            "*inconclusive*",
            "check `*::test_undecided`: inconclusive: the mean is undecided after 20 draws*",
        ]
    )


def test_options(run):
    result = run("--tf-alpha=0.01", "--tf-seed=7", "-v", alpha=0.01, seed=7)
    assert result.parseoutcomes() == {"passed": 4, "failed": 1, "inconclusive": 1}
    result.stdout.fnmatch_lines(["trueflight: --tf-alpha=0.01 --tf-seed=7", "*test_undecided INCONCLUSIVE*"])


def test_alpha_is_shared_by_those_that_are_selected(run):
    text = TESTS.replace("ALPHA / 5", "ALPHA / 2")
    result = run("-k", "honest", text=text)
    assert result.ret == 0
    result.stdout.fnmatch_lines(["trueflight: 2 test(s) share it, 0.0005 each"])


def test_what_is_inconclusive_may_be_let_pass(run, tmp_path):
    result = run("--tf-inconclusive=pass", "-k", "undecided", f"--junit-xml={tmp_path}/junit.xml")
    assert result.ret == 0
    assert result.parseoutcomes() == {"inconclusive": 1, "deselected": 5}
    assert 'skipped="1"' in (tmp_path / "junit.xml").read_text()
    assert run("-k", "undecided").ret == pytest.ExitCode.TESTS_FAILED


def test_wrong_options_are_one_line(run):
    result = run("--tf-alpha=2")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*--tf-alpha: 2 is no probability above 0 and below 1; give one such as 1e-3"])
    result = run("--tf-seed=-1")
    result.stderr.fnmatch_lines(["*--tf-seed: -1 is no whole number from 0 to 2^64 - 1; give one such as 1"])


def test_a_fixture_that_is_not_an_argument_is_refused(run):
    result = run(text="def test_late(request):\n    request.getfixturevalue('unbiased')\n")
    assert result.ret != 0
    result.stdout.fnmatch_lines(["*make it an argument of the test*"])


def test_a_run_without_it_says_no_more_than_its_options(run):
    result = run(text="def test_nothing():\n    pass\n")
    assert result.ret == 0
    result.stdout.no_fnmatch_line("*share it*")
