"""Whole distributions, channels and swept values of a case."""

import math
from pathlib import Path

import numpy as np
import pytest

import trueflight as tf

FIELD = Path(__file__).parents[3] / "tests/data/field"
FLIGHTS = FIELD / "13-free-flight-law/ff.toml"
THREE = FIELD / "03-channels-in-one-file/three.toml"


def flights(n, rng):
    """Flights through an extinction of 0.5 on [0, 1] and 2 on [1, 2], without an end."""
    depth = rng.exponential(size=n)
    return np.where(depth < 0.5, depth / 0.5, 1.0 + (depth - 0.5) / 2.0)


def judged(make, **more):
    return tf.check(make, case=FLIGHTS, estimator="woodcock", **more)


def test_flights_of_two_lengths_fail_whose_mean_and_variance_are_right():
    near, far = math.exp(-0.5), math.exp(-2.0)
    mean = 2 * (1 - near) + near * (1 - far) / 2
    square = 2 * (4 - 6 * near + near * ((1 - far) / 2 + (1 - 3 * far) / 4))
    spread = math.sqrt(square - mean**2)
    verdict = judged(lambda n, rng: mean + spread * rng.choice([-1.0, 1.0], n))
    assert verdict.verdict == "fail"
    assert "the distribution of the distances differs from theory" in verdict.reason
    assert abs(verdict.z) < 4 and verdict.p_values["distances"] < 1e-9
    fixed = np.fromfile(FIELD / "13-free-flight-law/two.f64")
    assert "the distribution of the distances" in judged(fixed).reason


@pytest.mark.parametrize("left", [2.0, 2.5, np.inf, -1.0, float(np.finfo(np.float32).max)])
def test_every_way_to_write_a_flight_that_leaves_is_read(left):
    draws = flights(200_000, np.random.default_rng(1))
    draws[draws >= 2.0] = left
    wide = {"tolerance": 0.05, "variance_tolerance": 0.1}
    assert judged(draws, **wide).passed
    assert judged(draws.astype(np.float32), **wide).passed
    assert set(judged(draws).p_values) == {"distances", "depth", "resolution"}


@pytest.mark.parametrize("left", [0.0, np.nan, -2.0])
def test_a_wrong_way_is_named(left):
    draws = flights(200_000, np.random.default_rng(1))
    draws[draws >= 2.0] = left
    verdict = judged(draws)
    assert verdict.verdict == "fail" and "write a flight that leaves as 2" in verdict.reason
    assert "off by" not in verdict.reason


def test_what_is_not_tested_is_said():
    draws = flights(200_000, np.random.default_rng(1))
    assert "of theory the mean alone is taken" in str(judged(draws, mean_only=True))
    assert "averages of draws have another one" in str(judged(draws, batch=16))
    assert "draws are too few" in str(judged(draws[:600]))


def test_lookups_of_another_distribution_fail():
    case = """
title = "collisions"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
estimators = [{ ratio = { sampling.constant.value = 2 } }]
"""

    def draws(n, rng, coin=False):
        count = rng.poisson(4.0, n)
        return 0.75**count, rng.choice([2, 6], n) if coin else count

    right = tf.check(draws, case=case, estimator="ratio", draws=200_000)
    assert right.verdict != "fail" and "counts" in right.p_values
    wrong = tf.check(lambda n, rng: draws(n, rng, True), case=case, estimator="ratio", draws=200_000)
    assert wrong.verdict == "fail" and "the distribution of the lookups" in wrong.reason


def test_all_channels_are_one_draw():
    draws = np.load(FIELD / "03-channels-in-one-file/draws.npy")
    verdict = tf.check(draws, case=THREE, estimator="spectral-mis")
    assert verdict.channels == ["channel 1", "channel 2", "channel 3"]
    assert len(verdict.values) == 3 and (np.abs(verdict.z) < 4).all()
    assert verdict.verdict == "inconclusive" and verdict.reason.startswith("channel 1: ")
    luminance = np.column_stack([draws, draws.mean(axis=1)])
    assert len(tf.check(luminance, case=THREE, estimator="spectral-mis").values) == 4
    with pytest.raises(tf.Error, match="a draw has 2 values, but the case has 4 channels"):
        tf.check(draws[:, :2], case=THREE, estimator="spectral-mis")


def test_any_swept_value_is_taken_and_the_nearest_on_request():
    case = """
title = "swept"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sweep.sampling.values = [0.5, 1.0, 2.0]
estimators = [{ ratio = {} }, { woodcock = {} }]
"""

    def draws(n, rng):
        return (1 - 0.5 / 0.7) ** rng.poisson(1.4, n)

    verdict = tf.check(draws, case=case, estimator="ratio", sampling=0.7)
    assert verdict.passed and "sampling = 0.7" in str(verdict)
    nearest = tf.check(draws, case=case, estimator="ratio", sampling=0.7, nearest=True)
    assert nearest.verdict == "fail" and "the value of the sweep nearest to 0.7" in str(nearest)
    with pytest.raises(tf.Error, match="nearest value of the sweep is 0.5"):
        tf.check(draws, case=case, estimator="woodcock", sampling=0.4)
    with pytest.raises(tf.Error, match=r"swept over sampling: 0\.5, 1, 2"):
        tf.check(draws, case=case, estimator="ratio")
    with pytest.raises(tf.Error, match="nearest without a value"):
        tf.check(draws, case=case, estimator="ratio", nearest=True)
