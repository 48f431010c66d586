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
            "trueflight: alpha 0.001, shared by 5 tests: 0.0002 each",
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


@pytest.mark.parametrize(
    "selection", [("-k", "honest"), ("-m", "parametrize"), ("--deselect=test_it.py::test_biased", "-k", "honest")]
)
def test_alpha_does_not_depend_on_what_is_deselected(run, selection):
    result = run(*selection)
    assert result.ret == 0
    result.stdout.fnmatch_lines(["trueflight: alpha 0.001, shared by 5 tests (2 selected): 0.0002 each"])


def test_a_test_asked_for_by_its_id_has_all_of_alpha(pytester):
    text = "def test_{}(unbiased):\n    assert unbiased([0.5] * 9, truth=0.5, variance=0, range=(0, 1)).alpha == 5e-4\n"
    pytester.makepyfile(test_ids=text.format("one") + text.format("two"))
    result = pytester.runpytest_subprocess("test_ids.py::test_one")
    result.stdout.fnmatch_lines(["trueflight: alpha 0.001, shared by 1 test: 0.001 each"])


def test_a_test_that_never_calls_it_is_warned_of(run):
    result = run(text="def test_forgot(unbiased):\n    pass\n\ndef test_failed(unbiased):\n    assert False\n")
    assert result.parseoutcomes() == {"passed": 1, "failed": 1, "warnings": 1}
    result.stdout.fnmatch_lines(["*test_forgot passed, but never called `unbiased`: it checked no draws; call it*"])


def test_a_name_that_is_no_text_is_an_error(run):
    result = run(text="def test_named(unbiased):\n    unbiased(lambda n, rng: rng.random(n), truth=0.5, name=3)\n")
    result.stdout.fnmatch_lines(["*Error: name = 3 is no text; give one, or leave it out"])


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
    result.stdout.no_fnmatch_line("*shared by*")
