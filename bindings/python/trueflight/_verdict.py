"""Result of a check."""

import html
import json
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _figure

Number = float | None | npt.NDArray[np.float64]


class Verdict:
    """The verdict of a check, with its numbers; true if it is a pass.

    A number is a float if a draw is one value, ``None`` if it is unknown. If a draw has k values it is an array of float64,
    shape (k,), with NaN for unknown numbers. Means have the unit of the draws, variances its square. ``str(verdict)`` has all
    lines of ``trueflight judge``. A notebook shows it as a figure, deviations beside the bias that a pass excludes, and a table.
    """

    name: str
    """Name of the check."""
    verdict: Literal["pass", "fail", "inconclusive"]
    """Fail if any value of a draw fails, pass if all pass."""
    reason: str
    """Reason, in words; empty for a plain pass."""
    alpha: float
    """Probability that a correct estimator fails, all values together."""
    seed: int
    """Seed of the random numbers of callables."""
    channels: list[str]
    """Names of the values, if they are channels of a case; empty otherwise."""
    values: list[dict[str, Any]]
    """Numbers of each value of a draw, by the names of ``record.json``."""

    def __init__(self, found: tuple[Any, str, str, str], seed: int) -> None:
        self.verdict, self.reason, self._text, numbers = found
        outcome = json.loads(numbers)
        self.name, self.alpha, self.values = outcome["name"], outcome["alpha"], outcome["values"]
        self.channels = outcome["channels"]
        self.seed = seed

    @property
    def passed(self) -> bool:
        """True for a pass; false for fail and for inconclusive."""
        return self.verdict == "pass"

    @property
    def draws(self) -> int:
        """Number of judged draws."""
        return int(self.values[0]["draws"])

    @property
    def truth(self) -> Number:
        """Expected mean."""
        return self._number("truth")

    @property
    def mean(self) -> Number:
        """Mean of the draws."""
        return self._number("mean")

    @property
    def standard_error(self) -> Number:
        """Standard error of the mean: from the given variance, else from that of the draws."""
        return self._number("standard_error")

    @property
    def z(self) -> Number:
        """(mean - truth) in standard errors."""
        return self._number("z")

    @property
    def variance(self) -> Number:
        """Unbiased sample variance of a draw; of an average if ``batch`` draws are averaged."""
        return self._number("variance")

    @property
    def predicted_variance(self) -> Number:
        """Expected variance, given or from theory."""
        return self._number("predicted_variance")

    @property
    def kurtosis(self) -> Number:
        """Sample kurtosis, 3 for the normal distribution."""
        return self._number("kurtosis")

    @property
    def lookups(self) -> Number:
        """Mean number of lookups, if draws have lookups; of the first value only."""
        return self._number("lookups")

    @property
    def p_values(self) -> dict[str, float]:
        """p-values of the tests of the whole distribution, by test, if theory knows it; empty otherwise."""
        return {found["check"]: float(found["p"]) for found in self.values[0]["distribution"]}

    def assert_pass(self) -> "Verdict":
        """Raises ``AssertionError`` with the lines of the verdict unless it is a pass; returns itself."""
        __tracebackhide__ = True
        if not self.passed:
            raise AssertionError(f"check {self._text}")
        return self

    def to_dict(self) -> dict[str, Any]:
        """Returns everything as values of JSON: texts, numbers, lists and dicts."""
        own = {"name": self.name, "verdict": self.verdict, "reason": self.reason}
        return own | {"alpha": self.alpha, "seed": self.seed, "channels": self.channels, "values": self.values}

    def _number(self, key: str) -> Number:
        found = [value[key] for value in self.values]
        if len(found) == 1:
            return None if found[0] is None else float(found[0])
        return np.array([np.nan if number is None else number for number in found], dtype=np.float64)

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        why = f": {self.reason}" if self.reason else ""
        return f"<Verdict of {self.name!r}: {self.verdict} after {self.draws:,} draws{why}>"

    def _repr_html_(self) -> str:
        head, *lines = self._text.split("\n")
        colour = _figure.COLOURS[self.verdict]
        figure = _figure.svg(_figure.rows(self.values, self.channels), bool(self.values[0]["truth"]))
        rows = ""
        for line in lines:
            word, _, text = line.strip().partition(" ")
            cells = f"<th style='text-align:left'>{html.escape(word)}</th>"
            rows += f"<tr>{cells}<td style='text-align:left'>{html.escape(text.strip())}</td></tr>"
        bold = f"<b style='color:{colour}'>{html.escape(head)}</b>"
        return f"<div>{bold}<br>{figure}<table>{rows}</table></div>"
