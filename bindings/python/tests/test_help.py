"""What a reader meets first: ``help(tf)``, type stubs, the figure of a verdict in a notebook."""

import ast
import inspect
import pydoc
import typing
import xml.etree.ElementTree as ElementTree
from importlib import resources

import numpy as np
import pytest

import trueflight as tf
from trueflight import _trueflight
from trueflight._figure import MAX_ROWS

DRAWS = np.random.default_rng(1).random(100_000)


def public():
    return [name for name in tf.__all__ if not name.startswith("_")]


def test_help_starts_with_what_is_called():
    first = pydoc.plain(pydoc.render_doc(tf)).split("\n")[:14]
    called = [name for name in public() if inspect.isfunction(getattr(tf, name))]
    assert called == ["advise", "cases", "check", "predict", "run", "sweep"]
    for name in called:
        assert any(line.strip().startswith(f"{name}(") for line in first), name


@pytest.mark.parametrize("name", public())
def test_everything_public_is_documented_and_typed(name):
    thing = getattr(tf, name)
    members = [thing, *(value for key, value in vars(thing).items() if key[0] != "_")] if name == "Verdict" else [thing]
    for member in members:
        called = member.fget if isinstance(member, property) else member
        assert inspect.getdoc(called), called
        if inspect.isfunction(called):
            hints = typing.get_type_hints(called)
            assert set(inspect.signature(called).parameters) - {"self"} == set(hints) - {"return"}, called
            assert "return" in hints, called


def test_functions_name_their_errors():
    for name in ("check", "predict", "run", "sweep"):
        assert "Raises ``trueflight.Error``" in inspect.getdoc(getattr(tf, name)), name


def test_the_stub_has_the_names_and_arguments_of_the_compiled_module():
    assert resources.files(tf).joinpath("py.typed").is_file()
    stub = ast.parse(resources.files(tf).joinpath("_trueflight.pyi").read_text(encoding="utf-8")).body
    functions = {item.name: [argument.arg for argument in item.args.args] for item in stub if isinstance(item, ast.FunctionDef)}
    constants = {item.target.id: item.annotation.id for item in stub if isinstance(item, ast.AnnAssign)}
    own = {name for name in dir(_trueflight) if not name.startswith("__")} | {"__version__"}
    assert own == functions.keys() | constants.keys()
    for name, arguments in functions.items():
        assert list(inspect.signature(getattr(_trueflight, name)).parameters) == arguments, name
    for name, kind in constants.items():
        assert type(getattr(_trueflight, name)).__name__ == kind, name


def figure(verdict):
    """Returns the figure of a verdict, and what it says to a screen reader."""
    page = verdict._repr_html_()
    assert page.count("<svg") == 1
    svg = ElementTree.fromstring(page[page.index("<svg") : page.index("</svg>") + 6])
    return svg, svg.attrib["aria-label"]


def circles(svg):
    return [float(item.attrib["cx"]) for item in svg.iter("{http://www.w3.org/2000/svg}circle")]


def test_a_notebook_shows_the_deviation_beside_the_tolerance():
    svg, said = figure(tf.check(DRAWS * 1.05, truth=0.5, range=(0, 1.05), variance=1 / 12, kurtosis=1.8))
    assert said.startswith("mean +5") and "%, fail; variance +1" in said
    tags = [item.tag.rsplit("}")[-1] for item in svg.iter()]
    assert tags.count("circle") == 2 and tags.count("rect") == 2
    zero = float(svg.find("{http://www.w3.org/2000/svg}line").attrib["x1"])
    assert all(x > zero for x in circles(svg)), "both are too large"


def test_each_value_has_a_row():
    truth = [0.5] * 10
    svg, said = figure(tf.check(np.random.default_rng(2).random((100_000, 10)), truth=truth, range=(0, 1)))
    assert len(circles(svg)) == MAX_ROWS and said.startswith("value 0 ") and "value 7" in said


@pytest.mark.parametrize("draws, truth", [(np.full(100, np.nan), 1.0), (np.ones(100), 1.0)])
def test_draws_without_a_spread_have_no_figure(draws, truth):
    page = tf.check(draws, truth=truth, variance=0.0)._repr_html_()
    assert "<svg" not in page and "<table" in page


def test_a_truth_of_0_has_absolute_deviations():
    _, said = figure(tf.check(DRAWS - 0.5, truth=0.0, range=(-0.5, 0.5), tolerance=0.01))
    assert "%" not in said and said.endswith(", pass")
