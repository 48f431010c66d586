"""Stand-ins for arrays on a GPU: they hold NumPy arrays, and refuse and answer as the libraries do."""

import types

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin


class Held:
    """An array of a library: shape, slices, and the numbers of every copy to the host."""

    def __init__(self, values, copied=None):
        self._values = np.asarray(values)
        self.copied = [] if copied is None else copied

    @property
    def shape(self):
        return self._values.shape

    @property
    def ndim(self):
        return self._values.ndim

    @property
    def size(self):
        return self._values.size

    @property
    def dtype(self):
        return self._values.dtype

    def __len__(self):
        return len(self._values)

    def _like(self, values):
        return type(self)(values, self.copied)

    def __getitem__(self, key):
        return self._like(self._values[key._values if isinstance(key, Held) else key])

    def _copy(self):
        self.copied.append(self._values.size)
        return self._values.copy()


class Cupy(Held, NDArrayOperatorsMixin):
    """cupy.ndarray of CuPy 13: an implicit copy is a TypeError, `get` the explicit one."""

    device = "<CUDA Device 0>"

    @property
    def __cuda_array_interface__(self):
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (1, False), "version": 3}

    def __dlpack__(self, **arguments):
        raise BufferError("the array is on a device of CUDA")

    def __dlpack_device__(self):
        return 2, 0

    def __array__(self, dtype=None, copy=None):
        raise TypeError("Implicit conversion to a NumPy array is not allowed. Please use `.get()`")

    def get(self):
        return self._copy()

    def __array_ufunc__(self, function, method, *inputs, **arguments):
        values = [part._values if isinstance(part, Cupy) else part for part in inputs]
        if "out" in arguments:
            arguments["out"] = tuple(part._values for part in arguments["out"])
        return self._like(getattr(function, method)(*values, **arguments))

    def __setitem__(self, key, value):
        self._values[key._values if isinstance(key, Held) else key] = value._values if isinstance(value, Held) else value


def cupy():
    """The module `cupy`, as far as the manual uses it."""

    class Generator:
        def __init__(self, seed):
            self._rng = np.random.default_rng(seed)

        def exponential(self, scale, size):
            return Cupy(self._rng.exponential(scale, size))

    return types.SimpleNamespace(
        zeros=lambda size: Cupy(np.zeros(size)),
        ones=lambda size: Cupy(np.ones(size)),
        arange=lambda size: Cupy(np.arange(size)),
        asarray=Cupy,
        cos=np.cos,
        random=types.SimpleNamespace(default_rng=Generator),
    )


class Torch(Held):
    """torch.Tensor of PyTorch 2: on a device, with a gradient, or in a format of its own."""

    def __init__(self, values, copied=None, device="cuda:0", requires_grad=False, kind=None, layout="torch.strided"):
        super().__init__(values, copied)
        self.device = Device(device)
        self.requires_grad, self.layout = requires_grad, layout
        self.kind = kind

    @property
    def dtype(self):
        return self.kind or f"torch.{self._values.dtype.name}"

    def _like(self, values, **changed):
        own = {"device": str(self.device), "requires_grad": self.requires_grad, "kind": self.kind, "layout": self.layout}
        return Torch(values, self.copied, **(own | changed))

    def detach(self):
        return self._like(self._values, requires_grad=False)

    def cpu(self):
        if self.device.type == "meta":
            raise NotImplementedError("Cannot copy out of meta tensor; no data!")
        return self._like(self._copy() if self.device.type != "cpu" else self._values, device="cpu")

    def float(self):
        return self._like(self._values.astype(np.float32), kind=None)

    def numpy(self):
        if self.device.type != "cpu":
            raise TypeError(f"can't convert {self.device} device type tensor to numpy. Use Tensor.cpu() first.")
        if self.requires_grad:
            raise RuntimeError("Can't call numpy() on Tensor that requires grad. Use tensor.detach().numpy() instead.")
        if self.kind is not None:
            raise TypeError("Got unsupported ScalarType BFloat16")
        return self._values

    def __array__(self, dtype=None, copy=None):
        return self.numpy()

    @property
    def __cuda_array_interface__(self):
        if self.device.type != "cuda":
            raise AttributeError("not on CUDA")
        if self.requires_grad:
            raise RuntimeError("Can't get __cuda_array_interface__ on Variable that requires grad.")
        return {"shape": self.shape, "typestr": "<f8", "data": (1, False), "version": 2}

    def __dlpack_device__(self):
        return {"cpu": 1, "cuda": 2, "mps": 8}[self.device.type], 0


class Device:
    """torch.device."""

    def __init__(self, name):
        self.name, self.type = name, name.partition(":")[0]

    def __str__(self):
        return self.name


class Numba(Held):
    """numba.cuda.DeviceNDArray: slices forwards only."""

    @property
    def __cuda_array_interface__(self):
        return {"shape": self.shape, "typestr": self.dtype.str, "data": (1, False), "version": 3}

    def copy_to_host(self):
        if any(stride < 0 for stride in self._values.strides):
            raise NotImplementedError("D->H copy not implemented for negative strides")
        return self._copy()


class Exchanged(Held):
    """An array of the array API on a device: DLPack of 2023 and nothing else."""

    device = "gpu:1"

    def __dlpack_device__(self):
        return 14, 1

    def __dlpack__(self, *, dl_device=None, copy=None, **arguments):
        if dl_device != (1, 0):
            raise BufferError("the array is on gpu:1")
        return self._copy().__dlpack__()


class Bare:
    """What has `__cuda_array_interface__` and nothing else."""

    def __init__(self, values):
        self._values = values
        self.__cuda_array_interface__ = {"shape": values.shape, "typestr": "<f8", "data": (1, False), "version": 3}


class Stuck(Held):
    """An array on a device without a way to the host."""

    device = "npu:3"

    def __dlpack_device__(self):
        return 12, 3

    def __dlpack__(self, **arguments):
        raise BufferError("only on the device")


class Sparse:
    """A sparse matrix of SciPy or CuPy."""

    shape = (4, 4)

    def tocoo(self):
        return self

    def __iter__(self):
        return iter([self])
