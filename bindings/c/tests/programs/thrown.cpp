// An exception that leaves a C callback: the process ends, it does not go on with half a check.
#include <cstdio>
#include <stdexcept>

#include "trueflight.h"

int main()
{
    tf_check *check = tf_check_new("throws");
    const double half = 0.5;
    tf_check_set(check, TF_TRUTH, &half, 1);
    try {
        tf_check_run(check, [](tf_rng *, void *) -> double { throw std::runtime_error("no scene"); }, nullptr);
    } catch (...) {
        std::puts("it came through");
    }
    tf_check_free(check);
    std::puts("it went on");
}
