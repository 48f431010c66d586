"""Bad input: one clear exception, with the words that name the place and the cure."""

import numpy as np
import pytest

import trueflight as tf

FAIR = np.random.default_rng(1).random(1000)
KNOWN = {"truth": 0.5, "range": (0.0, 1.0)}


class Mine(Exception):
    """An estimator's own."""


def raising(n):
    raise Mine("no medium")


def test_an_exception_of_the_callable_comes_through():
    with pytest.raises(Mine, match="^no medium$"):
        tf.check(raising, truth=0.5)


def test_an_exception_of_an_iterator_comes_through():
    def half():
        yield 0.5
        raise Mine("gone")

    with pytest.raises(Mine, match="^gone$"):
        tf.check(half(), truth=0.5)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_draw_that_is_no_number_fails_by_its_index(bad):
    draws = FAIR.copy()
    draws[417] = bad
    verdict = tf.check(draws, truth=0.5)
    assert verdict.verdict == "fail" and "417" in verdict.reason
    assert tf.check(lambda n: np.full(n, bad), truth=0.5).verdict == "fail"


@pytest.mark.parametrize(
    "source, words",
    [
        ("abc", "the draws are str"),
        (b"abc", "the draws are bytes"),
        (["a", "b"], "not real numbers"),
        (iter("ab"), "not real numbers"),
        (lambda n: "text", "not real numbers"),
        (lambda n: None, "the draws are NoneType, not real numbers"),
        (lambda n: {"a": 1}, "the draws are dict, not real numbers"),
        (FAIR.astype(object), r"the draws are Python objects \(dtype object, the first is float\)"),
        (iter([None]), r"the draws are Python objects \(dtype object, the first is NoneType\)"),
        (np.ma.masked_less(FAIR, 0.1), r"a masked array; fill its masked draws \(filled\), or drop them \(compressed\)"),
        (np.array([1 + 2j]), "the draws are complex128, not real numbers"),
        (np.array(["2026-01-01"], dtype="datetime64[D]"), "not real numbers"),
        ([[1.0], [1.0, 2.0]], "give numbers of one shape"),
        (7, "draws cannot come from int"),
        (None, "draws cannot come from NoneType"),
    ],
)
def test_what_is_no_draws_is_a_type_error(source, words):
    with pytest.raises(tf.DrawsError, match=words) as caught:
        tf.check(source, truth=0.5, name="mine")
    assert isinstance(caught.value, TypeError) and isinstance(caught.value, tf.Error)
    assert str(caught.value).startswith("check `mine`: ") and ";" in str(caught.value)


@pytest.mark.parametrize(
    "source, words",
    [
        (lambda n: np.zeros(3), r"draws of shape \(3,\), but 65536 draws were asked for; give .* \(65536,\)"),
        (lambda n: 0.5, r"draws of shape \(\), but 65536"),
        (lambda n: np.zeros((n, 1, 1)), r"draws of shape \(65536, 1, 1\)"),
        (lambda n: (np.zeros(n), np.zeros(2)), r"lookups of shape \(2,\) for 65536 draws"),
        (np.float64(0.5), r"draws of shape \(\)"),
        (np.zeros((5, 0)), r"draws of shape \(5, 0\)"),
        (np.array([]), "there are no draws; make one at least"),
        ([], "there are no draws"),
        (iter([]), "there are no draws"),
        (iter([np.zeros(4), np.zeros((4, 2))]), "draws of 2 values without lookups after 1 value"),
        (np.zeros((3, 100_000)), r"3 draws of 100000 values each, .*: did you mean draws\.T\?"),
        (np.zeros((1, 2)), r"1 draw of 2 values each, fewer draws than values"),
        (np.zeros((100, 65)), "draws of 65 values each; 64 are judged together at most"),
        (lambda n: np.zeros((n, 65)), "draws of 65 values each; 64 are judged together at most"),
        (np.zeros((9, 3)), "2 numbers for the truth, but a draw has 3 values"),
        ((FAIR, FAIR), r"nothing is known of the lookups; give lookups=\(mean, variance\)"),
    ],
)
def test_a_wrong_shape_is_an_error(source, words):
    truth = [0.5, 0.5] if isinstance(source, np.ndarray) and source.shape == (9, 3) else 0.5
    with pytest.raises(tf.Error, match=words):
        tf.check(source, truth=truth)


