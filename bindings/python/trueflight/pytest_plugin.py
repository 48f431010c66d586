"""The fixture ``unbiased`` for pytest: all tests of a run that use it share one alpha.

A run of correct estimators shows a failure with probability ``--tf-alpha`` at most. Each of the N collected tests that use
the fixture has alpha/N, whichever of them ``-k`` and ``-m`` deselect. The k-th check of one test has alpha/(N k (k + 1)),
which sums up to its share.
"""

import warnings
from argparse import ArgumentTypeError
from collections.abc import Generator
from typing import Any

import numpy as np
import pytest

from ._check import check
from ._errors import Inconclusive
from ._verdict import Verdict

_USERS = pytest.StashKey[int]()
_PASSED = pytest.StashKey[bool]()


class Unbiased:
    """Value of the fixture ``unbiased``: a call checks draws as ``trueflight.check`` does, and asserts that they pass."""

    def __init__(self, name: str, alpha: float, seed: int) -> None:
        self.name, self.alpha, self.seed = name, alpha, seed
        self.rng = np.random.default_rng([seed, *name.encode()])
        """A ``numpy.random.Generator`` from ``--tf-seed`` and the test's name, for draws that the test makes itself."""
        self.checks = 0
        """Number of calls so far."""

    def __call__(self, source: Any, **known: Any) -> Verdict:
        """Checks draws with the test's share of alpha; returns the verdict if they pass.

        Takes the arguments of ``trueflight.check`` except ``alpha`` and ``seed``, which belong to the run. Raises
        ``AssertionError`` if the draws fail, ``trueflight.Inconclusive`` if they neither pass nor fail.
        """
        __tracebackhide__ = True
        self.checks += 1
        for key in {"alpha", "seed"} & known.keys():
            raise TypeError(f"{key} belongs to the whole run; give it by --tf-{key}")
        share = self.alpha / (self.checks * (self.checks + 1))
        name = known.pop("name", None)
        if name is None:
            name = self.name if self.checks == 1 else f"{self.name} #{self.checks}"
        verdict = check(source, alpha=share, seed=self.seed, name=name, **known)
        if verdict.verdict == "inconclusive":
            raise Inconclusive(f"check {verdict}\n  seed      {self.seed}")
        if not verdict.passed:
            raise AssertionError(f"check {verdict}\n  seed      {self.seed}")
        return verdict


@pytest.fixture
def unbiased(request: pytest.FixtureRequest) -> Generator[Unbiased, None, None]:
    """Checks draws with a share of the alpha of the whole run; see ``trueflight.pytest_plugin.Unbiased``."""
    if not _asks(request.node):
        raise pytest.UsageError("`unbiased` was not asked for before the first test ran; make it an argument of the test")
    config = request.config
    alpha = config.getoption("tf_alpha") / config.stash[_USERS]
    mine = Unbiased(request.node.nodeid, alpha, config.getoption("tf_seed"))
    yield mine
    if not mine.checks and request.node.stash.get(_PASSED, False):
        text = f"{mine.name} passed, but never called `unbiased`: it checked no draws; call it, or drop the argument"
        warnings.warn(pytest.PytestWarning(text), stacklevel=1)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds --tf-alpha, --tf-seed and --tf-inconclusive."""
    group = parser.getgroup("trueflight", "unbiasedness of Monte Carlo estimators")
    alpha = "probability that any test of correct estimators fails in the whole run [default: 1e-3]"
    group.addoption("--tf-alpha", type=_alpha, default=1e-3, metavar="A", help=alpha)
    group.addoption("--tf-seed", type=_seed, default=1, metavar="N", help="seed of all draws [default: 1]")
    count = "what an inconclusive test counts as for the exit code [default: fail]"
    group.addoption("--tf-inconclusive", choices=("fail", "pass"), default="fail", help=count)


def pytest_report_header(config: pytest.Config) -> str:
    """Returns the options that repeat the run."""
    return f"trueflight: --tf-alpha={config.getoption('tf_alpha'):g} --tf-seed={config.getoption('tf_seed')}"


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> Generator[None, None, None]:
    """Counts the tests that share alpha, before ``-k`` and ``-m`` deselect any of them."""
    config.stash[_USERS] = sum(map(_asks, items))
    return (yield)


def pytest_report_collectionfinish(config: pytest.Config, items: list[pytest.Item]) -> str | list[str]:
    """Returns the number of tests that share alpha."""
    users, selected = config.stash.get(_USERS, 0), sum(map(_asks, items))
    if not selected:
        return []
    alpha = config.getoption("tf_alpha")
    tests = "1 test" if users == 1 else f"{users} tests"
    some = f" ({selected} selected)" if selected < users else ""
    return f"trueflight: alpha {alpha:g}, shared by {tests}{some}: {alpha / users:.2g} each"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[Any]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Marks inconclusive tests."""
    report = yield
    if call.when == "call":
        item.stash[_PASSED] = report.passed
    if call.excinfo is not None and isinstance(call.excinfo.value, Inconclusive):
        report.tf_inconclusive = str(call.excinfo.value)  # type: ignore[attr-defined]
        if item.config.getoption("tf_inconclusive") == "pass":
            path, line, _ = item.location
            report.outcome, report.longrepr = "skipped", (path, (line or 0) + 1, str(call.excinfo.value))
    return report


def pytest_report_teststatus(report: Any) -> Any:
    """Returns an outcome of its own: the letter I."""
    if getattr(report, "tf_inconclusive", None):
        return "inconclusive", "I", ("INCONCLUSIVE", {"yellow": True})
    return None


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Writes the lines of the inconclusive verdicts."""
    reports = terminalreporter.stats.get("inconclusive", [])
    if reports:
        terminalreporter.section("inconclusive", yellow=True)
    for report in reports:
        terminalreporter.write_line(report.tf_inconclusive)


def _asks(item: Any) -> bool:
    return "unbiased" in getattr(item, "fixturenames", ())


def _alpha(text: str) -> float:
    try:
        alpha = float(text)
    except ValueError:
        alpha = np.nan
    if not 0.0 < alpha < 1.0:
        raise ArgumentTypeError(f"{text} is no probability above 0 and below 1; give one such as 1e-3")
    return alpha


def _seed(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) < 2**64):
        raise ArgumentTypeError(f"{text} is no whole number from 0 to 2^64 - 1; give one such as 1")
    return int(text)
