// A draw without values, which does not compile.
#include "trueflight.hpp"

int main()
{
    trueflight::check("empty", [](auto &) { return std::array<double, 0>{}; }).truth(0.5).verdict();
}
