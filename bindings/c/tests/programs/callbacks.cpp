// A lambda that uses its own check: the error comes out of the verdict.
#include <iostream>

#include "trueflight.hpp"

int main()
{
    tf_check *own = nullptr;
    auto check = trueflight::check("own", [&](auto &rng) {
        const double half = 0.5;
        const tf_status status = tf_check_set(own, TF_TRUTH, &half, 1);
        if (status != TF_STATUS_OK) throw trueflight::error(status);
        return rng.uniform();
    });
    own = check.truth(0.5).range(0, 1).get();
    for (int i = 0; i < 2; ++i) {
        try {
            check.verdict();
            return 1;
        } catch (const trueflight::error &error) {
            std::cout << error.status() << ' ' << error.what() << '\n';
        }
    }
}
