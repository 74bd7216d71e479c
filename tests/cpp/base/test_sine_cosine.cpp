#include "base/sine_cosine.hpp"

#include <cmath>

#include "check.hpp"

using namespace birm3d;

TEST("sine and cosine are those of the library up to 90 degrees, to a few roundings") {
    for (double angle = -1.57; angle <= 1.57; angle += 0.01) {
        const auto [sine, cosine] = sine_cosine(angle);
        CHECK_CLOSE(sine, std::sin(angle), 1e-15, "rounding of three doublings");
        CHECK_CLOSE(cosine, std::cos(angle), 1e-15, "the same");
    }
}
