"""``trueflight.check``: sources of draws, what is said of them, and mistakes."""

import array
import math
import pickle

import numpy as np
import pytest

import trueflight as tf

MEAN = math.exp(-1.0)
COIN = {"truth": MEAN, "variance": MEAN * (1.0 - MEAN), "range": (0.0, 1.0)}


def flights(n, rng):
    """Does a photon fly farther than 1?"""
    return (rng.exponential(size=n) > 1.0).astype(float)


@pytest.fixture
def draws():
    return flights(200_000, np.random.default_rng(1))


class Dlpack:
    """What has DLPack and nothing else."""

    def __init__(self, values):
        self.values = values

    def __dlpack__(self, **arguments):
        return self.values.__dlpack__(**arguments)

    def __dlpack_device__(self):
        return self.values.__dlpack_device__()


def sources(draws):
    """The same draws in every form that there is."""
    wide = np.zeros((len(draws), 2))
    wide[:, 0] = draws
    return {
        "float64": draws,
        "strided": wide[:, 0],
        "backwards": draws[::-1][::-1],
        "column": draws[:, None],
        "big-endian": draws.astype(">f8"),
        "longdouble": draws.astype(np.longdouble),
        "float32": draws.astype(np.float32),
        "float16": draws.astype(np.float16),
        "bool": draws.astype(bool),
        "int8": draws.astype(np.int8),
        "read-only": np.frombuffer(draws.tobytes()),
        "list": draws.tolist(),
        "tuple": tuple(draws.tolist()),
        "buffer": array.array("d", draws),
        "memoryview": memoryview(draws),
        "dlpack": Dlpack(draws),
        "iterator": iter(draws.tolist()),
        "iterator of arrays": iter(np.array_split(draws, 7)),
        "generator": (float(x) for x in draws),
    }


@pytest.mark.parametrize("form", sources(np.zeros(4)))
def test_every_form_of_draws_has_the_same_verdict(form, draws):
    expected = tf.check(draws, **COIN, rounding=1e-3, name="all", draws=len(draws))
    verdict = tf.check(sources(draws)[form], **COIN, rounding=1e-3, name="all", draws=len(draws))
    assert verdict.to_dict() == expected.to_dict()
    assert verdict.passed and verdict.draws == 200_000


def test_numbers_are_those_of_numpy(draws):
    verdict = tf.check(draws, **COIN)
    assert verdict.mean == pytest.approx(draws.mean(), rel=1e-13)
    assert verdict.variance == pytest.approx(draws.var(ddof=1), rel=1e-11)
    error = math.sqrt(COIN["variance"] / len(draws))
    assert verdict.standard_error == pytest.approx(error, rel=1e-12)
    assert verdict.z == pytest.approx((draws.mean() - MEAN) / error, rel=1e-9)
    assert (verdict.truth, verdict.predicted_variance) == (MEAN, COIN["variance"])


def test_a_bias_fails_with_the_judges_words(draws):
    verdict = tf.check(draws * 1.05, truth=MEAN, range=(0.0, 2.0), name="biased")
    assert (verdict.verdict, verdict.passed, bool(verdict)) == ("fail", False, False)
    with pytest.raises(AssertionError, match=r"check `biased`: fail: the mean is off by \+5"):
        verdict.assert_pass()
    text = str(verdict)
    assert all(word in text for word in ("\n  draws ", "\n  mean ", "\n  gate ", "\n  verdict "))
    page = verdict._repr_html_()
    assert "fail" in page and page.count("<tr>") == len(text.split("\n")) - 1
    assert repr(verdict).startswith("<Verdict of 'biased': fail after 200,000 draws: the mean is off")


def test_html_is_escaped():
    verdict = tf.check(np.ones(100), truth=1.0, variance=0.0, name="<script>&")
    assert "&lt;script&gt;&amp;" in verdict._repr_html_() and "<script>" not in verdict._repr_html_()


def test_assert_pass_answers_the_verdict_and_a_verdict_is_pickled(draws):
    verdict = tf.check(draws, **COIN).assert_pass()
    assert pickle.loads(pickle.dumps(verdict)).to_dict() == verdict.to_dict()


