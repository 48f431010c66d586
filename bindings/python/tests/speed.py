"""How fast arrays are judged: ``python bindings/python/tests/speed.py``."""

import time

import numpy as np

import trueflight as tf

COUNT = 10_000_000
KNOWN = {
    "truth alone": {"truth": 0.5},
    "truth and range": {"truth": 0.5, "range": (0.0, 1.0)},
    "truth and variance": {"truth": 0.5, "variance": 1.0 / 12.0},
    "truth, variance, kurtosis": {"truth": 0.5, "variance": 1.0 / 12.0, "kurtosis": 1.8},
}


def speeds():
    """What is known, the dtype, MB of the array a second of one processor, and of the clock: the best of three."""
    draws = np.random.default_rng(1).random(COUNT)
    for dtype in (np.float64, np.float32):
        array = draws.astype(dtype)
        for words, known in KNOWN.items():
            times = []
            for _ in range(3):
                begin, clock = time.process_time(), time.perf_counter()
                assert tf.check(array, **known).passed
                times.append((time.process_time() - begin, time.perf_counter() - clock))
            seconds, wall = (min(column) for column in zip(*times, strict=True))
            yield words, array.dtype.name, array.nbytes / 1e6 / seconds, array.nbytes / 1e6 / wall


if __name__ == "__main__":
    for words, dtype, speed, clock in speeds():
        print(f"{words:26} {dtype}  {speed:7.0f} MB/s of a processor  {clock:7.0f} MB/s by the clock")
