// Everything from theory: ratio tracking in Eq. 21 of the built-in case, at σ̂ = 1; and with a bug.
#include <cmath>
#include <iostream>

#include "trueflight.hpp"

static double sigma_t(double t)
{
    return std::pow(std::cos(0.75 * t), 10) * (std::sin(t / 2) + 2) / 3;
}

static double ratio(trueflight::rng &rng, double factor)
{
    double weight = 1;
    for (double t = -std::log(rng.positive_uniform()); t < 20; t -= std::log(rng.positive_uniform())) {
        weight *= 1 - factor * sigma_t(t);
    }
    return weight;
}

int main()
{
    const char *eq21 = "transmittance/eq21-overview";
    try {
        trueflight::check("ratio tracking", [](auto &rng) { return ratio(rng, 1.0); }).of(eq21, "ratio", 1.0).assert_pass();
        const auto thin = trueflight::check("too thin", [](auto &rng) { return ratio(rng, 0.99); })
                              .of(eq21, "ratio", 1.0)
                              .verdict();
        std::cout << thin << '\n';
        return thin.verdict == TF_VERDICT_FAIL ? 0 : 1;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
