// A confusion table: correct and buggy estimators of one problem, each with the claims about the correct one. Exit code 0
// if all correct ones pass and no buggy one does.
//
// The medium is σ_t(t) = exp(−t) on [0, 3]: τ = 1 − exp(−3), ∫σ² = (1 − exp(−6))/2. Ratio tracking by a constant σ̂
// with a control of c has E[w²] = exp(−2τ + ∫(σ − c)²/σ̂), and σ̂ L lookups that are Poisson distributed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "trueflight.hpp"

using trueflight::check;
using trueflight::claim;
using trueflight::rng;

static const double L = 3, tau = 1 - std::exp(-L), squares = (1 - std::exp(-2 * L)) / 2, T = std::exp(-tau);

static double sigma(double t) { return std::exp(-t); }
static double flight(rng &rng) { return -std::log(rng.positive_uniform()); }

/** The variance of ratio tracking. */
static double spread(double sampling, double control = 0)
{
    const double over = squares - 2 * control * tau + control * control * L;
    return T * T * (std::exp(over / sampling) - 1);
}

/** Ratio tracking: `keep` returns the weight after each collision. */
template <class Keep> double track(rng &rng, double sampling, double length, Keep keep)
{
    double weight = 1;
    for (double t = flight(rng) / sampling; t < length; t += flight(rng) / sampling) weight = keep(weight, t);
    return weight;
}

static double collide(double weight, double t) { return weight * (1 - sigma(t)); }

static double ratio(rng &rng, double sampling = 1)
{
    return track(rng, sampling, L, [=](double w, double t) { return w * (1 - sigma(t) / sampling); });
}

/** Delta tracking by σ̂: 1 if no collision is real. */
static double delta(rng &rng, double sampling)
{
    for (double t = flight(rng) / sampling; t < L; t += flight(rng) / sampling) {
        if (rng.uniform() * sampling < sigma(t)) return 0;
    }
    return 1;
}

/** Ratio tracking with roulette of weights below 0.2; survivors get `survivor` of the weight that makes it unbiased. */
static double roulette(rng &rng, double survivor)
{
    return track(rng, 1, L, [&](double w, double t) {
        w *= 1 - sigma(t);
        if (w == 0 || w >= 0.2) return w;
        return rng.uniform() < w / 0.5 ? 0.5 * survivor : 0.0;
    });
}

/** Ratio tracking in two densities by the same walk. */
static std::array<double, 2> densities(rng &rng)
{
    double thin = 1;
    const double full = track(rng, 1, L, [&](double w, double t) {
        thin *= 1 - sigma(t) / 2;
        return collide(w, t);
    });
    return {full, thin};
}

/** Claims: the mean and the range; the mean and a variance; all three. */
static const auto unit = [](auto &c) { c.truth(T).range(0, 1); };
static auto varied(double variance)
{
    return [=](auto &c) { c.truth(T).variance(variance); };
}
static const auto known = [](auto &c) { c.truth(T).variance(spread(1)).range(0, 1); };

static int wrong = 0, rows = 0;

static void tell(bool honest, const char *name, const trueflight::outcome &found)
{
    ++rows;
    const bool is_right = found.passed() == honest;
    wrong += !is_right;
    const char *words[] = {"pass", "fail", "inconclusive"};
    const auto draws = static_cast<unsigned long long>(found.values[0].draws);
    std::printf("%-6s  %-50s  %-12s  %9llu  %s%s\n", honest ? "honest" : "buggy", name, words[found.verdict], draws,
                is_right ? "" : "WRONG ", found.reason.c_str());
}

/** Judges draws by the claims that `say` sets. */
template <class Draw, class Say> void judge(bool honest, const char *name, Draw draw, Say say)
{
    auto made = check(name, draw);
    say(made);
    tell(honest, name, made.verdict());
}

