"""Draws that are on a GPU, have a gradient or are in a format that NumPy lacks. Without a GPU: on stand-ins."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from devices import Bare, Cupy, Exchanged, Numba, Sparse, Stuck, Torch, cupy

import trueflight as tf

DRAWS = (np.random.default_rng(1).exponential(size=200_000) > 1.0).astype(float)
COIN = {"truth": np.exp(-1.0), "range": (0.0, 1.0), "rounding": 1e-3, "name": "all"}

WAYS = {
    "cupy": Cupy,
    "torch": Torch,
    "torch with a gradient": lambda values: Torch(values, requires_grad=True),
    "torch with a gradient on the CPU": lambda values: Torch(values, device="cpu", requires_grad=True),
    "torch on another device": lambda values: Torch(values, device="mps:0"),
    "numba": Numba,
    "dlpack": Exchanged,
}
every_way = pytest.mark.parametrize("way", WAYS)


def same(found, expected=None):
    assert found.to_dict() == (expected or tf.check(DRAWS, **COIN)).to_dict()
    assert found.passed


@every_way
def test_an_array_on_a_device_has_the_verdict_of_its_copy(way):
    same(tf.check(WAYS[way](DRAWS), **COIN))
    same(tf.check(WAYS[way](DRAWS), **COIN, draws=65_537), tf.check(DRAWS, **COIN, draws=65_537))


@every_way
def test_draws_of_several_values_and_slices(way):
    wide = np.stack([DRAWS, 1.0 - DRAWS], axis=1)
    known = COIN | {"truth": [np.exp(-1.0), 1.0 - np.exp(-1.0)]}
    same(tf.check(WAYS[way](wide), **known), tf.check(wide, **known))
    same(tf.check(WAYS[way](np.repeat(DRAWS, 2))[::2], **COIN))
    same(tf.check(WAYS[way](wide.astype(np.float32))[:, 0], **COIN))


@every_way
def test_callables_and_iterators_may_yield_them(way):
    def flights(n, rng):
        return (rng.exponential(size=n) > 1.0).astype(float)

    expected = tf.check(flights, **COIN)
    same(tf.check(lambda n, rng: WAYS[way](flights(n, rng)), **COIN), expected)
    same(tf.check((WAYS[way](part) for part in np.array_split(DRAWS, 7)), **COIN, draws=len(DRAWS)))
    few = DRAWS[:5_000]
    expected = tf.check(few, **COIN)
    assert tf.check(iter([WAYS[way](x) for x in few]), **COIN, draws=5_000).to_dict() == expected.to_dict()
    assert tf.check([WAYS[way](x) for x in few], **COIN).to_dict() == expected.to_dict()
    assert tf.check([WAYS[way](part) for part in few[:, None]], **COIN).mean == expected.mean


@every_way
def test_pairs_with_lookups(way):
    counts = np.random.default_rng(2).poisson(4.0, len(DRAWS))
    known = COIN | {"lookups": (4.0, 4.0)}
    expected = tf.check((DRAWS, counts), **known)
    same(tf.check((WAYS[way](DRAWS), WAYS[way](counts)), **known), expected)
    same(tf.check((WAYS[way](DRAWS), counts), **known), expected)
    same(tf.check((DRAWS, WAYS[way](counts)), **known), expected)
    with pytest.raises(tf.Error, match=r"lookups of shape \(3,\) for 200000 draws"):
        tf.check((WAYS[way](DRAWS), WAYS[way](counts[:3])), **known)


def test_views_that_run_backwards():
    same(tf.check(Cupy(DRAWS[::-1])[::-1], **COIN))
    with pytest.raises(tf.DrawsError, match=r"the draws are Numba on .*negative strides\); give its copy"):
        tf.check(Numba(DRAWS)[::-1], **COIN)


@every_way
def test_the_host_holds_a_million_numbers_at_a_time(way):
    """Bounded memory: 3·10⁶ numbers come in three pieces, 10⁶ rows of 4 values in four."""
    for values, pieces in [(np.tile(DRAWS, 15), 3), (np.tile(DRAWS, 20).reshape(-1, 4), 4)]:
        array = WAYS[way](values)
        tf.check(array, **COIN | {"truth": 0.4, "tolerance": 0.2})
        assert len(array.copied) == (0 if way.endswith("CPU") else pieces) and max(array.copied, default=0) <= 2**20
        assert sum(array.copied) == (0 if way.endswith("CPU") else values.size)


def test_what_has_only_the_interface_of_cuda_is_read_by_an_installed_library(monkeypatch):
    for library in ("cupy", "numba", "numba.cuda", "torch"):
        monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(tf.DrawsError, match=r"`all`: the draws are Bare on .*; give its copy in host memory, as by get\(\)"):
        tf.check(Bare(DRAWS), **COIN)
    module = cupy()
    module.asarray = lambda made: Cupy(made._values)
    monkeypatch.setitem(sys.modules, "cupy", module)
    same(tf.check(Bare(DRAWS), **COIN))


@pytest.mark.parametrize(
    "source, words",
    [
        (Stuck(DRAWS), r"the draws are Stuck on the device npu:3, which NumPy cannot read .*; give its copy in host memory"),
        (lambda n: Stuck(np.zeros(n)), r"the draws are Stuck on the device npu:3"),
        ((DRAWS, Stuck(DRAWS)), r"the lookups are Stuck on the device npu:3"),
        ([Stuck(DRAWS[0])], r"which NumPy cannot read"),
        (Torch(DRAWS, device="meta"), r"the draws are a Torch on the device meta, which holds no numbers; give one with"),
        (Torch(DRAWS, layout="torch.sparse_coo"), r"a sparse Torch \(torch.sparse_coo\); give a dense one, as in to_dense\(\)"),
        (Sparse(), r"a sparse array \(Sparse\); give a dense one, as in toarray\(\)"),
        (lambda n: Sparse(), r"a sparse array \(Sparse\)"),
        (iter([Sparse()]), r"a sparse array \(Sparse\)"),
        (Cupy(DRAWS + 1j), "the draws are complex128, not real numbers; give an array of floats"),
        (Torch(DRAWS + 1j), "the draws are complex128, not real numbers"),
        ([Cupy(DRAWS[:3]), Cupy(DRAWS[:4])], "give numbers of one shape|which NumPy cannot read"),
    ],
)
def test_what_cannot_be_read_is_an_error_of_our_own_with_the_cure(source, words):
    with pytest.raises(tf.DrawsError, match=words) as caught:
        tf.check(source, **COIN)
    assert str(caught.value).startswith("check `all`: the ") and isinstance(caught.value, TypeError)


@pytest.mark.parametrize(
    "source, words",
    [
        (Cupy(np.zeros((2, 2, 2))), r"draws of shape \(2, 2, 2\); give an array of shape \(n,\) or \(n, k\)"),
        (Cupy(np.zeros((3, 5))), r"3 draws of 5 values each, fewer draws than values; .* draws\.T"),
        (Cupy(np.zeros(0)), "there are no draws; make one at least"),
        (Cupy(np.float64(0.5)), r"draws of shape \(\)"),
        (lambda n: Cupy(np.zeros(3)), r"draws of shape \(3,\), but 65536 draws were asked for"),
    ],
)
def test_a_wrong_shape_is_known_before_a_copy(source, words):
    with pytest.raises(tf.Error, match=words):
        tf.check(source, truth=0.5)
    assert callable(source) or not source.copied


def test_missing_values_of_a_column_are_no_draws():
    class Column:
        null_count = 2

        def __array__(self, dtype=None, copy=None):
            return np.array([1.0, np.nan, np.nan])

    with pytest.raises(tf.DrawsError, match=r"a Column with 2 missing values; fill them .*, or drop them"):
        tf.check(Column(), truth=0.5)


def test_bfloat16_may_be_off_by_half_its_spacing():
    """8 digits: 1/e becomes 0.3671875, off by -1.9e-3; 2⁻⁸ = 3.9e-3 is half the spacing above 1."""
    stored = np.full(4096, np.float32(0.3671875))
    known = {"truth": np.exp(-1.0), "variance": 0.0}
    for device in ("cpu", "cuda:0"):
        brain = Torch(stored, device=device, kind="torch.bfloat16")
        assert tf.check(brain, **known).passed
        assert tf.check(lambda n, d=device: Torch(stored[:1].repeat(n), device=d, kind="torch.bfloat16"), **known).passed
        assert tf.check(brain, **known, rounding=1e-3).verdict == "fail"
    assert tf.check(stored, **known).verdict == "fail", "float32 is nearer than that"
    assert tf.check(Torch(stored * 1.01, kind="torch.bfloat16"), **known).verdict == "fail"
    assert tf.check([Torch(x, kind="torch.bfloat16") for x in stored], **known).passed


def test_the_small_formats_of_ml_dtypes():
    small = pytest.importorskip("ml_dtypes")
    draws = np.full(4096, np.exp(-1.0)).astype(small.bfloat16)
    known = {"truth": np.exp(-1.0), "variance": 0.0}
    assert tf.check(draws, **known).passed and tf.check(draws.astype(np.float32), **known).verdict == "fail"
    same(tf.check(DRAWS.astype(small.bfloat16), **COIN))
    eighths = np.full(4096, 0.28).astype(small.float8_e4m3fn)  # 4 digits: 0.28125
    assert tf.check(eighths, truth=0.28, variance=0.0, tolerance=0.3).passed
    same(tf.check(DRAWS.astype(small.int4), **COIN))


def test_what_is_known_may_be_on_a_device_too():
    mean, variance = Cupy(np.exp(-1.0)), Torch(np.exp(-1.0) - np.exp(-2.0), requires_grad=True)
    told = tf.check(Cupy(DRAWS), truth=mean, variance=variance, range=Cupy([0.0, 1.0]))
    assert told.to_dict() == tf.check(DRAWS, truth=np.exp(-1.0), variance=np.exp(-1.0) - np.exp(-2.0), range=(0, 1)).to_dict()
    with pytest.raises(tf.Error, match="truth = .* is no number"):
        tf.check(DRAWS, truth=Stuck(DRAWS))
    along = tf.sweep("transmittance/eq21-overview", sampling=Cupy([1.0, 2.0]), filter="ratio")
    np.testing.assert_array_equal(along["swept"], [1.0, 2.0])
    problem = {"medium": {"constant": {"extinction": 0.5}}, "span": Cupy([0.0, 4.0]), "estimators": [{"closed-form": {}}]}
    found = tf.predict({"title": "t", "problem": {"transmittance": problem}})
    np.testing.assert_allclose(found["truth"], [np.exp(-2.0)], rtol=1e-14)
    with pytest.raises(tf.Error, match=r"problem.transmittance.span is Stuck, which NumPy cannot read"):
        tf.predict({"title": "t", "problem": {"transmittance": problem | {"span": Stuck(DRAWS)}}})


def test_the_fixture_takes_them(pytester, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path(__file__).parent), *sys.path]))
    pytester.makepyfile(
        """
        import numpy as np
        from devices import Cupy

        def test_gpu(unbiased):
            unbiased(lambda n, rng: Cupy(rng.random(n)), truth=0.5, range=(0, 1))
        """
    )
    result = pytester.runpytest_subprocess()
    assert result.ret == 0 and result.parseoutcomes() == {"passed": 1}
