#include "record/greatest.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "check.hpp"

using namespace birm3d;

namespace {

std::vector<double> random_numbers(std::size_t count, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> between(-1.0, 1.0);
    std::vector<double> numbers(count);
    for (double& number : numbers)
        number = between(generator);
    return numbers;
}

}  // namespace

TEST("the greatest of any count of numbers is that of the standard library") {
    for (std::size_t count = 1; count < 40; ++count) {
        const std::vector<double> numbers = random_numbers(count, static_cast<unsigned>(count));
        CHECK(greatest_of(numbers.data(), count) == *std::max_element(numbers.begin(), numbers.end()));
    }
}

TEST("pairs that come together have the greatest value of pairs that come one by one") {
    const auto angle = [](double x, double y) { return std::atan2(y, x); };
    for (unsigned seed = 1; seed < 20; ++seed) {
        std::vector<double> y = random_numbers(200, seed);
        // The greatest comes several times, and its neighbours in the last bits.
        const double most = *std::max_element(y.begin(), y.end());
        for (std::size_t i = 0; i < y.size(); i += 30)
            y[i] = most * (1.0 - 1e-16 * static_cast<double>(i));
        const std::vector<double> x(200, 1.0), key = y;  // tangents
        GreatestOf together(angle), one_by_one(angle);
        double greatest = -2.0;
        for (std::size_t first = 0; first < key.size(); first += 64) {
            const std::size_t n = std::min<std::size_t>(64, key.size() - first);
            together.add(key.data() + first, x.data() + first, y.data() + first, n);
        }
        for (std::size_t i = 0; i < key.size(); ++i) {
            one_by_one.add(key[i], x[i], y[i]);
            greatest = std::max(greatest, angle(x[i], y[i]));
        }
        CHECK(together.value() == one_by_one.value());
        CHECK(together.value() == greatest);
    }
}
