"""Checks of draws: is an estimator unbiased?"""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _draws
from ._arrays import Array, host, is_array
from ._arrays import rounding as rounding_of
from ._cases import as_case, whole
from ._draws import Chunk
from ._errors import DrawsError, Error, shown
from ._trueflight import judge
from ._verdict import Verdict

Values = float | Sequence[float] | npt.NDArray[Any]

# Numbers that are converted at a time, unless they are contiguous float64 or float32.
PIECE = 1 << 20

# Properties with one number, or one for each value of a draw.
_LISTS = ("truth", "variance", "kurtosis")

# Maximum number of values of a draw that are judged together: more would leave each too small a share of alpha.
WIDEST = 64


def check(
    source: Callable[..., Any] | Iterable[Any] | npt.ArrayLike,
    *,
    truth: Values | None = None,
    variance: Values | None = None,
    kurtosis: Values | None = None,
    range: tuple[float, float] | None = None,
    lookups: tuple[float, float] | None = None,
    case: str | os.PathLike[str] | dict[str, Any] | None = None,
    estimator: str | None = None,
    sampling: float | None = None,
    nearest: bool = False,
    mean_only: bool = False,
    tolerance: float | None = None,
    variance_tolerance: float | None = None,
    rounding: float | None = None,
    batch: int = 1,
    alpha: float = 1e-3,
    draws: int | None = None,
    seed: int = 1,
    name: str | None = None,
) -> Verdict:
    """Judges draws: are mean, variance and distribution what they should be? A correct estimator fails with probability ``alpha``
    at most.

    ``source`` is one of

    - an array of n draws, shape (n,), or of n draws of k values, shape (n, k): NumPy, anything with DLPack or
      ``__cuda_array_interface__``, a column of pandas, Polars or Arrow, or a buffer. Any real dtype; contiguous float64
      and float32 are read in place, others some at a time. Arrays on a GPU (CuPy, PyTorch, Numba, JAX) are copied to the host in
      pieces of 2**20 numbers;
    - a callable ``f(n)`` or ``f(n, rng)`` that returns n draws in such an array; ``rng`` is a ``numpy.random.Generator`` from
      seed and name. It is called until the verdict is decided, for 2**24 draws at most;
    - an iterator of draws, or of such arrays.

    A pair ``(draws, lookups)`` in place of an array also gives the number of lookups of each draw.

    Claims about a correct draw (lengths in any unit, if draws and truth have the same):

    ``truth``, ``variance``, ``kurtosis``
        Its mean, its variance (tested, too), its kurtosis (3 for the normal distribution; without a variance an upper
        bound). One number, or one for each of the k values.
    ``range``
        Its range, (low, high); either may be infinite. A draw outside fails.
    ``lookups``
        Mean and variance of its number of lookups of the extinction.
    ``case``, ``estimator``, ``sampling``
        An experiment: theory then makes these claims, and one about the whole distribution where it is known. A case as in
        ``predict``, the estimator's name in it, and any value of the swept quantity, or a constant sampling extinction in
        1/length.
        Every channel of the case is a value of the draw; a luminance may be left out. A free flight that leaves the ray is
        its length, any larger number, infinity or -1.
    ``nearest``
        Takes the nearest value of the case's sweep in place of ``sampling``.
    ``mean_only``
        Takes only the mean from theory, for an estimator that the case does not have.

    Options of the verdict:

    ``tolerance``, ``variance_tolerance``
        The relative bias that a pass excludes (absolute for a truth of 0). Without them the smallest bias that
        the draws can show, 5 % and 20 % at most; for callables and iterators without ``draws`` 1 % of the mean.
    ``rounding``
        Rounding error of a draw, relative to the truth: 3.6e-13, for arrays of float32 and float16 eight times the
        dtype's epsilon, for bfloat16 and float8 half of it (one rounding, of the draw that is stored).
    ``batch``
        Number of consecutive draws that are averaged before they are judged, for draws that depend on each other.
    ``alpha``, ``draws``, ``seed``, ``name``
        Error rate; total number of draws; seed of the random numbers of callables; name in the verdict.

    Returns a ``Verdict``, true if it is a pass. A draw that is NaN or infinite is not an error but a fail.

    Raises ``trueflight.Error`` (a ``ValueError``) for invalid arguments, ``DrawsError`` (also a ``TypeError``) for draws that
    are not real numbers, ``CaseNotFound`` (also a ``FileNotFoundError``). Exceptions of a callable come through.

    >>> import numpy as np
    >>> halves = np.random.default_rng(1).random(1_000_000) < 0.5
    >>> print(check(halves, truth=0.5, range=(0, 1)).verdict)
    pass
    """
    called = _name(source, name)
    count = None if draws is None else whole("draws", draws, 1, 2**53)
    begin = whole("seed", seed, 0, 2**64 - 1)
    properties = {
        "truth": truth,
        "variance": variance,
        "kurtosis": kurtosis,
        "range": range,
        "lookups": lookups,
        "rounding": rounding,
        "tolerance": tolerance,
        "variance_tolerance": variance_tolerance,
    }
    numbers = {what: _numbers(what, given) for what, given in properties.items() if given is not None}
    numbers |= {"batch": _numbers("batch", batch), "alpha": _numbers("alpha", alpha), "mean_only": [float(bool(mean_only))]}
    asked = {
        "name": called,
        "properties": numbers,
        "seed": begin,
        "case": None if case is None else as_case(case),
        "estimator": _estimator(case, estimator, sampling, nearest),
        "sampling": None if sampling is None else _real("sampling", sampling, sampling, "give a number"),
        "nearest": bool(nearest),
    }
    chunks, length = _chunks(called, source, count, begin)
    # Arrays, and draws of a given number, are read to their end; otherwise the drawing stops once the verdict is decided.
    if length is not None:
        numbers["draws"] = [float(length)]
    first = next(chunks, None)
    if first is not None:
        _not_too_wide(called, first.draws)
        numbers["values"] = [float(_form(first)[0])]
        if rounding is None and (own := rounding_of(first.precision)) is not None:
            numbers["rounding"] = [own]
        chunks = itertools.chain([first], chunks)
    return Verdict(judge(asked, _arrays(called, chunks)), begin)