static void honest_ones()
{
    const auto depth = [](auto &c) { c.truth(tau).range(0, std::nextafter(L, 4)); };
    judge(true, "delta tracking", [](rng &r) { return delta(r, 1); }, varied(T * (1 - T)));
    judge(true, "delta tracking, majorant 2", [](rng &r) { return delta(r, 2); }, unit);
    judge(true, "ratio tracking", [](rng &r) { return ratio(r); }, known);
    judge(true, "ratio tracking, majorant 2", [](rng &r) { return ratio(r, 2); }, varied(spread(2)));
    judge(true, "residual ratio tracking", [](rng &r) {
        const auto keep = [](double w, double t) { return w * (1 - (sigma(t) - 0.3) / 0.7); };
        return std::exp(-0.3 * L) * track(r, 0.7, L, keep);
    }, varied(spread(0.7, 0.3)));
    judge(true, "ratio tracking with roulette", [](rng &r) { return roulette(r, 1); }, unit);
    judge(true, "ratio tracking in single precision", [](rng &r) { return static_cast<float>(ratio(r)); },
          [](auto &c) { c.truth(T).range(0, 1).rounding(1e-6); });
    judge(true, "ratio tracking below the majorant, signed", [](rng &r) { return ratio(r, 0.8); }, varied(spread(0.8)));
    judge(true, "two densities at once", densities, [](auto &c) { c.truth({T, std::sqrt(T)}).range(0, 1); });
    judge(true, "optical depth, uniform", [](rng &r) { return L * sigma(L * r.uniform()); },
          [](auto &c) { c.truth(tau).variance(L * squares - tau * tau).range(0, L); });
    judge(true, "optical depth, antithetic", [](rng &r) {
        const double u = r.uniform();
        return L * (sigma(L * u) + sigma(L * (1 - u))) / 2;
    }, depth);
    judge(true, "clipped free flight", [](rng &r) { return std::min(flight(r), L); }, depth);
    std::exponential_distribution<double> exponential;
    judge(true, "flights of <random>", [=](rng &r) mutable { return exponential(r) > tau ? 1 : 0; }, unit);
}

/** Pushes draws of ratio tracking, each with its lookups. */
static void pushed(bool honest, const char *name, double factor)
{
    auto made = claim(name);
    made.truth(T).range(0, 1).lookups(L, L);
    tf_rng stream{{1, 2, 3, 4}};
    rng random(&stream);
    while (made.is_open()) {
        std::vector<double> draws, lookups;
        for (int i = 0; i < 1000; ++i) {
            int count = 0;
            draws.push_back(track(random, 1, L, [&](double w, double t) {
                ++count;
                return collide(w, t);
            }));
            lookups.push_back(factor * count);
        }
        made.absorb(draws, lookups);
    }
    tell(honest, name, made.verdict());
}

