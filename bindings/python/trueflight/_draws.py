"""Where draws come from: arrays, iterators and callables, all as chunks of draws with their lookups.

A chunk is an array of numbers, shape (n,) or (n, k), and the lookups, shape (n,), where draws tell them.
"""

import inspect
import itertools
import zlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import DrawsError, Error
from ._trueflight import BLOCK, MOST

Array = npt.NDArray[Any]
Chunk = tuple[Array, Array | None]

# So many draws a callable is asked for at a time: its arrays stay in the cache, and a call costs little beside them.
AT_ONCE = 4 * BLOCK


def is_array(source: Any) -> bool:
    """Whether all draws are there at once."""
    if isinstance(source, np.ndarray | list | str):
        return True
    if any(hasattr(source, name) for name in ("__array__", "__array_interface__", "__dlpack__")):
        return True
    try:
        return memoryview(source) is not None
    except TypeError:
        return False


def is_pair(source: Any) -> bool:
    """Whether these are draws with their lookups."""
    return isinstance(source, tuple) and len(source) == 2 and np.ndim(source[0]) > 0


def numbers(name: str, what: str, made: Any) -> Array:
    """Real numbers as an array of NumPy's, without a copy where they are one, or lie in a buffer."""
    if isinstance(made, np.ma.MaskedArray):
        cure = f"fill its masked {what} (filled), or drop them (compressed)"
        raise DrawsError(f"check `{name}`: the {what} are a masked array; {cure}")
    try:
        if hasattr(made, "__dlpack__") and not hasattr(made, "__array__"):
            array = np.from_dlpack(made)
        else:
            array = np.asarray(made)
    except ValueError as error:
        raise DrawsError(f"check `{name}`: the {what} are no array: {error}; give numbers of one shape") from error
    if array.dtype.kind not in "fiub":
        kind = _kind(array)
        raise DrawsError(f"check `{name}`: the {what} are {kind}, not real numbers; give an array of floats")
    return array


def _kind(array: Array) -> str:
    """What an array has in place of real numbers."""
    if array.dtype.kind != "O":
        return array.dtype.name
    if array.ndim == 0:
        return type(array.item()).__name__
    first = f", the first is {type(array.flat[0]).__name__}" if array.size else ""
    return f"Python objects (dtype object{first})"


def chunk(name: str, made: Any, count: int | None = None) -> Chunk:
    """One chunk, of so many draws if that is known."""
    draws, lookups = made if is_pair(made) else (made, None)
    draws = numbers(name, "draws", draws)
    wanted = "(n,) or (n, k)" if count is None else f"({count},) or ({count}, k)"
    if draws.ndim not in (1, 2) or (count is not None and len(draws) != count) or draws.shape[1:] == (0,):
        asked = "" if count is None else f", but {count} draws were asked for"
        raise Error(f"check `{name}`: draws of shape {draws.shape}{asked}; give an array of shape {wanted}")
    if lookups is not None:
        lookups = numbers(name, "lookups", lookups)
        if lookups.shape != draws.shape[:1]:
            found = f"lookups of shape {lookups.shape} for {len(draws)} draws"
            raise Error(f"check `{name}`: {found}; give one for each draw, shape ({len(draws)},)")
    return draws, lookups


def from_callable(name: str, make: Callable[..., Any], draws: int | None, seed: int) -> Iterator[Chunk]:
    """Asks a callable for draws, some at a time; its exceptions come through."""
    rng = np.random.default_rng([seed, zlib.crc32(name.encode())])
    arguments = (rng,) if _takes_rng(make) else ()
    left = MOST if draws is None else draws
    while left > 0:
        count = min(left, AT_ONCE)
        yield chunk(name, make(count, *arguments), count)
        left -= count


def from_iterator(name: str, source: Iterable[Any], draws: int | None) -> Iterator[Chunk]:
    """What an iterator yields: draws one by one, or arrays of them; as many as are wanted."""
    left = MOST if draws is None else draws
    iterator = iter(source)
    for first in iterator:
        rest: Iterable[Any] = itertools.chain([first], iterator)
        if np.ndim(first) > 0 or is_pair(first):
            # Arrays, to the end.
            for made in rest:
                values, lookups = chunk(name, made)
                values, lookups = values[:left], None if lookups is None else lookups[:left]
                left -= len(values)
                yield values, lookups
                if left == 0:
                    return
            return
        some = list(itertools.islice(rest, min(left, BLOCK)))
        left -= len(some)
        yield chunk(name, some)
        if left == 0:
            return


def _takes_rng(make: Callable[..., Any]) -> bool:
    """Whether a callable wants a generator beside the number of draws."""
    try:
        parameters = list(inspect.signature(make).parameters.values())
    except (TypeError, ValueError):
        return False
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    second = [parameter for parameter in parameters if parameter.kind in positional][1:2]
    return any(parameter.name == "rng" or parameter.default is parameter.empty for parameter in second)
