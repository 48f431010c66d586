"""Estimators of null-collision tracking with NumPy, honest and with known bugs.

The medium is sigma(t) = 1 + cos(2t)/2 on [0, 2], in 1/length; its optical depth tau(t) = t + sin(2t)/4 is exact. An
estimator takes the number of draws, a generator, and the name of a bug.
"""

import numpy as np

LENGTH = 2.0
MAJORANT = 1.5
CONTROL = 1.0
ALBEDO = 0.7


def extinction(t):
    """sigma, 1/length."""
    return 1.0 + 0.5 * np.cos(2.0 * t)


def depth(t):
    """tau from 0 to t."""
    return t + 0.25 * np.sin(2.0 * t)


def product_law(sampling, control=0.0, scale=1.0):
    """Mean, variance and kurtosis of exp(-control L) prod(1 - (sigma - control)/sampling), sigma times ``scale``.

    The k-th moment is exp(-k control L - int sampling (1 - W^k)): the collisions are a Poisson process.
    """
    nodes, weights = np.polynomial.legendre.leggauss(40)
    t, weights = LENGTH / 2.0 * (nodes + 1.0), LENGTH / 2.0 * weights
    factor = 1.0 - (scale * extinction(t) - control) / sampling
    moments = [np.exp(-k * control * LENGTH - sampling * np.sum(weights * (1.0 - factor**k))) for k in range(1, 5)]
    return central(*moments)


def central(m1, m2, m3, m4):
    """Truth, variance and kurtosis from raw moments."""
    variance = m2 - m1**2
    fourth = m4 - 4.0 * m3 * m1 + 6.0 * m2 * m1**2 - 3.0 * m1**4
    return {"truth": m1, "variance": variance, "kurtosis": fourth / variance**2}


def coin(p):
    """The law of a draw that is 1 with probability p, else 0."""
    return {"truth": p, "variance": p * (1.0 - p), "range": (0.0, 1.0)}


def ratio(n, rng, bug="", sampling=MAJORANT, scale=1.0):
    """Ratio tracking: the product of 1 - sigma/sampling over all collisions on the ray."""
    sampling = 2.0 if bug == "another majorant" else sampling
    length = LENGTH * 0.98 if bug == "ray ends early" else LENGTH
    if bug == "same seed in every pass":
        rng = np.random.default_rng(7)
    t, weight, flying = np.zeros(n), np.ones(n), np.arange(n)
    collisions = 0
    while flying.size:
        before = t[flying]
        mean_flight = sampling if bug == "rate taken for a mean" else 1.0 / sampling
        t[flying] += rng.exponential(mean_flight, flying.size)
        here = t[flying] < length
        if bug == "collision behind the ray":
            weight[flying[~here]] *= 1.0 - extinction(t[flying[~here]]) / sampling
        flying, before = flying[here], before[here]
        collisions += 1
        if bug == "first collision skipped" and collisions == 1:
            continue
        if bug == "walk cut after 3 collisions" and collisions > 3:
            break
        at = before if bug == "looked up at the last collision" else t[flying]
        if bug == "coarse grid":
            at = np.floor(at * 2.0) / 2.0
        null = 1.0 - scale * extinction(at) / sampling
        if bug == "1 minus forgotten":
            null = 1.0 - null
        weight[flying] *= null
        if bug == "small weights dropped":
            weight[flying[weight[flying] < 0.05]] = 0.0
        if bug.startswith("roulette"):
            low = flying[weight[flying] < 0.2]
            kept = rng.random(low.size) < 0.5
            weight[low] *= kept * (1.0 if bug == "roulette without compensation" else 2.0)
    if bug == "NaN where the weight is tiny":
        weight[weight < 1e-4] = np.nan
    return weight


def pairs_averaged(n, rng):
    """Two draws averaged, and told as one."""
    return (ratio(n, rng) + ratio(n, rng)) / 2.0


