"""Figure of a verdict for notebooks: deviations from the truth beside the bias that a pass excludes, as SVG."""

import html
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

COLOURS = {"pass": "#1a7f37", "fail": "#cf222e", "inconclusive": "#9a6700"}

# Sizes in pixels, and the largest number of rows.
_WIDTH, _ROW, _LEFT, _RIGHT, _AXIS = 460, 26, 120, 10, 22
MAX_ROWS = 8


class Row(NamedTuple):
    """A number beside its expected value; deviations are relative to that, or absolute if it is 0."""

    label: str
    deviation: float
    error: float
    """Standard error; NaN if unknown."""
    tolerance: float
    """Deviation that a pass excludes; NaN if unknown."""
    verdict: str


def rows(values: Sequence[dict[str, Any]], channels: Sequence[str]) -> list[Row]:
    """Returns a row for the mean of each value of a draw; for one value also one for its variance, if that is known."""
    found = []
    for index, value in enumerate(values[:MAX_ROWS]):
        label = "mean" if len(values) == 1 else (channels[index] if index < len(channels) else f"value {index}")
        found += _mean(label, value)
    return found + (_variance(values[0]) if len(values) == 1 else [])


def svg(rows: Sequence[Row], relative: bool) -> str:
    """Returns the figure; empty without rows. ``relative`` deviations are in percent."""
    reach = max((1.15 * max(abs(row.deviation) + 2 * _or_0(row.error), _or_0(row.tolerance)) for row in rows), default=0.0)
    if not rows or not 0.0 < reach < math.inf:
        return ""
    height = _ROW * len(rows) + _AXIS
    half = (_WIDTH - _LEFT - _RIGHT) / 2

    def x(deviation: float) -> float:
        return round(_LEFT + half * (1 + max(-1.0, min(1.0, deviation / reach))), 1)

    parts = ["<title>grey: deviations that a pass excludes; lines: two standard errors</title>"]
    parts.append(f"<line x1='{x(0)}' x2='{x(0)}' y1='0' y2='{height - _AXIS}' stroke='currentColor'/>")
    parts.append(_text(x(0), height - 6, "truth", "middle"))
    for end, anchor in ((-reach, "start"), (reach, "end")):
        parts.append(_text(x(end), height - 6, _shown(end, relative), anchor))
    for index, row in enumerate(rows):
        parts += _row(row, _ROW * index, x)
    said = "; ".join(f"{row.label} {_shown(row.deviation, relative)}, {row.verdict}" for row in rows)
    head = f"<svg role='img' aria-label='{html.escape(said, quote=True)}' width='{_WIDTH}' height='{height}'"
    style = "style='font:12px sans-serif;color:inherit'"
    return f"{head} xmlns='http://www.w3.org/2000/svg' {style}>{''.join(parts)}</svg>"


def _row(row: Row, top: int, x: Any) -> list[str]:
    middle, colour = top + _ROW / 2, COLOURS[row.verdict]
    parts = [_text(_LEFT - 8, middle + 4, row.label if len(row.label) <= 16 else f"{row.label[:15]}…", "end")]
    if row.tolerance > 0:
        left, right = x(-row.tolerance), x(row.tolerance)
        size = f"x='{left}' y='{top + 4}' width='{right - left:.1f}' height='{_ROW - 8}'"
        parts.append(f"<rect {size} fill='currentColor' opacity='.12'/>")
    if row.error > 0:
        low, high = x(row.deviation - 2 * row.error), x(row.deviation + 2 * row.error)
        parts.append(f"<line x1='{low}' x2='{high}' y1='{middle}' y2='{middle}' stroke='{colour}' stroke-width='2'/>")
    return [*parts, f"<circle cx='{x(row.deviation)}' cy='{middle}' r='4' fill='{colour}'/>"]


def _mean(label: str, value: dict[str, Any]) -> list[Row]:
    truth, mean = value["truth"], value["mean"]
    if mean is None or not math.isfinite(mean):
        return []
    unit, error = value["unit"], _or_nan(value["standard_error"])
    return [Row(label, (mean - truth) / unit, error / unit, _tolerance(value, "mean"), value["verdict"])]


def _variance(value: dict[str, Any]) -> list[Row]:
    ratio = value["variance_ratio"]
    if ratio is None or not math.isfinite(ratio) or not value["truth"]:
        return []
    verdict = next((found["verdict"] for found in value["findings"] if found["check"] == "variance"), value["verdict"])
    return [Row("variance", ratio - 1.0, _or_nan(value["variance_band"]), _tolerance(value, "variance"), verdict)]


def _tolerance(value: dict[str, Any], check: str) -> float:
    gates = (found["gate"] for found in value["findings"] if found["check"] == check)
    return next((_or_nan(gate["tolerance"]) for gate in gates if gate is not None), math.nan)


def _shown(deviation: float, relative: bool) -> str:
    return f"{100 * deviation:+.2g} %" if relative else f"{deviation:+.2g}"


def _or_nan(number: Any) -> float:
    return math.nan if number is None else float(number)


def _or_0(number: float) -> float:
    return number if math.isfinite(number) else 0.0


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f"<text x='{x}' y='{y}' text-anchor='{anchor}' fill='currentColor'>{html.escape(text)}</text>"
