"""Tests Monte Carlo estimators of light and radiation transport against exact theory.

What to call:

    check(draws, truth=0.37)         is an estimator unbiased? Draws are an array, an iterator, or a function that makes them
    predict(case)                    mean, variance, cost and figure of merit of each estimator of a case, without a draw
    run(case)                        draws each estimator of a case and judges it
    sweep(case, sampling=[1, 2])     either, along values of one quantity
    advise(case)                     which estimator, which σ̂: all of a problem ranked by predicted time to an error
    cases()                          names of the built-in cases

``check`` returns a ``Verdict``: true if the draws pass, with ``mean``, ``z``, ``reason`` and ``assert_pass()``. The others return
dicts of columns, which pandas and Polars take. In pytest the fixture ``unbiased`` takes the arguments of ``check``. A correct
estimator fails with probability ``alpha`` at most, by default 0.001. Invalid arguments raise ``Error``, a ``ValueError`` that
names the cure.

>>> import numpy as np
>>> import trueflight as tf
>>> flights = lambda n, rng: (rng.exponential(size=n) > 1.0).astype(float)
>>> tf.check(flights, truth=np.exp(-1.0), range=(0.0, 1.0)).passed
True

The manual's page is docs/python.md in the repository.
"""

from ._cases import advise, cases, predict, run, sweep
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
    "advise",
    "cases",
    "check",
    "predict",
    "run",
    "sweep",
]
