"""Predictions and runs of cases."""

import json
import math
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _trueflight
from ._arrays import host, is_foreign
from ._errors import Error, shown

Case = str | os.PathLike[str] | dict[str, Any]
Columns = dict[str, Any]
Progress = bool | Callable[[int, int], object]

_SWEEPS = ("sampling", "sampling_scale", "albedo", "control", "points", "density", "albedo_scale", "contrast")


def cases() -> list[str]:
    """Returns the names of the built-in cases."""
    return _trueflight.built_in()


def predict(
    case: Case, *, optimum: bool = False, filter: str | None = None, seed: int = 1, threads: int | None = None
) -> Columns:
    """Predicts each experiment of a case: truth, variance, cost, figure of merit. Nothing is drawn.

    ``case`` is a built-in name, a path of a file or folder, the text of a case file (a text with a line break), or a dict with
    its keys. ``optimum`` searches the best constant sampling extinction too: a hundred predictions for each estimator.
    ``filter`` keeps experiments that match a pattern such as ``"*eq21*:single"``. ``seed`` is that of pilot rays, where the
    sampling extinction is learned. By default ``threads`` is one per processor.

    Returns a dict of columns, one row for each estimator, value of the sweep and channel, named as those of
    ``summary.csv``: texts in lists, numbers in arrays of float64 with NaN for unknown ones, counts in arrays of int64
    if all are known. ``pandas.DataFrame(…)`` and ``polars.DataFrame(…)`` take it. Extinctions are in 1/length.

    Raises ``trueflight.Error`` with every mistake in the case shown in place, ``CaseNotFound``, ``KeyboardInterrupt``.
    """
    wanted = _wanted(None, seed, 1e-3, filter, threads)
    return _columns(_trueflight.predict(as_case(case), wanted, bool(optimum)))


def advise(
    case: Case,
    *,
    error: float | str = 0.01,
    budget: float | str | None = None,
    cost: str | None = None,
    calibrate: bool = False,
    majorant: float = 1.0,
    rays: int | None = None,
    seed: int = 1,
    threads: int | None = None,
) -> Columns:
    """Ranks all estimators of a case, each with its best settings, by the predicted time to an error.

    The goal is a relative standard ``error``, as ``0.01`` or ``"1%"``, or the least error within a ``budget``, a number of
    lookups or a time such as ``"30s"``. ``cost`` gives the costs of your own code, as ``"draw=50ns,lookup=2us"``; by default they
    are measured on this machine and kept, and ``calibrate`` measures them anew. ``majorant`` is the factor by which your
    majorants exceed the maximum. ``rays`` random rays with ``seed`` take the place of the case's own.

    Returns a dict of columns, the best row first, named as those of ``advise.csv``; ``lines`` go into a case.
    """
    sought = {
        "error": str(error),
        "budget": None if budget is None else str(budget),
        "cost": cost,
        "calibrate": bool(calibrate),
        "majorant": str(majorant),
        "rays": None if rays is None else whole("rays", rays, 1, 4096),
        "seed": whole("seed", seed, 0, 2**64 - 1),
        "threads": 0 if threads is None else whole("threads", threads, 1, 1024),
    }
    return _columns(_trueflight.advise(as_case(case), sought))


def run(
    case: Case,
    *,
    draws: int | None = None,
    seed: int = 1,
    alpha: float = 1e-3,
    filter: str | None = None,
    threads: int | None = None,
    progress: Progress = False,
) -> Columns:
    """Draws every experiment of a case and judges it; without the GIL.

    ``draws`` are planned for each experiment, 2 to 1e12 (by default the number of the case, or 4e6); the gate may stop earlier,
    or go on. ``alpha`` is the probability that any of them fails although all are correct. Results do not depend on
    ``threads``. ``progress`` is a callable of the draws made and those planned, or ``True`` for a line on stderr. Ctrl-C ends
    the drawing within a tenth of a second. The other arguments are those of ``predict``.

    Returns the columns of ``predict``, with ``mean``, ``z_mean``, ``verdict``, … filled; ``seconds`` are of one processor.

    Raises ``trueflight.Error``, ``CaseNotFound`` and ``KeyboardInterrupt`` as ``predict`` does. A failing verdict is no error.
    """
    wanted = _wanted(draws, seed, alpha, filter, threads)
    return _drawn(as_case(case), wanted, progress)


def sweep(
    case: Case,
    *,
    draws: int | None = None,
    seed: int = 1,
    alpha: float = 1e-3,
    filter: str | None = None,
    threads: int | None = None,
    progress: Progress = False,
    **values: Sequence[float] | npt.NDArray[Any],
) -> Columns:
    """Sweeps a single case along values of one quantity, in place of its own sweep; the column ``swept`` has the value.

    The quantity is one of ``sampling`` and ``control`` (1/length), ``sampling_scale``, ``density``, ``albedo_scale`` (factors),
    ``albedo``, ``points``, ``contrast``, as in ``sweep(case, sampling=[0.5, 1.0, 2.0])``. Without ``draws`` it only
    predicts; with them it draws as ``run`` does.

    Returns the columns of ``predict``. Raises ``trueflight.Error`` if no estimator of the case depends on the quantity, or if a
    value is impossible, and otherwise as ``predict`` does.
    """
    if len(values) != 1 or not set(values) <= set(_SWEEPS):
        found = ", ".join(values) or "nothing"
        raise Error(f"{found} cannot be swept; give the values of one of: {', '.join(_SWEEPS)}")
    [(what, points)] = values.items()
    try:
        numbers = [float(x) for x in np.atleast_1d(np.asarray(host(points), dtype=np.float64))]
    except Exception as error:
        raise Error(f"{what} = {shown(points)} are no numbers; give a list of numbers") from error
    asked = as_case(case) | {"sweep": (what.replace("_", "-"), numbers)}
    wanted = _wanted(draws, seed, alpha, filter, threads)
    if draws is None:
        return _columns(_trueflight.predict(asked, wanted, False))
    return _drawn(asked, wanted, progress)


