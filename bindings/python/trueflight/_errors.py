"""Reasons why there is no verdict. All are a ``trueflight.Error``, and a ``ValueError``."""


class Error(ValueError):
    """An argument is invalid; the message names the place and the cure."""


class CaseNotFound(Error, FileNotFoundError):
    """No built-in case and no file has that name."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class DrawsError(Error, TypeError):
    """Draws are not real numbers."""


def shown(value: object) -> str:
    """Returns a value for a message, shortened if it is long."""
    try:
        text = repr(value)
    except Exception:  # Integers of many digits have none, and any `__repr__` may raise.
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 60 else f"{text[:57]}…"


class Inconclusive(AssertionError):
    """The draws neither pass nor fail: too few of them, no grounds to fail on, or they depend on each other."""
