"""``predict``, ``run`` and ``sweep``: columns, threads, progress, Ctrl-C and the GIL."""

import _thread
import math
import threading
import time

import numpy as np
import pytest

import trueflight as tf
from trueflight._cases import _Line

CASE = """
title = "Homogeneous"
draws = 1e5
[problem.transmittance]
medium.constant = { extinction = 0.5 }
span = [0, 4]
estimators = [{ ratio = { sampling.constant.value = 1.0 } }, { woodcock = { sampling.constant.value = 1.0 } }]
"""
LONG = "transmittance/eq21-overview"


def same(one, other):
    timed = ("seconds", "ns_per_lookup")
    assert one.keys() == other.keys()
    for name in one.keys() - set(timed):
        if isinstance(one[name], list):
            assert one[name] == other[name]
        else:
            np.testing.assert_array_equal(one[name], other[name])


def test_theory_in_columns():
    found = tf.predict(CASE)
    assert found["estimator"] == ["ratio", "woodcock"] and found["channel"] == ["", ""]
    truth = math.exp(-2.0)
    np.testing.assert_allclose(found["truth"], truth, rtol=1e-14)
    np.testing.assert_allclose(found["predicted_variance"], [math.exp(-3) - math.exp(-4), truth * (1 - truth)])
    assert np.isnan(found["mean"]).all() and found["seed"].dtype == np.int64
    assert all(len(column) == 2 for column in found.values())


def test_a_run_is_judged_and_does_not_depend_on_threads():
    one = tf.run(CASE, threads=1)
    assert one["verdict"] == ["pass", "pass"] and (np.abs(one["z_mean"]) < 5.0).all()
    same(one, tf.run(CASE, threads=3))
    assert tf.run(CASE, seed=2)["mean"][0] != one["mean"][0]
    few = tf.run(CASE, draws=2e4, filter="ratio")
    assert few["draws"].tolist() == [20_000] and few["estimator"] == ["ratio"]


def test_cases_as_text_path_dict_and_name(tmp_path):
    text = tf.predict(CASE)
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    constant = {"sampling": {"constant": {"value": np.float32(1.0)}}}
    body = {"medium": {"constant": {"extinction": 0.5}}, "span": np.array([0.0, 4.0])}
    problem = {**body, "estimators": [{"ratio": constant}, {"woodcock": constant}]}
    case = {"title": "Homogeneous", "draws": 1e5, "problem": {"transmittance": problem}}
    for other in (path, str(path), tmp_path, case):
        same(text, tf.predict(other))
    assert LONG in tf.cases()
    assert set(tf.predict(LONG)["case"]) == {LONG}


def test_short_forms_in_a_dict():
    problem = {"medium": 0.5, "span": [0, 4], "sampling": np.float64(1.0), "estimators": ["ratio", "woodcock"]}
    same(tf.predict({"title": "Homogeneous", "draws": 1e5, "problem": {"transmittance": problem}}), tf.predict(CASE))
    swept = {"medium": 0.5, "span": [0, 4], "sweep": {"sampling": [1, 2]}, "estimators": "ratio"}
    assert tf.predict({"title": "x", "problem": {"transmittance": swept}})["swept"].tolist() == [1.0, 2.0]
    with pytest.raises(tf.Error, match="write `sampling = 2` or `sampling.constant.value = 2`"):
        tf.predict({"title": "x", "problem": {"transmittance": problem | {"sampling": {"value": 2}}}})


def test_a_sweep_takes_the_place_of_the_cases_own():
    found = tf.sweep(LONG, sampling=np.array([1.5, 2.5]), filter="ratio")
    assert found["swept"].tolist() == [1.5, 2.5] and np.isnan(found["mean"]).all()
    drawn = tf.sweep(CASE.replace("sampling.constant.value = 1.0", ""), sampling=[1.0, 2.0], draws=4e5)
    assert drawn["swept"].tolist() == [1.0, 2.0, 1.0, 2.0] and set(drawn["verdict"]) == {"pass"}
    dense = tf.sweep(CASE, density=[1.0, 3.0], filter="ratio")
    np.testing.assert_allclose(dense["truth"], np.exp([-2.0, -6.0]), rtol=1e-13)


