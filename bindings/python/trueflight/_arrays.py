"""Arrays of any library, on any device, as arrays of NumPy in host memory.

NumPy reads what is in host memory in place. Arrays on another device (CuPy, PyTorch, Numba, JAX, cuDF, whatever has
``__cuda_array_interface__`` or DLPack) are copied to the host by their own methods, ``ROWS`` numbers at a time.
"""

import importlib
import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import DrawsError

Array = npt.NDArray[Any]

# Number of numbers that are copied from a device at a time: 8 MB of float64.
ROWS = 1 << 20

# Devices of DLPack whose memory the host reads: CPU, pinned memory of CUDA and of ROCm, managed memory of CUDA.
_HOST = frozenset((1, 3, 11, 13))

# Small floating-point formats that NumPy lacks, with the number of stored digits of their mantissa.
_SMALL = re.compile(r"bfloat16|float\d+_e\d+m(\d+)\w*")
_SMALL_WHOLE = re.compile(r"u?int[1-4]")

_PROTOCOLS = ("__array__", "__array_interface__", "__dlpack__", "__cuda_array_interface__", "tocoo")


def is_array(source: Any) -> bool:
    """Returns whether all draws are there at once."""
    if isinstance(source, np.ndarray | list | str):
        return True
    if any(_has(source, name) for name in _PROTOCOLS):
        return True
    try:
        return memoryview(source) is not None
    except TypeError:
        return False


def dimensions(made: Any) -> int:
    """Returns the number of dimensions of an array or a nested list, without a copy of its numbers."""
    shape = getattr(made, "shape", None)
    if isinstance(shape, tuple):
        return len(shape)
    if isinstance(made, list | tuple):
        return 1 + (dimensions(made[0]) if made else 0)
    try:
        return host(made).ndim if is_foreign(made) else np.ndim(made)
    except Exception:  # An array that NumPy cannot read: `numbers` says why.
        return 0


def small_format(made: Any) -> str:
    """Returns the name of a format that NumPy lacks, as in ``bfloat16``, or an empty text; of a list its first number."""
    while isinstance(made, list | tuple) and made:
        made = made[0]
    name = str(getattr(made, "dtype", "")).rpartition(".")[2]
    return name if _SMALL.fullmatch(name) else ""


def rounding(name: str) -> float | None:
    """Returns the relative rounding error of draws of a type with fewer digits than float64.

    For float32 and float16, in which estimators compute, eight times the spacing of numbers above 1. For bfloat16 and
    float8, in which draws are only stored, one rounding to nearest: half the spacing.
    """
    small = _SMALL.fullmatch(name)
    if small:
        return 2.0 ** -(1 + int(small[1] or 7))
    if name in ("float16", "float32"):
        return 8.0 * float(np.finfo(name).eps)
    return None


def is_remote(made: Any) -> bool:
    """Returns whether an array has its numbers on another device, with a shape and slices of its own."""
    if isinstance(made, np.ndarray | np.generic | list | tuple | str | bytes):
        return False
    return isinstance(getattr(made, "shape", None), tuple) and _is_on_device(made)


def taken(name: str, what: str, made: Any) -> Any:
    """Returns an array in host memory, or an array on another device as it is."""
    made = _adopted(made)
    if not is_remote(made):
        return numbers(name, what, made)
    _refuse(name, what, made)
    return made


def local(name: str, what: str, array: Any, first: int, last: int) -> Array:
    """Returns rows of an array, in host memory."""
    if isinstance(array, np.ndarray):
        return array[first:last]
    if last - first == array.shape[0]:
        return numbers(name, what, array)
    try:
        # By position: cuDF, as pandas, slices by labels otherwise.
        part = (array.iloc if _has(array, "iloc") else array)[first:last]
    except Exception as error:
        raise _uncopied(name, what, array, error) from error
    return numbers(name, what, part)


