"""What a check found."""

import html
import json
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

Number = float | None | npt.NDArray[np.float64]

_COLOURS = {"pass": "#1a7f37", "fail": "#cf222e", "inconclusive": "#9a6700"}


class Verdict:
    """The verdict of a check, with its numbers; true if it is a pass.

    A number is a float where a draw is one value, ``None`` where it is not known; and an array of float64, shape (k,), where
    a draw has k values, with NaN for what is not known. ``str(verdict)`` has all lines of ``trueflight judge``.
    """

    name: str
    """The check's name."""
    verdict: Literal["pass", "fail", "inconclusive"]
    """Fail if any value of a draw fails, pass if all pass."""
    reason: str
    """Why, in words; empty for a plain pass."""
    alpha: float
    """The chance that a correct estimator fails, all values together."""
    seed: int
    """Where the random numbers began that callables were given."""
    channels: list[str]
    """The names of the values, where they are channels of a case; empty otherwise."""
    values: list[dict[str, Any]]
    """What was found of each value of a draw, by the names of ``record.json``."""

    def __init__(self, found: tuple[Any, str, str, str], seed: int) -> None:
        self.verdict, self.reason, self._text, numbers = found
        outcome = json.loads(numbers)
        self.name, self.alpha, self.values = outcome["name"], outcome["alpha"], outcome["values"]
        self.channels = outcome["channels"]
        self.seed = seed

    @property
    def passed(self) -> bool:
        """Whether it is a pass; neither fail nor inconclusive is one."""
        return self.verdict == "pass"

    @property
    def draws(self) -> int:
        """How many draws were judged."""
        return int(self.values[0]["draws"])

    @property
    def truth(self) -> Number:
        """What the mean should be."""
        return self._number("truth")

    @property
    def mean(self) -> Number:
        """The mean of the draws."""
        return self._number("mean")

    @property
    def standard_error(self) -> Number:
        """The mean's standard error: from the variance given, else from that of the draws."""
        return self._number("standard_error")

    @property
    def z(self) -> Number:
        """(mean - truth) in standard errors."""
        return self._number("z")

    @property
    def variance(self) -> Number:
        """The unbiased sample variance of a draw; of an average, where ``batch`` draws are averaged."""
        return self._number("variance")

    @property
    def predicted_variance(self) -> Number:
        """The variance that was given, or that theory has."""
        return self._number("predicted_variance")

    @property
    def kurtosis(self) -> Number:
        """The sample kurtosis, 3 for the normal law."""
        return self._number("kurtosis")

    @property
    def lookups(self) -> Number:
        """The mean number of lookups, where draws tell it; of the first value only."""
        return self._number("lookups")

    @property
    def p_values(self) -> dict[str, float]:
        """The p-values of tests of the whole distribution, by test, where theory knows it; empty otherwise."""
        return {found["check"]: float(found["p"]) for found in self.values[0]["distribution"]}

    def assert_pass(self) -> "Verdict":
        """Raises ``AssertionError`` with the lines of the verdict unless it is a pass; answers itself."""
        __tracebackhide__ = True
        if not self.passed:
            raise AssertionError(f"check {self._text}")
        return self

    def to_dict(self) -> dict[str, Any]:
        """Everything, as JSON has it: texts, numbers, lists and dicts."""
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
        colour = _COLOURS[self.verdict]
        rows = ""
        for line in lines:
            word, _, text = line.strip().partition(" ")
            cells = f"<th style='text-align:left'>{html.escape(word)}</th>"
            rows += f"<tr>{cells}<td style='text-align:left'>{html.escape(text.strip())}</td></tr>"
        bold = f"<b style='color:{colour}'>{html.escape(head)}</b>"
        return f"<div>{bold}<table>{rows}</table></div>"
