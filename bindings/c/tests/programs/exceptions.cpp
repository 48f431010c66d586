// Exceptions: the estimator's come through as they are, ours have a code and a message, and nothing is lost.
#include <iostream>
#include <random>
#include <sstream>

#include "trueflight.hpp"

int main()
{
    int draws = 0;
    auto throws = trueflight::check("throws", [&](auto &) -> double {
        if (++draws > 20000) throw std::out_of_range("no scene");
        return 0.5;
    });
    try {
        throws.truth(0.5).range(0, 1).draws(50000).verdict();
        return 1;
    } catch (const std::out_of_range &caught) {
        std::cout << caught.what() << " after " << draws << '\n';
    }
    try {
        trueflight::check("no truth", [](auto &rng) { return rng.uniform(); }).verdict();
        return 2;
    } catch (const trueflight::error &caught) {
        std::cout << caught.status() << ' ' << caught.what() << '\n';
    }
    try {
        trueflight::check("off", [](auto &rng) { return static_cast<float>(rng.uniform()); })
            .truth(0.51).range(0, 1).rounding(1e-6).assert_pass();
        return 3;
    } catch (const trueflight::not_passed &caught) {
        std::cout << caught.what() << '\n';
    }
    // <random> takes the stream.
    std::exponential_distribution<double> exponential(2.0);
    const auto found = trueflight::check("exponential", [&](auto &rng) { return exponential(rng); })
                           .truth(0.5).variance(0.25).kurtosis(9).verdict();
    std::ostringstream text;
    text << found;
    std::cout << found.passed() << ' ' << (text.str() == found.text) << '\n';
    // A check moves, and frees its handle once.
    auto one = trueflight::claim("moved");
    auto other = std::move(one.truth(0.5));
    other.absorb({0.5, 0.5}).absorb({0.5});
    std::cout << other.verdict().values.at(0).draws << '\n';
}