def test_a_callable_is_asked_until_all_is_decided():
    asked = []

    def make(n, rng):
        asked.append(n)
        return flights(n, rng)

    verdict = tf.check(make, **COIN)
    assert verdict.passed and verdict.name == "make" and verdict.draws == sum(asked) < 2**24
    again = tf.check(make, **COIN)
    assert again.mean == verdict.mean, "the seed is the same"
    assert tf.check(make, **COIN, seed=2).mean != verdict.mean
    exactly = tf.check(make, **COIN, draws=100_001)
    assert exactly.draws == 100_001


def test_callables_take_a_generator_if_they_want_one():
    own = np.random.default_rng(5)
    assert tf.check(lambda n: flights(n, own), **COIN).passed
    assert tf.check(own.random, truth=0.5, range=(0, 1)).passed
    assert tf.check(lambda n, scale=1.0: scale * own.random(n), truth=0.5, range=(0, 1)).passed
    assert tf.check(lambda n, *, rng=None: own.random(n), truth=0.5, range=(0, 1)).passed


def test_an_endless_iterator_stops_when_all_is_decided():
    rng = np.random.default_rng(3)
    verdict = tf.check(iter(lambda: float(rng.random()), None), truth=0.5, range=(0, 1), tolerance=0.05)
    assert verdict.passed and verdict.draws < 200_000


def test_several_values_have_numbers_each():
    def colours(n, rng):
        return rng.random((n, 2)) ** [1, 2]

    verdict = tf.check(colours, truth=[1 / 2, 1 / 3], variance=[1 / 12, 4 / 45], range=(0, 1))
    assert verdict.passed and len(verdict.values) == 2
    np.testing.assert_allclose(verdict.truth, [1 / 2, 1 / 3])
    assert verdict.mean.shape == (2,) and verdict.lookups.shape == (2,)
    wrong = tf.check(colours, truth=[1 / 2, 1 / 2], range=(0, 1))
    assert wrong.verdict == "fail" and wrong.reason.startswith("value 1: the mean is off")


def test_theory_of_a_case_gives_mean_variance_and_lookups():
    def ratio(n, rng, factor=1.0):
        # Homogeneous, extinction 0.5 on [0, 4], sampling extinction 1: each collision halves the weight.
        lookups = rng.poisson(4.0, n)
        return factor * 0.5**lookups, lookups

    case = {
        "title": "homogeneous",
        "problem": {
            "transmittance": {
                "medium": {"constant": {"extinction": np.float64(0.5)}},
                "span": np.array([0, 4]),
                "estimators": [{"ratio": {"sampling": {"constant": {"value": 1}}}}],
            }
        },
    }
    verdict = tf.check(ratio, case=case, estimator="ratio")
    assert verdict.passed
    assert verdict.truth == pytest.approx(math.exp(-2.0), rel=1e-14)
    assert verdict.predicted_variance == pytest.approx(math.exp(-3.0) - math.exp(-4.0), rel=1e-12)
    assert verdict.lookups == pytest.approx(4.0, rel=0.02)
    assert tf.check(lambda n, rng: ratio(n, rng)[0], case=case, estimator="ratio").lookups is None
    assert tf.check(lambda n, rng: ratio(n, rng, 1.02), case=case, estimator="ratio").verdict == "fail"
    swept = tf.check(ratio, case=case, estimator="ratio", sampling=3.0)
    assert swept.verdict == "fail", "the variance is another with another sampling extinction"
    mean = tf.check(lambda n, rng: ratio(n, rng)[0], case=case, estimator="ratio", mean_only=True, range=(0, 1))
    assert mean.passed and mean.predicted_variance is None


def test_single_precision_is_no_bias():
    rng = np.random.default_rng(1)
    draws = (rng.random(300_000) * 1e-6 + 1.0).astype(np.float32)
    assert tf.check(draws, truth=1.0 + 5e-7, range=(1.0, 1.0 + 1e-6)).passed


def test_draws_that_depend_on_each_other_are_judged_as_averages():
    halves = np.tile([0.25, 0.75], 50_000)
    assert "not independent" in tf.check(halves, truth=0.5, range=(0, 1)).reason
    pairs = np.random.default_rng(1).random(500_000)
    antithetic = np.stack([pairs, 1.0 - pairs**2], axis=1).ravel()
    mean = (0.5 + 2.0 / 3.0) / 2.0
    assert tf.check(antithetic, truth=mean, range=(0, 1), batch=2).passed