def as_case(case: Case) -> dict[str, Any]:
    """Converts a case for the compiled library."""
    if isinstance(case, dict):
        try:
            return _asked("json", json.dumps(_plain("", case), allow_nan=False))
        except RecursionError as error:
            raise Error("the dict is no case: it is nested too deep; give texts, numbers, lists and dicts") from error
    if isinstance(case, str):
        return _asked("toml" if "\n" in case else "named", case)
    if isinstance(case, os.PathLike):
        return _asked("named", os.fspath(case))
    kind = type(case).__name__
    raise Error(f"a case cannot be {kind}; give a built-in name, a path, a text or a dict")


def whole(what: str, number: Any, least: int, most: int) -> int:
    """Converts a whole number within bounds; 1e6 is one."""
    is_integer = isinstance(number, int | np.integer) and not isinstance(number, bool)
    is_whole = is_integer or (isinstance(number, float | np.floating) and math.isfinite(number) and int(number) == number)
    if is_whole and least <= number <= most:
        return int(number)
    raise Error(f"{what} = {shown(number)}; give a whole number from {least} to {most:g}")


def _asked(kind: str, text: str) -> dict[str, Any]:
    return {"kind": kind, "text": text, "sweep": None}


def probability(what: str, number: Any) -> float:
    """Converts a probability above 0 and below 1."""
    is_number = isinstance(number, int | float | np.integer | np.floating)
    if is_number and 0.0 < number < 1.0:
        return float(number)
    raise Error(f"{what} = {shown(number)} is not a probability; give one above 0 and below 1, such as 1e-3")


def _plain(place: str, value: Any) -> Any:
    """Converts a value of a dict to one of JSON: NumPy's numbers and arrays and paths, too."""
    if is_foreign(value):
        try:
            value = host(value)
        except Exception as error:
            raise Error(f"{place} is {type(value).__name__}, which NumPy cannot read: {error}; give a list") from error
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise Error(f"{place or 'the dict'} has the key {shown(key)}; keys of a case are texts")
        return {key: _plain(f"{place}.{key}" if place else key, part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(f"{place}[{index}]", part) for index, part in enumerate(value)]
    if value is None:
        raise Error(f"{place} = None says nothing; leave the key out, or give it a value")
    if isinstance(value, float) and not math.isfinite(value):
        raise Error(f"{place} = {value} is not a finite number")
    if isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise Error(f"{place} = {shown(value)} is no whole number of 64 bits; give a float")
    if isinstance(value, str | bool | int | float):
        return value
    raise Error(f"{place} = {shown(value)} is {type(value).__name__}; a case has texts, numbers, lists and dicts")


def _wanted(draws: int | None, seed: int, alpha: float, filter: str | None, threads: int | None) -> dict[str, Any]:
    if filter is not None and not isinstance(filter, str):
        raise Error(f'filter = {shown(filter)} is no text; give a pattern such as "*eq21*:single"')
    return {
        "draws": None if draws is None else whole("draws", draws, 2, 10**12),
        "seed": whole("seed", seed, 0, 2**64 - 1),
        "alpha": probability("alpha", alpha),
        "filter": filter,
        "threads": 0 if threads is None else whole("threads", threads, 1, 1024),
    }


def _drawn(asked: dict[str, Any], wanted: dict[str, Any], progress: Progress) -> Columns:
    if callable(progress):
        return _columns(_trueflight.run(asked, wanted, progress))
    if not progress:
        return _columns(_trueflight.run(asked, wanted, None))
    line = _Line()
    try:
        found = _columns(_trueflight.run(asked, wanted, line))
        line.show(f"drew {line.done:.3g} draws")
        return found
    finally:
        line.end()


class _Line:
    """Progress of the drawing: a line on stderr, written over itself.

    The planned draws are no bound: the gate may stop earlier or go on, and blocks are whole. The line therefore shows at most
    99 % until the end.
    """

    def __init__(self) -> None:
        self.done, self._width = 0, 0

    def __call__(self, done: int, planned: int) -> None:
        self.done = done
        self.show(f"drawing: {min(100 * done // planned, 99)} % of {planned:.3g} draws")

    def show(self, text: str) -> None:
        """Writes over the last text."""
        print("\r" + text.ljust(self._width), end="", file=sys.stderr, flush=True)
        self._width = len(text)

    def end(self) -> None:
        """Ends the line, if one has begun."""
        if self._width:
            print(file=sys.stderr, flush=True)


def _columns(text: str) -> Columns:
    """Converts columns in JSON, each its kind and its values, to lists and arrays."""
    return {name: _column(kind, values) for name, (kind, values) in json.loads(text).items()}


def _column(kind: str, values: list[Any]) -> Any:
    if kind == "text":
        return ["" if value is None else value for value in values]
    if kind == "list":
        return values
    if kind == "count" and None not in values:
        return np.array(values, dtype=np.int64 if max(values) < 2**63 else np.uint64)
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)
