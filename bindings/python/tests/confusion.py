"""The confusion table: honest estimators, known bugs, and what ``trueflight.check`` says of them.

``python bindings/python/tests/confusion.py`` prints it as CSV, which is results/bindings/python-confusion.csv.
"""

import csv
import functools
import sys

import numpy as np
from estimators import (
    ALBEDO,
    CONTROL,
    LENGTH,
    MAJORANT,
    channels,
    coin,
    depth,
    draws_repeated,
    free_flight,
    next_event,
    pairs_averaged,
    product_law,
    ratio,
    ratio_with_lookups,
    residual_ratio,
    rod,
    scattered_once,
    woodcock,
)

import trueflight as tf

# Draws of each check, and the error rate of all of them together.
DRAWS = 2**19
ALPHA = 1e-3

TAU = depth(LENGTH)
RATIO = product_law(MAJORANT)
TWO = [RATIO, product_law(MAJORANT, scale=0.5)]
COLOURS = {key: [law[key] for law in TWO] for key in RATIO}
COLLISIONS = MAJORANT * LENGTH
ONCE = ALBEDO / 4.0 * (1.0 - np.exp(-2.0 * TAU))
# Collisions before 2 or -, the optical depth of one is exponential.
FLIGHT = {"truth": 1.0, "variance": 1.0, "kurtosis": 9.0}

# Estimator, what is known of it, and whether the bug changes the mean, the variance or the order of draws.
HONEST = [
    ("ratio", ratio, RATIO),
    ("ratio, another majorant", functools.partial(ratio, sampling=3.0), product_law(3.0)),
    ("ratio, thin", functools.partial(ratio, scale=0.1), product_law(MAJORANT, scale=0.1)),
    ("ratio with roulette", functools.partial(ratio, bug="roulette"), {"truth": RATIO["truth"], "range": (0.0, 1.0)}),
    ("ratio, single precision", lambda n, rng: ratio(n, rng).astype(np.float32), RATIO),
    ("ratio with lookups", ratio_with_lookups, RATIO | {"lookups": (COLLISIONS, COLLISIONS)}),
    ("residual ratio", residual_ratio, product_law(0.5, CONTROL)),
    ("two colours", channels, COLOURS),
    ("woodcock", woodcock, coin(RATIO["truth"])),
    ("free flight", free_flight, FLIGHT),
    ("scattered once, analogue", scattered_once, coin(ONCE)),
    ("scattered once, next event", next_event, {"truth": ONCE, "range": (0.0, ALBEDO / 2.0)}),
    ("rod", rod, coin(TAU / (2.0 + TAU))),
]

BUGGY = [
    ("ratio", "mean", "1 minus forgotten"),
    ("ratio", "mean", "collision behind the ray"),
    ("ratio", "mean", "first collision skipped"),
    ("ratio", "mean", "looked up at the last collision"),
    ("ratio", "mean", "rate taken for a mean"),
    ("ratio", "mean", "ray ends early"),
    ("ratio", "mean", "walk cut after 3 collisions"),
    ("ratio", "mean", "coarse grid"),
    ("ratio", "mean", "small weights dropped"),
    ("ratio", "variance", "another majorant"),
    ("ratio", "order", "same seed in every pass"),
    ("ratio", "number", "NaN where the weight is tiny"),
    ("ratio with roulette", "mean", "roulette without compensation"),
    ("ratio with lookups", "lookups", "lookup behind the ray counted"),
    ("residual ratio", "mean", "weights clamped to 1"),
    ("residual ratio", "mean", "control forgotten"),
    ("residual ratio", "mean", "residual without its sign"),
    ("two colours", "mean", "colours swapped"),
    ("two colours", "mean", "colours alike"),
    ("woodcock", "mean", "majorant too low"),
    ("woodcock", "mean", "reused random number"),
    ("woodcock", "mean", "position not kept"),
    ("woodcock", "mean", "test the wrong way round"),
    ("woodcock", "mean", "some absorbed photons counted"),
    ("free flight", "mean", "majorant too low"),
    ("free flight", "mean", "position not kept"),
    ("free flight", "mean", "longest flights cut"),
    ("scattered once, analogue", "mean", "albedo swapped"),
    ("scattered once, analogue", "mean", "phase function forgotten"),
    ("scattered once, next event", "mean", "escaped photons scatter"),
    ("scattered once, next event", "mean", "towards the wrong end"),
    ("rod", "mean", "forward preferred"),
    ("rod", "mean", "walk cut after 3 scatterings"),
]

# Bugs that are functions of their own.
OTHER = [
    ("ratio", "variance", "pairs averaged", pairs_averaged),
    ("ratio", "order", "draws repeated", draws_repeated),
]


def entries():
    """Estimator, what it changes, its bug (empty where honest), the callable, and what is known."""
    known = {name: (make, law) for name, make, law in HONEST}
    yield from ((name, "nothing", "", make, law) for name, make, law in HONEST)
    for name, changes, bug in BUGGY:
        make, law = known[name]
        function = make.func if isinstance(make, functools.partial) else make
        yield name, changes, bug, functools.partial(function, bug=bug), law
    yield from ((name, changes, bug, make, known[name][1]) for name, changes, bug, make in OTHER)


def table():
    """A row for each estimator, with its verdict."""
    listed = list(entries())
    for number, (name, changes, bug, make, law) in enumerate(listed):
        # Names are streams: no two estimators have the same random numbers.
        called = f"{name}: {bug}" if bug else name
        verdict = tf.check(
            # A partial function's signature is the function's, in which `bug` comes third.
            lambda n, rng, make=make: make(n, rng),
            **law,
            name=called,
            draws=DRAWS,
            alpha=ALPHA / len(listed),
            seed=1,
        )
        failed = [f["check"] for value in verdict.values for f in value["findings"] if f["verdict"] == "fail"]
        yield {
            "number": number + 1,
            "estimator": name,
            "bug": bug,
            "changes": changes,
            "verdict": verdict.verdict,
            "failed": " ".join(dict.fromkeys(failed)),
            "z": " ".join("" if v["z"] is None else f"{v['z']:.1f}" for v in verdict.values),
            "draws": verdict.draws,
            "reason": verdict.reason,
        }


if __name__ == "__main__":
    rows = list(table())
    writer = csv.DictWriter(sys.stdout, rows[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