@pytest.mark.parametrize(
    "known, words",
    [
        ({}, r"the truth is not known; give it by truth=…"),
        ({"truth": np.nan}, "truth = NaN is not a finite number"),
        ({"truth": "half"}, "truth = 'half' is no number"),
        ({"truth": "0.5"}, "truth = '0.5' is no number"),
        ({"truth": ["0.5"]}, "is no number"),
        ({"truth": [None]}, r"truth = \[None\] is no number"),
        ({"truth": 10**400}, "truth = 1000.*… is too large for a float64"),
        ({"truth": 10**5000}, "truth = <int> is too large for a float64"),
        ({"truth": np.ma.masked_less([0.5, 1.0], 0.7)}, "truth is a masked array; fill or drop"),
        ({"truth": 0.5, "tolerance": "0.1"}, "tolerance = '0.1' is no number"),
        ({"truth": 0.5, "tolerance": 10**400}, "tolerance = 1000.*… is too large"),
        ({"truth": 0.5, "alpha": None}, "alpha = None is no number; give a number"),
        ({"truth": 0.5, "batch": 10**400}, "batch = 1000.*… is too large for a float64"),
        ({"truth": 0.5, "name": 0}, "name = 0 is no text; give one"),
        ({"truth": [[0.5]]}, r"truth has shape \(1, 1\)"),
        ({"truth": 0.5, "variance": -1.0}, "variance = -1 is not a finite number, 0 or more"),
        ({"truth": 0.5, "kurtosis": 0.5}, "kurtosis = 0.5 is not a finite number, 1 or more"),
        ({"truth": 0.5, "range": (0.6, 1.0)}, "does not have the truth 0.5 inside"),
        ({"truth": 0.5, "range": 1.0}, "range takes 2 numbers, the lower and the upper end, but was given 1 number"),
        ({"truth": 0.5, "range": (0.0, 1.0), "variance": 9.0}, "a variance of 9e0 is impossible in the range"),
        ({"truth": 0.0}, "a truth of 0 has no relative tolerance"),
        ({"truth": 0.5, "alpha": 2.0}, "alpha = 2 is not a probability above 0 and below 1; give another"),
        ({"truth": 0.5, "tolerance": 0.0}, "tolerance = 0 is not a finite number above 0"),
        ({"truth": 0.5, "lookups": (4.0, 4.0)}, r"does not tell its lookups; give the pair \(draws, lookups\)"),
        ({"truth": 0.5, "batch": 0}, "batch = 0 is not a whole number from 1 to"),
        ({"truth": 0.5, "draws": 1.5}, "draws = 1.5; give a whole number"),
        ({"truth": 0.5, "draws": 0}, "draws = 0; give a whole number from 1"),
        ({"truth": 0.5, "seed": -1}, "seed = -1; give a whole number"),
        ({"truth": 0.5, "estimator": "ratio"}, "without a case"),
        ({"case": "transmittance/eq21-overview"}, "a case without an estimator"),
        ({"case": "transmittance/eq21-overview", "estimator": "rato"}, "no estimator is called `rato`"),
        ({"case": "transmittance/eq21-overview", "estimator": "ratio"}, "is swept over sampling"),
        (
            {"case": "transmittance/eq21-overview", "estimator": "ratio", "sampling": 1.0, "truth": 0.5},
            r"the truth is given twice, by a number and by case=…; .* add mean_only=True",
        ),
        (
            {"case": "transmittance/eq21-overview", "estimator": "ratio", "sampling": np.nan},
            "sampling = NaN is not a finite number above 0",
        ),
        (
            {"case": "transmittance/eq21-overview", "estimator": "ratio", "sampling": np.inf},
            "sampling = inf is not a finite number above 0",
        ),
        (
            {"case": "transmittance/eq21-overview", "estimator": "ratio", "sampling": -1},
            "sampling = -1 is not a finite number above 0",
        ),
        ({"case": "title = 1\n", "estimator": "ratio"}, "mistake"),
        ({"case": 7, "estimator": "ratio"}, "a case cannot be int"),
    ],
)
def test_what_makes_no_sense_is_an_error_with_a_cure(known, words):
    with pytest.raises(tf.Error, match=words):
        tf.check(FAIR, **known)


