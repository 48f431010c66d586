"""No honest estimator fails, and every known bug is caught."""

import csv
from pathlib import Path

import confusion
import pytest


@pytest.fixture(scope="module")
def rows():
    return list(confusion.table())


def test_there_are_enough_of_both_kinds(rows):
    honest = [row for row in rows if not row["bug"]]
    assert len(honest) >= 6 and len(rows) - len(honest) >= 20


def test_every_honest_estimator_passes(rows):
    assert [row for row in rows if not row["bug"] and row["verdict"] != "pass"] == []


def test_every_bug_that_changes_mean_or_variance_fails(rows):
    numbers = ("mean", "variance", "lookups", "number")
    assert [row for row in rows if row["changes"] in numbers and row["verdict"] != "fail"] == []


def test_draws_that_depend_on_each_other_are_found(rows):
    found = [row for row in rows if row["changes"] == "order"]
    assert len(found) >= 2
    assert all(row["verdict"] == "inconclusive" and "not independent" in row["reason"] for row in found)


def test_the_stored_table_has_these_verdicts(rows):
    path = Path(__file__).parents[3] / "results/bindings/python-confusion.csv"
    stored = list(csv.DictReader(path.read_text().splitlines()))
    key = ("estimator", "bug", "changes", "verdict")
    assert [[row[k] for k in key] for row in stored] == [[row[k] for k in key] for row in rows]