/** Bugs of the walk. */
static void buggy_walks()
{
    const auto keeps = [&](const char *name, auto keep) {
        judge(false, name, [=](rng &r) { return track(r, 1, L, keep); }, unit);
    };
    judge(false, "majorant 20 % low in delta tracking", [](rng &r) { return delta(r, 0.8); }, unit);
    judge(false, "majorant of the steps is not that of the weights", [](rng &r) { return track(r, 1.1, L, collide); }, unit);
    judge(false, "looks up where the step began", [](rng &r) {
        double w = 1, before = 0;
        for (double t = flight(r); t < L; before = t, t += flight(r)) w *= 1 - sigma(before);
        return w;
    }, unit);
    judge(false, "steps from the beginning again", [](rng &r) {
        double w = 1, flown = 0;
        for (double s = flight(r); flown + s < L; flown += s, s = flight(r)) w *= 1 - sigma(s);
        return w;
    }, unit);
    judge(false, "ends at 2.5 instead of 3", [](rng &r) { return track(r, 1, 2.5, collide); }, unit);
    judge(false, "ends at the third collision", [](rng &r) {
        int left = 3;
        return track(r, 1, L, [&](double w, double t) { return left-- > 0 ? collide(w, t) : w; });
    }, unit);
    keeps("multiplies by what is absorbed", [](double w, double t) { return w * sigma(t); });
    keeps("density 3 % thin", [](double w, double t) { return w * (1 - 0.97 * sigma(t)); });
    keeps("density squared", [](double w, double t) { return w * (1 - sigma(t) * sigma(t)); });
    keeps("clamps weights at 0.1", [](double w, double t) { return std::max(0.1, w * (1 - sigma(t))); });
    keeps("weights in steps of 1/64, rounded down", [](double w, double t) { return std::floor(64 * w * (1 - sigma(t))) / 64; });
    judge(false, "roulette without compensation", [](rng &r) { return roulette(r, 0.4); }, unit);
    judge(false, "roulette compensated twice", [](rng &r) { return roulette(r, 2); }, unit);
    judge(false, "one number for step and decision", [](rng &r) {
        for (double t = 0;;) {
            const double u = r.positive_uniform();
            t -= std::log(u);
            if (t >= L) return 1;
            if (u < sigma(t)) return 0;
        }
    }, unit);
    judge(false, "steps that are uniform", [](rng &r) {
        double w = 1;
        for (double t = 2 * r.uniform(); t < L; t += 2 * r.uniform()) w *= 1 - sigma(t);
        return w;
    }, unit);
    judge(false, "throws zeros away", [](rng &r) {
        double w = 0;
        for (int tries = 0; w < 0.05 && tries < 100; ++tries) w = ratio(r);
        return w;
    }, unit);
    judge(false, "larger of two tries", [](rng &r) { return std::max(ratio(r), ratio(r)); }, unit);
    judge(false, "optical depth without the length", [](rng &r) { return sigma(L * r.uniform()); },
          [](auto &c) { c.truth(tau).range(0, L); });
    judge(false, "channels swapped", [](rng &r) {
        const auto [full, thin] = densities(r);
        return std::array<double, 2>{thin, full};
    }, [](auto &c) { c.truth({T, std::sqrt(T)}).range(0, 1); });
}

/** Bugs of the spread, of the order, and of single draws. */
static void buggy_draws()
{
    judge(false, "another majorant than said", [](rng &r) { return ratio(r, 1.1); }, known);
    judge(false, "mean of two as one draw", [](rng &r) { return (ratio(r) + ratio(r)) / 2; }, known);
    judge(false, "the truth itself", [](rng &) { return T; }, known);
    judge(false, "a tenth of the last draw",
          [last = T](rng &r) mutable { return last = 0.9 * ratio(r) + 0.1 * last; }, known);
    judge(false, "every draw twice", [last = 0.0, old = false](rng &r) mutable {
        old = !old;
        return old ? last = ratio(r) : last;
    }, known);
    judge(false, "seeded anew from a thousand seeds", [next = 0ull](rng &) mutable {
        tf_rng seeded{{next++ % 1000 + 1, 2, 3, 4}};
        for (int i = 0; i < 20; ++i) tf_rng_word(&seeded);
        rng own(&seeded);
        return ratio(own);
    }, unit);
    judge(false, "5 % brighter from draw 300000 on",
          [n = 0](rng &r) mutable { return ratio(r) * (++n > 300000 ? 1.05 : 1); },
          [](auto &c) { c.truth(T).variance(spread(1)).draws(1 << 20); });
    const auto rarely = [](double what) {
        return [=](rng &r) { return r.uniform() < 1e-4 ? what : ratio(r); };
    };
    judge(false, "not a number once in 10000", rarely(std::nan("")), known);
    judge(false, "infinite once in 10000", rarely(std::numeric_limits<double>::infinity()), known);
    judge(false, "negative weights below the majorant", [](rng &r) { return ratio(r, 0.8); }, unit);
    pushed(false, "lookups counted twice", 2);
}

int main()
{
    try {
        std::printf("kind    %-50s  verdict           draws  reason\n", "estimator");
        honest_ones();
        pushed(true, "ratio tracking, pushed with lookups", 1);
        buggy_walks();
        buggy_draws();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
    std::printf("%d estimators, %d judged wrongly\n", rows, wrong);
    return wrong ? 1 : 0;
}
