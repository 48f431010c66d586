// The type of a draw gives its number of values.
#include <iostream>

#include "trueflight.hpp"

template <class Act> static void told(const char *what, Act act)
{
    try {
        std::cout << what << ": ";
        const trueflight::outcome found = act();
        std::cout << found.values.size() << " values, passed: " << found.passed() << '\n';
    } catch (const trueflight::error &error) {
        std::cout << error.status() << ' ' << error.what() << '\n';
    }
}

int main()
{
    const auto pair = [](auto &rng) { return std::array<double, 2>{rng.uniform(), rng.uniform()}; };
    const auto one = [](auto &rng) { return rng.uniform(); };
    using trueflight::check;
    told("one truth", [&] { return check("a", pair).truth(.5).range(0, 1).verdict(); });
    told("two truths", [&] { return check("a", pair).truth({.5, .5}).range(0, 1).verdict(); });
    told("three truths", [&] { return check("a", pair).truth({.5, .5, .5}).range(0, 1).verdict(); });
    told("three of one", [&] { return check("a", one).truth({.5, .5, .5}).range(0, 1).verdict(); });
    told("two variances", [&] { return check("a", pair).truth(.5).variance({1. / 12, 1. / 12}).verdict(); });
    told("three variances", [&] { return check("a", pair).truth(.5).variance({1, 1, 1}).verdict(); });
    told("a case", [&] { return check("a", one).of("transmittance/spectral-smooth", "common-ratio").verdict(); });
}