def draws_repeated(n, rng):
    """Each draw told twice."""
    return np.repeat(ratio((n + 1) // 2, rng), 2)[:n]


def ratio_with_lookups(n, rng, bug=""):
    """Ratio tracking with its number of lookups, a Poisson number."""
    t, weight, lookups, flying = np.zeros(n), np.ones(n), np.zeros(n), np.arange(n)
    while flying.size:
        t[flying] += rng.exponential(1.0 / MAJORANT, flying.size)
        if bug == "lookup behind the ray counted":
            lookups[flying] += 1.0
        flying = flying[t[flying] < LENGTH]
        weight[flying] *= 1.0 - extinction(t[flying]) / MAJORANT
        if not bug:
            lookups[flying] += 1.0
    return weight, lookups


def residual_ratio(n, rng, bug=""):
    """Residual ratio tracking about a constant control."""
    sampling = 0.5
    t, weight, flying = np.zeros(n), np.ones(n), np.arange(n)
    while flying.size:
        t[flying] += rng.exponential(1.0 / sampling, flying.size)
        flying = flying[t[flying] < LENGTH]
        residual = extinction(t[flying]) - CONTROL
        if bug == "residual without its sign":
            residual = np.abs(residual)
        factor = 1.0 - residual / sampling
        if bug == "weights clamped to 1":
            factor = np.minimum(factor, 1.0)
        weight[flying] *= factor
    if bug == "control forgotten":
        return weight
    return weight * np.exp(-CONTROL * LENGTH)


def channels(n, rng, bug=""):
    """Two colours, sigma and sigma/2, by the same collisions."""
    t, weight, flying = np.zeros(n), np.ones((n, 2)), np.arange(n)
    share = np.array([1.0, 1.0 if bug == "colours alike" else 0.5])
    while flying.size:
        t[flying] += rng.exponential(1.0 / MAJORANT, flying.size)
        flying = flying[t[flying] < LENGTH]
        weight[flying] *= 1.0 - np.outer(extinction(t[flying]), share) / MAJORANT
    return weight[:, ::-1] if bug == "colours swapped" else weight


def fly(start, step, rng, bug=""):
    """Woodcock tracking from ``start`` in directions ``step`` = 1 or -1: where the photon collides, or leaves [0, 2]."""
    majorant = 1.2 if bug == "majorant too low" else MAJORANT
    t, flying = start.copy(), np.arange(start.size)
    while flying.size:
        u = rng.random(flying.size)
        from_there = start if bug == "position not kept" else t
        t[flying] = from_there[flying] - step[flying] * np.log1p(-u) / majorant
        inside = (t[flying] > 0.0) & (t[flying] < LENGTH)
        flying, u = flying[inside], u[inside]
        chance = u if bug == "reused random number" else rng.random(flying.size)
        real = chance * majorant < extinction(t[flying])
        flying = flying[real if bug == "test the wrong way round" else ~real]
    return t


def woodcock(n, rng, bug=""):
    """Does a photon pass?"""
    passed = fly(np.zeros(n), np.ones(n), rng, bug) >= LENGTH
    if bug == "some absorbed photons counted":
        passed |= rng.random(n) < 0.02
    return passed.astype(float)


def free_flight(n, rng, bug=""):
    """The optical depth of a collision in the endless medium: exponential with mean 1."""
    t, flying = np.zeros(n), np.arange(n)
    majorant = 1.35 if bug == "majorant too low" else MAJORANT
    while flying.size:
        flight = rng.exponential(1.0 / majorant, flying.size)
        t[flying] = flight if bug == "position not kept" else t[flying] + flight
        kept = rng.random(flying.size) * majorant >= extinction(t[flying])
        flying = flying[kept]
    if bug == "longest flights cut":
        t = np.minimum(t, 5.0)
    return depth(t)


def scattered_once(n, rng, bug=""):
    """Light that enters a rod at 0 and leaves there after one scattering, half of which goes back: an analogue walk."""
    t = fly(np.zeros(n), np.ones(n), rng, bug)
    albedo = 1.0 - ALBEDO if bug == "albedo swapped" else ALBEDO
    back = 1.0 if bug == "phase function forgotten" else 0.5
    turned = (t < LENGTH) & (rng.random(n) < albedo * back)
    left = np.zeros(n)
    left[turned] = fly(t[turned], -np.ones(turned.sum()), rng, bug) <= 0.0
    return left


def next_event(n, rng, bug=""):
    """The same by the expected transmittance of the way back, ratio tracking."""
    t = fly(np.zeros(n), np.ones(n), rng)
    weight, flying = np.where(t < LENGTH, ALBEDO / 2.0, 0.0), np.flatnonzero(t < LENGTH)
    if bug == "escaped photons scatter":
        weight[:] = ALBEDO / 2.0
    at = t.copy()
    while flying.size:
        flight = rng.exponential(1.0 / MAJORANT, flying.size)
        at[flying] += flight if bug == "towards the wrong end" else -flight
        flying = flying[(at[flying] > 0.0) & (at[flying] < LENGTH)]
        weight[flying] *= 1.0 - extinction(at[flying]) / MAJORANT
    return weight


def rod(n, rng, bug=""):
    """Is light reflected by a rod that scatters without loss, forwards and backwards alike? tau/(2 + tau) is."""
    t, step, inside = np.zeros(n), np.ones(n), np.arange(n)
    scatterings = 0
    while inside.size:
        t[inside] = fly(t[inside], step[inside], rng)
        inside = inside[(t[inside] > 0.0) & (t[inside] < LENGTH)]
        back = 0.47 if bug == "forward preferred" else 0.5
        turns = rng.random(inside.size) < back
        step[inside] = np.where(turns, -1.0, 1.0) * (step[inside] if bug == "forward preferred" else 1.0)
        scatterings += 1
        if bug == "walk cut after 3 scatterings" and scatterings == 3:
            break
    return (t <= 0.0).astype(float)