def _chunks(name: str, source: Any, draws: int | None, seed: int) -> tuple[Iterator[Chunk], int | None]:
    """Returns the draws, and their number if it is known."""
    if callable(source) and not is_array(source):
        return _draws.from_callable(name, source, draws, seed), draws
    if _draws.is_pair(source) or is_array(source) or isinstance(source, tuple):
        chunks, shape = _draws.from_array(name, source, draws)
        _not_transposed(name, shape)
        return chunks, min(shape[0], shape[0] if draws is None else draws) or None
    if isinstance(source, Iterable):
        return _draws.from_iterator(name, source, draws), draws
    kind = type(source).__name__
    raise DrawsError(f"check `{name}`: draws cannot come from {kind}; give an array, an iterator or a callable f(n)")


def _name(source: Any, name: Any) -> str:
    """Returns the name of the draws in the verdict."""
    if name is None:
        own = getattr(source, "__name__", None)
        return own.replace("<lambda>", "draws") if isinstance(own, str) else "draws"
    if not isinstance(name, str):
        raise Error(f"name = {shown(name)} is no text; give one, or leave it out")
    return name


def _not_too_wide(name: str, values: Array) -> None:
    """Refuses draws of more values than can be judged together."""
    count = values.shape[1] if values.ndim == 2 else 1
    if count > WIDEST:
        cure = f"{WIDEST} are judged together at most; check them in parts, each with its share of alpha"
        raise Error(f"check `{name}`: draws of {count} values each; {cure}")


def _not_transposed(name: str, shape: tuple[int, ...]) -> None:
    """Refuses an array with fewer draws than values."""
    if len(shape) == 2 and 0 < shape[0] < shape[1]:
        one = "1 draw" if shape[0] == 1 else f"{shape[0]} draws"
        found = f"{one} of {shape[1]} values each, fewer draws than values"
        raise Error(f"check `{name}`: {found}; a row is a draw: did you mean draws.T?")


def _arrays(name: str, chunks: Iterable[Chunk]) -> Iterator[tuple[Array, Array | None]]:
    """Returns arrays as the library reads them: contiguous floats in place, others converted some at a time."""
    form = None
    for chunk in chunks:
        form = form or _form(chunk)
        if _form(chunk) != form:
            raise Error(f"check `{name}`: draws of {_words(_form(chunk))} after {_words(form)}; give all alike")
        values, counts, _ = chunk
        is_dense = values.dtype in (np.float64, np.float32) and values.flags.c_contiguous and counts is None
        step = max(len(values), 1) if is_dense else PIECE
        for first in np.arange(0, len(values), step):
            part = values[first : first + step]
            if part.dtype != np.float32:
                part = part.astype(np.float64, order="C", copy=False)
            told = None if counts is None else np.ascontiguousarray(counts[first : first + step], dtype=np.float64)
            yield np.ascontiguousarray(part), told


def _form(chunk: Chunk) -> tuple[int, bool]:
    """Returns the number of values of a draw, and whether it has lookups."""
    return (chunk.draws.shape[1] if chunk.draws.ndim == 2 else 1), chunk.lookups is not None


def _words(form: tuple[int, bool]) -> str:
    values, counts = form
    return f"{values} value{'s' if values > 1 else ''} {'with' if counts else 'without'} lookups"


def _numbers(what: str, given: Values) -> list[float]:
    cure = "give a number, or one for each value of a draw" if what in _LISTS else "give a number"
    if isinstance(given, np.ma.MaskedArray):
        raise Error(f"{what} is a masked array; fill or drop what is masked")
    try:
        array = np.atleast_1d(host(given))
    except Exception as error:
        raise Error(f"{what} = {shown(given)} is no number; {cure}") from error
    if array.ndim != 1 or not len(array):
        raise Error(f"{what} has shape {np.shape(array)}; {cure}")
    return [_real(what, number, given, cure) for number in array.tolist()]


def _real(what: str, number: Any, given: Any, cure: str) -> float:
    """Converts a number to a float; a text is never a number."""
    try:
        if isinstance(number, str | bytes):
            raise TypeError
        return float(number)
    except OverflowError as error:
        raise Error(f"{what} = {shown(given)} is too large for a float64; {cure}") from error
    except (TypeError, ValueError) as error:
        raise Error(f"{what} = {shown(given)} is no number; {cure}") from error


def _estimator(case: Any, estimator: str | None, sampling: float | None, nearest: bool) -> str:
    if nearest and sampling is None:
        raise Error("nearest without a value; give sampling=… too")
    if case is None and (estimator is not None or sampling is not None):
        raise Error("an estimator or a sampling extinction without a case; give case=… too")
    if case is not None and not isinstance(estimator, str):
        raise Error("a case without an estimator; give estimator=…, its name in predict(case)['estimator']")
    return estimator or ""
