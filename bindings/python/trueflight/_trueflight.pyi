from collections.abc import Callable, Iterator
from typing import Any, Literal

BLOCK: int
"""Number of draws that are judged at a time."""
MAX_DRAWS: int
"""Largest number of draws that are made by default."""
__version__: str

def built_in() -> list[str]: ...
def predict(cases: dict[str, Any], wanted: dict[str, Any], optimum: bool) -> str: ...
def run(cases: dict[str, Any], wanted: dict[str, Any], tell: Callable[[int, int], object] | None) -> str: ...
def judge(
    asked: dict[str, Any], arrays: Iterator[tuple[Any, Any | None]]
) -> tuple[Literal["pass", "fail", "inconclusive"], str, str, str]: ...
