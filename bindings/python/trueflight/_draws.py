"""Sources of draws: arrays, iterators and callables, all as chunks of draws with their lookups.

A chunk is an array of numbers, shape (n,) or (n, k), and the lookups, shape (n,), if draws have them.
"""

import inspect
import itertools
import zlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array, dimensions, local, pieces, small_format, taken
from ._errors import Error
from ._trueflight import BLOCK, MAX_DRAWS

Shape = tuple[int, ...]

# Number of draws of one call of a callable: its arrays stay in the cache, and the call itself costs little.
AT_ONCE = 4 * BLOCK


class Chunk(NamedTuple):
    """Draws that came together: shape (n,) or (n, k)."""

    draws: Array
    lookups: Array | None
    """Shape (n,)."""
    precision: str
    """Name of the type that the draws had, as in ``bfloat16``."""


def is_pair(source: Any) -> bool:
    """Returns whether these are draws with their lookups."""
    return isinstance(source, tuple) and len(source) == 2 and dimensions(source[0]) > 0


def from_array(name: str, source: Any, draws: int | None = None, count: int | None = None) -> tuple[Iterator[Chunk], Shape]:
    """Returns the draws of an array, or of one with its lookups, and its shape.

    ``draws`` is the largest number of rows that are taken, ``count`` the number that was asked for. Arrays on another device
    come to the host some at a time.
    """
    given, told = source if is_pair(source) else (source, None)
    values, lookups = taken(name, "draws", given), None if told is None else taken(name, "lookups", told)
    shape = tuple(int(size) for size in values.shape)
    wanted = "(n,) or (n, k)" if count is None else f"({count},) or ({count}, k)"
    if len(shape) not in (1, 2) or (count is not None and shape[0] != count) or shape[1:] == (0,):
        asked = "" if count is None else f", but {count} draws were asked for"
        raise Error(f"check `{name}`: draws of shape {shape}{asked}; give an array of shape {wanted}")
    if lookups is not None and tuple(lookups.shape) != shape[:1]:
        found = f"lookups of shape {tuple(lookups.shape)} for {shape[0]} draws"
        raise Error(f"check `{name}`: {found}; give one for each draw, shape ({shape[0]},)")
    return _chunks(name, values, lookups, small_format(given), draws), shape


def _chunks(name: str, values: Any, lookups: Any, kind: str, draws: int | None) -> Iterator[Chunk]:
    # If only the lookups are on another device, their pieces are those of the draws, too.
    is_told = lookups is not None and isinstance(values, np.ndarray)
    for first, last in pieces(lookups if is_told else values):
        last = last if draws is None else min(last, draws)
        if first < last:
            told = None if lookups is None else local(name, "lookups", lookups, first, last)
            made = local(name, "draws", values, first, last)
            yield Chunk(made, told, kind or made.dtype.name)


def from_callable(name: str, make: Callable[..., Any], draws: int | None, seed: int) -> Iterator[Chunk]:
    """Returns the draws of a callable, some at a time; its exceptions pass through."""
    rng = np.random.default_rng([seed, zlib.crc32(name.encode())])
    arguments = (rng,) if _takes_rng(make) else ()
    left = MAX_DRAWS if draws is None else draws
    while left > 0:
        count = min(left, AT_ONCE)
        yield from from_array(name, make(count, *arguments), count=count)[0]
        left -= count


def from_iterator(name: str, source: Iterable[Any], draws: int | None) -> Iterator[Chunk]:
    """Returns the draws of an iterator that yields draws one by one, or arrays of them; at most ``draws`` of them."""
    left = MAX_DRAWS if draws is None else draws
    iterator = iter(source)
    for first in iterator:
        rest: Iterable[Any] = itertools.chain([first], iterator)
        if dimensions(first) > 0 or is_pair(first):
            # Arrays, to the end.
            for made in rest:
                chunks, shape = from_array(name, made, left)
                yield from chunks
                left -= min(left, shape[0])
                if left == 0:
                    return
            return
        some = list(itertools.islice(rest, min(left, BLOCK)))
        left -= len(some)
        yield from from_array(name, some)[0]
        if left == 0:
            return


def _takes_rng(make: Callable[..., Any]) -> bool:
    """Returns whether a callable takes a generator beside the number of draws."""
    try:
        parameters = list(inspect.signature(make).parameters.values())
    except (TypeError, ValueError):
        return False
    positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    second = [parameter for parameter in parameters if parameter.kind in positional][1:2]
    return any(parameter.name == "rng" or parameter.default is parameter.empty for parameter in second)
