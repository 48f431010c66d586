// Ratio tracking in three densities at once: σ_t = k exp(−t) on [0, 3], sampled by σ̂ = 1.
#include <array>
#include <cmath>
#include <iostream>

#include "trueflight.hpp"

int main()
{
    const std::array<double, 3> k{0.25, 0.5, 1.0};
    const auto truth = [](double k) { return std::exp(-k * (1 - std::exp(-3.0))); };

    const auto ratio = [&](trueflight::rng &rng) {
        std::array<double, 3> weight{1, 1, 1};
        for (double t = -std::log(rng.positive_uniform()); t < 3; t -= std::log(rng.positive_uniform())) {
            for (int i = 0; i < 3; ++i) weight[i] *= 1 - k[i] * std::exp(-t);
        }
        return weight;
    };

    try {
        trueflight::check("three densities", ratio).truth({truth(k[0]), truth(k[1]), truth(k[2])}).range(0, 1).assert_pass();
        // Another truth: the verdict shows which value fails, and by how much.
        const auto found = trueflight::check("wrong", ratio).truth({truth(k[0]), truth(k[1]), 0.39}).range(0, 1).verdict();
        std::cout << found << '\n';
        return found.passed() ? 1 : 0;
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