def test_a_case_that_is_not_there_is_a_file_not_found():
    for ask in (tf.predict, tf.run, lambda case: tf.check(FAIR, case=case, estimator="ratio")):
        with pytest.raises(FileNotFoundError, match="no/such-case") as caught:
            ask("no/such-case")
        assert isinstance(caught.value, tf.CaseNotFound) and isinstance(caught.value, tf.Error)


def test_a_mistake_in_a_case_is_shown_in_place():
    text = 'title = "t"\n[problem.transmittance]\nmedium.constant = { extinktion = 0.5 }\nspan = [0, 4]\n'
    with pytest.raises(tf.Error, match="extinktion") as caught:
        tf.predict(text)
    assert "case.toml:3" in str(caught.value) and "^" in str(caught.value)


LOOP: dict = {}
LOOP["problem"] = LOOP


@pytest.mark.parametrize(
    "case, words",
    [
        ({"title": None}, "^title = None says nothing; leave the key out"),
        ({"title": {1, 2}}, r"^title = \{1, 2\} is set; a case has texts, numbers, lists and dicts"),
        ({"draws": float("nan")}, "^draws = nan is not a finite number"),
        ({"problem": {"transmittance": {"span": [0, np.array([1.0, np.inf])]}}}, r"^problem.transmittance.span\[1\]\[1\] = inf"),
        ({"draws": 10**400}, "^draws = 1000.* is no whole number of 64 bits"),
        ({"problem": object()}, "^problem = <object object at .*> is object; a case has texts"),
        ({"problem": {1: 2}}, "^problem has the key 1; keys of a case are texts"),
        (LOOP, "nested too deep"),
        ({"title": "t", "problm": {}}, "problm"),
    ],
)
def test_a_dict_that_is_no_case_is_an_error_with_its_place(case, words):
    with pytest.raises(tf.Error, match=words):
        tf.predict(case)


@pytest.mark.parametrize(
    "arguments, words",
    [
        ({"draws": 1}, "draws = 1; give a whole number from 2 to 1e"),
        ({"draws": "many"}, "draws = 'many'"),
        ({"alpha": 0.0}, "alpha = 0.0 is not a probability"),
        ({"threads": 0}, "threads = 0; give a whole number from 1 to 1024"),
        ({"filter": "nothing-like-it"}, "keeps none of the experiments"),
        ({"alpha": None}, "alpha = None is not a probability"),
        ({"filter": 3}, "filter = 3 is no text; give a pattern"),
        ({"filter": "***"}, "a filter is a pattern"),
    ],
)
def test_wrong_options_of_a_run(arguments, words):
    with pytest.raises(tf.Error, match=words):
        tf.run("transmittance/eq21-overview", **arguments)


def test_wrong_sweeps():
    with pytest.raises(tf.Error, match="nothing cannot be swept; give the values of one of: sampling"):
        tf.sweep("transmittance/eq21-overview")
    with pytest.raises(tf.Error, match="colour cannot be swept"):
        tf.sweep("transmittance/eq21-overview", colour=[1.0])
    words = "^sampling sweeps nothing here: .*; give the values of one of: sampling_scale, albedo, density"
    for draws in (None, 100):
        with pytest.raises(tf.Error, match=words):
            tf.sweep("slab/known-bugs", sampling=[1.0, 2.0], draws=draws)
    with pytest.raises(tf.Error, match="are no numbers"):
        tf.sweep("transmittance/eq21-overview", sampling=["a"])
    with pytest.raises(tf.Error):
        tf.sweep("transmittance/eq21-overview", sampling=[-1.0])
