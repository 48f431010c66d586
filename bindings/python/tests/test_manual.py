"""The examples of the manual and of the package's pages are run."""

import doctest
import importlib
import sys
from pathlib import Path

import pytest
from devices import cupy

ROOT = Path(__file__).parents[3]


def blocks(path):
    parts = path.read_text(encoding="utf-8").split("```python\n")[1:]
    return [part.split("```")[0] for part in parts]


@pytest.mark.parametrize("page, least", [("docs/python.md", 4), ("docs/gpu.md", 1), ("docs/images.md", 1), ("bindings/python/README.md", 1)])
def test_examples_run_from_top_to_bottom(page, least, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "cupy", cupy())
    scripts = [block for block in blocks(ROOT / page) if "unbiased" not in block]
    assert len(scripts) >= least
    names = {}
    for script in scripts:
        exec(compile(script, page, "exec"), names)


def test_examples_with_the_fixture_pass(pytester):
    [tests] = [block for block in blocks(ROOT / "docs/python.md") if "unbiased" in block]
    pytester.makepyfile(tests)
    result = pytester.runpytest_subprocess()
    assert result.ret == 0 and result.parseoutcomes() == {"passed": tests.count("def test_")}


@pytest.mark.parametrize("module", ["trueflight", "trueflight._check"])
def test_examples_in_docstrings(module):
    found = doctest.testmod(importlib.import_module(module))
    assert found.attempted >= 3 and found.failed == 0