def test_the_best_sampling_extinction_is_searched():
    found = tf.predict(LONG, optimum=True, filter="ratio")
    assert np.isfinite(found["best_sampling"]).all() and (found["best_fom"] >= found["predicted_fom"]).all()
    assert set(found["best_kind"]) == {"90 % of the limit"} and (found["best_limit"] > found["best_fom"]).all()


def test_setup_lookups_are_charged_to_the_draws_of_a_ray():
    for head, draws in (("", 1), ("draws_per_ray = 8", 8)):
        case = f"""
            title = "Eq. 21"
            {head}
            [problem.transmittance]
            volume.eq21 = {{}}
            ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }}
            estimators = [{{ double = {{ sampling = 1, control.explorers.points = 20 }} }}]
        """
        found = tf.predict(case, filter="double")
        assert found["setup_lookups"].tolist() == [20] and found["draws_per_ray"].tolist() == [draws]
        cost = found["predicted_lookups"] + 20 / draws
        np.testing.assert_allclose(found["predicted_fom"] * found["predicted_variance"] * cost, 1, rtol=1e-12)
    assert tf.predict("transmittance/eq21-overview", filter="residual-ratio")["needs"][0] == "τ"


def test_data_frames_take_the_columns():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(tf.predict(CASE))
    assert frame.shape[0] == 2 and frame.loc[0, "estimator"] == "ratio"


def test_polars_takes_the_columns():
    polars = pytest.importorskip("polars")
    assert polars.DataFrame(tf.predict(CASE)).height == 2


def test_progress_is_told(capsys):
    told = []
    tf.run(CASE, progress=lambda done, planned: told.append((done, planned)))
    assert told[-1][1] == 200_000 and 0 < told[-1][0] and told == sorted(told)
    tf.run(CASE, progress=True)
    line = capsys.readouterr().err
    last = line.split("\r")[-1]
    assert last.endswith("\n") and last.strip() == f"drew {told[-1][0]:.3g} draws"
    with pytest.raises(tf.Error):
        tf.run("title = 1\n", progress=True)
    assert capsys.readouterr().err == "", "no line began"


def test_more_draws_than_planned_are_not_above_100_percent(capsys):
    line = _Line()
    line(11_100, 5_000)
    line.show("drew")
    line.end()
    assert capsys.readouterr().err == "\rdrawing: 99 % of 5e+03 draws\r" + "drew".ljust(28) + "\n"


def test_an_exception_of_progress_comes_through_and_ends_the_drawing():
    class Mine(Exception):
        pass

    def stop(done, planned):
        raise Mine

    begin = time.monotonic()
    with pytest.raises(Mine):
        tf.run(LONG, draws=1e12, progress=stop)
    assert time.monotonic() - begin < 10.0


def test_ctrl_c_ends_a_long_run_within_a_second():
    interrupted = []

    def interrupt():
        interrupted.append(time.monotonic())
        _thread.interrupt_main()

    timer = threading.Timer(0.7, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        tf.run(LONG, draws=1e12)
    assert time.monotonic() - interrupted[0] < 1.0


def test_other_threads_of_python_run_while_cases_are_drawn():
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count, daemon=True)
    thread.start()
    begin = time.monotonic()
    tf.run(CASE, draws=2e7)
    seconds = time.monotonic() - begin
    stop.set()
    thread.join()
    assert counted[0] > max(10.0, 20.0 * seconds), f"{counted[0]} turns in {seconds:.2f} s"


def test_advice_in_columns():
    found = tf.advise(CASE, cost="draw=50ns,lookup=1us")
    assert found["unit"][0] == "s" and found["rank"][0] == 1 and found["group"][0] == "ranked"
    assert found["lines"][0].splitlines()[-1].startswith("estimators = [{ ")
    lookups = tf.advise(CASE, budget=1e5)
    assert lookups["unit"][0] == "lookups" and (lookups["cost"] == 1e5).all()
    with pytest.raises(tf.Error, match="cost: it takes times such as"):
        tf.advise(CASE, cost="2us")