def pieces(array: Any) -> Iterator[tuple[int, int]]:
    """Returns ranges of rows that are copied at a time: a single one for an array in host memory."""
    count = int(array.shape[0])
    width = int(np.prod(array.shape[1:])) or 1
    step = max(count, 1) if isinstance(array, np.ndarray) else max(ROWS // width, 1)
    for first in range(0, count, step):
        yield first, min(first + step, count)


def numbers(name: str, what: str, made: Any) -> Array:
    """Returns real numbers as an array of NumPy, without a copy if they are one, or are in a buffer."""
    _refuse(name, what, made)
    try:
        array = host(made)
    except (MemoryError, DrawsError):
        raise
    except Exception as error:
        if isinstance(error, ValueError) and not _is_on_device(made):
            text = f"check `{name}`: the {what} are no array: {error}; give numbers of one shape"
            raise DrawsError(text) from error
        raise _uncopied(name, what, made, error) from error
    if array.dtype.kind not in "fiub" and not _is_small(array.dtype):
        kind = _kind(array)
        raise DrawsError(f"check `{name}`: the {what} are {kind}, not real numbers; give an array of floats")
    return array


def host(made: Any) -> Array:
    """Returns a copy in host memory of an array on another device; otherwise the array itself, or its buffer."""
    if _holds_foreign(made):
        made = [host(part) for part in made]
    if not is_foreign(made):
        return np.asarray(made)
    failures: list[Exception] = []
    for way in _WAYS:
        try:
            array = way(made)
        except MemoryError:
            raise
        except Exception as error:
            failures.append(error)
            continue
        # NumPy wraps what it cannot convert as Python objects.
        if isinstance(array, np.ndarray) and not (array.dtype.kind == "O" and (array.ndim == 0 or _is_on_device(made))):
            return array
    raise failures[0] if failures else TypeError("it has no method that copies it to the host")


def _torch(made: Any) -> Array | None:
    """Returns a tensor of PyTorch without gradient, on the CPU, and in a type that NumPy has."""
    if not all(callable(getattr(made, name, None)) for name in ("detach", "cpu", "numpy")):
        return None
    tensor = made.detach().cpu()
    if small_format(tensor):
        tensor = tensor.float()
    for lazy in ("resolve_conj", "resolve_neg"):
        tensor = getattr(tensor, lazy)() if _has(tensor, lazy) else tensor
    return np.asarray(tensor.numpy())


def _method(method: str, is_safe: Callable[[Any], bool] = lambda _: True) -> Callable[[Any], Any]:
    """Returns a copy by a method without arguments, if there is one."""

    def copied(made: Any) -> Any:
        own = getattr(made, method, None)
        return own() if callable(own) and is_safe(made) else None

    return copied


class _Exported:
    """Array that DLPack of 2023 copies to the CPU, for any version of NumPy."""

    def __init__(self, made: Any) -> None:
        self._made = made

    def __dlpack__(self, **_: Any) -> Any:
        return self._made.__dlpack__(dl_device=self.__dlpack_device__(), copy=True)

    def __dlpack_device__(self) -> tuple[int, int]:
        return 1, 0


def _dlpack(made: Any) -> Any:
    """Returns an array by DLPack, copied if it is on another device."""
    if not _has(made, "__dlpack__"):
        return None
    return np.from_dlpack(_Exported(made) if _is_on_device(made) else made)


# Ways to copy an array to the host, the safest first. `get` and `numpy` mean something else for other objects (a pandas
# Series has `get`), so they are used for arrays on a device only.
_WAYS: tuple[Callable[[Any], Any], ...] = (
    _torch,
    _method("get", lambda made: _is_on_device(made)),
    _method("copy_to_host"),
    _method("asnumpy"),
    lambda made: np.asarray(made) if _has(made, "__array__") or _has(made, "__array_interface__") else None,
    _method("to_numpy"),
    _dlpack,
    _method("numpy", lambda made: _is_on_device(made)),
    lambda made: np.asarray(made),
)


def _adopted(made: Any) -> Any:
    """Returns an object with only ``__cuda_array_interface__`` as an array of an installed library."""
    own = ("detach", "get", "copy_to_host", "asnumpy", "to_numpy", "numpy", "__array__", "__dlpack__")
    if not _has(made, "__cuda_array_interface__") or any(_has(made, name) for name in own):
        return made
    for library, wrap in _LIBRARIES:
        try:
            return wrap(importlib.import_module(library))(made)
        except Exception:  # Not installed, or without a device.
            continue
    return made


_LIBRARIES: tuple[tuple[str, Callable[[Any], Any]], ...] = (
    ("cupy", lambda cupy: cupy.asarray),
    ("numba.cuda", lambda cuda: cuda.as_cuda_array),
    ("torch", lambda torch: lambda made: torch.as_tensor(made, device="cuda")),
)


def _refuse(name: str, what: str, made: Any) -> None:
    """Refuses arrays with incomplete numbers: masked, sparse, with missing values, or without memory."""
    kind = type(made).__name__
    if isinstance(made, np.ma.MaskedArray):
        found, cure = "a masked array", f"fill its masked {what} (filled), or drop them (compressed)"
    elif _has(made, "tocoo"):
        found, cure = f"a sparse array ({kind})", "give a dense one, as in toarray()"
    elif str(getattr(made, "layout", "torch.strided")).startswith("torch.sparse"):
        found, cure = f"a sparse {kind} ({made.layout})", "give a dense one, as in to_dense()"
    elif str(getattr(made, "device", "")) == "meta":
        found, cure = f"a {kind} on the device meta, which holds no numbers", "give one with numbers"
    elif missing := _missing(made):
        count = "1 missing value" if missing == 1 else f"{missing} missing values"
        found, cure = f"a {kind} with {count}", "fill them (fill_null, fillna), or drop them (drop_nulls, dropna)"
    else:
        return
    raise DrawsError(f"check `{name}`: the {what} are {found}; {cure}")


def _missing(made: Any) -> int:
    """Returns the number of missing values of a column of Arrow, Polars or pandas; NaN is not one."""
    try:
        count = getattr(made, "null_count", None)
        if count is not None:
            return int(np.sum(np.asarray(count() if callable(count) else count)))
        types = getattr(made, "dtypes", None)
        types = [types] if types is None or hasattr(types, "na_value") else list(types)
        if any(str(getattr(kind, "na_value", "")) == "<NA>" for kind in types):
            return int(np.sum(np.asarray(made.isna())))
    except Exception:  # Something else by that name.
        return 0
    return 0


def _uncopied(name: str, what: str, made: Any, error: Exception) -> DrawsError:
    """Returns a sentence about the array, its device, and the way of its numbers to the host."""
    place = f" on {_device(made)}" if _is_on_device(made) else ""
    why = (str(error).strip().splitlines() or [type(error).__name__])[0]
    cure = "give its copy in host memory, as by get() of CuPy, detach().cpu().numpy() of PyTorch or copy_to_host() of Numba"
    text = f"the {what} are {type(made).__name__}{place}, which NumPy cannot read ({why})"
    return DrawsError(f"check `{name}`: {text}; {cure}")


def _device(made: Any) -> str:
    device = getattr(made, "device", None)
    return f"the device {device}" if device is not None and not callable(device) else "another device"


def _is_on_device(made: Any) -> bool:
    """Returns whether the host cannot read an array's memory."""
    if _has(made, "__cuda_array_interface__"):
        return True
    kind = getattr(getattr(made, "device", None), "type", "cpu")
    if isinstance(kind, str) and kind != "cpu":
        return True
    try:
        return int(made.__dlpack_device__()[0]) not in _HOST
    except Exception:  # No DLPack, or none on that device.
        return False


def is_foreign(made: Any) -> bool:
    """Returns whether an object is an array of another library, of which NumPy may need a copy."""
    if isinstance(made, np.ndarray | np.generic | list | tuple | str | bytes | int | float):
        return False
    return any(_has(made, name) for name in (*_PROTOCOLS, "detach", "copy_to_host"))


def _holds_foreign(made: Any) -> bool:
    """Returns whether a list, or one in it, has such arrays; one element of each type is inspected."""
    if not isinstance(made, list | tuple):
        return False
    kinds = {type(part): part for part in made}
    return any(is_foreign(part) or _holds_foreign(part) for part in kinds.values())


def _is_small(dtype: np.dtype[Any]) -> bool:
    """Returns whether a dtype is a small number of `ml_dtypes`, of which NumPy has only the name."""
    return bool(_SMALL.fullmatch(dtype.name) or _SMALL_WHOLE.fullmatch(dtype.name))


def _has(made: Any, name: str) -> bool:
    """Returns whether there is such an attribute; one that raises exists (PyTorch, for tensors with a gradient)."""
    try:
        return getattr(made, name, None) is not None
    except Exception:
        return True


def _kind(array: Array) -> str:
    """Returns words for the content of an array without real numbers."""
    if array.dtype.kind != "O":
        return array.dtype.name
    if array.ndim == 0:
        return type(array.item()).__name__
    first = f", the first is {type(array.flat[0]).__name__}" if array.size else ""
    return f"Python objects (dtype object{first})"
