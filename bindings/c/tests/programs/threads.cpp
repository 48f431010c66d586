// Checks on eight threads at once return the same as one after the other, and each thread has its own last error.
#include <iostream>
#include <thread>

#include "trueflight.hpp"

static std::string told(int number)
{
    const std::string name = "thread " + std::to_string(number);
    const double truth = number % 2 == 0 ? 1.0 / 3 : 0.35;
    auto check = trueflight::check(name, [](auto &rng) {
        const double u = rng.uniform();
        return u * u;
    });
    const auto found = check.truth(truth).range(0, 1).verdict();
    std::string error = "none";
    try {
        trueflight::claim(name).truth(0.5).verdict();
    } catch (const trueflight::error &caught) {
        error = caught.what();
    }
    const bool is_mine = error.find(name + "`") != std::string::npos;
    const bool is_right = found.passed() == (number % 2 == 0);
    return is_mine && is_right ? found.text : "wrong: " + found.text + error;
}

int main()
{
    constexpr int count = 8;
    std::string together[count];
    std::vector<std::thread> threads;
    for (int i = 0; i < count; ++i) threads.emplace_back([i, &together] { together[i] = told(i); });
    for (auto &thread : threads) thread.join();
    for (int i = 0; i < count; ++i) {
        if (together[i] != told(i) || together[i].rfind("wrong", 0) == 0) {
            std::cerr << together[i] << '\n';
            return 1;
        }
    }
    std::cout << "eight threads agree\n";
}
