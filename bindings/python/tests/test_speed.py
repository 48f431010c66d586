"""Arrays are judged fast, in place, and while other threads run."""

import threading
import time
import tracemalloc

import numpy as np
import pytest
import speed

import trueflight as tf


def moments(array):
    """Mean, variance and fourth central moment, as one writes them in NumPy."""
    mean = array.mean()
    return mean, array.var(), ((array - mean) ** 4).mean()


def seconds(of):
    """Seconds of one processor."""
    begin = time.process_time()
    of()
    return time.process_time() - begin


@pytest.mark.parametrize("words", ["truth alone", "truth and variance"])
def test_an_array_is_judged_faster_than_numpy_finds_its_moments(words):
    array = np.random.default_rng(1).random(speed.COUNT)
    # In turn: other work on the machine slows both.
    turns = [
        (seconds(lambda: tf.check(array, **speed.KNOWN[words])), seconds(lambda: moments(array)))
        for _ in range(3)
    ]
    judged, plain = (min(times) for times in zip(*turns, strict=True))
    assert judged < plain


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_an_array_is_not_copied(dtype):
    array = np.random.default_rng(1).random(4_000_000).astype(dtype)
    assert allocated(array) < 1e5
    # Numbers that do not lie side by side are copied 2^20 at a time.
    piece = 2**20 * array.itemsize
    assert piece <= allocated(array[::2]) < piece + 1e5


def allocated(array):
    """The most bytes that NumPy has beside the array while it is judged."""
    tracemalloc.start()
    tf.check(array, truth=0.5, range=(0, 1))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak


def test_other_threads_run_while_an_array_is_judged():
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    array = np.random.default_rng(1).random(speed.COUNT)
    thread = threading.Thread(target=count, daemon=True)
    thread.start()
    begin = time.monotonic()
    tf.check(array, truth=0.5, range=(0, 1))
    seconds = time.monotonic() - begin
    stop.set()
    thread.join()
    assert counted[0] > max(5.0, 20.0 * seconds), f"{counted[0]} turns in {seconds:.2f} s"
