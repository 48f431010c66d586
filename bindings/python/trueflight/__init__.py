"""Tests Monte Carlo estimators of light and radiation transport against exact theory.

``check`` judges draws: an array, an iterator, or a callable that makes them. ``predict``, ``run`` and ``sweep`` tell what
theory says of a case, and draw it. What they find goes with a stated error rate: a correct estimator fails with chance
alpha at most. The fixture ``unbiased`` brings the same to pytest.

>>> import numpy as np
>>> import trueflight as tf
>>> flights = lambda n, rng: (rng.exponential(size=n) > 1.0).astype(float)
>>> tf.check(flights, truth=np.exp(-1.0), range=(0.0, 1.0)).passed
True
"""

from ._cases import cases, predict, run, sweep
from ._check import check
from ._errors import CaseNotFound, DrawsError, Error, Inconclusive
from ._trueflight import __version__
from ._verdict import Verdict

__all__ = [
    "CaseNotFound",
    "DrawsError",
    "Error",
    "Inconclusive",
    "Verdict",
    "__version__",
    "cases",
    "check",
    "predict",
    "run",
    "sweep",
]
