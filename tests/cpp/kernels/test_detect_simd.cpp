#include <cstring>
#include <random>

#include "birm3d/base/block.hpp"
#include "birm3d/geometry/prism.hpp"
#include "check.hpp"
#include "kernels/simd_table.hpp"

using namespace birm3d;

namespace {

struct RunSummary {
    BlockColumn x, y, z, gap, nx, ny, nz;
    Extent extent, of_own;
};

}  // namespace

TEST("every instruction set sees the same bits") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Prism wall = Prism::symmetric({{0.3, 0.0}, {0.3, 0.1}, {0.1, 0.3}, {0.07, 0.8}}, 1.5, 0.5);
    const std::vector<SimdPath> functions = simd_paths();
    int inside = 0, outside = 0;
    for (int round = 0; round < 50; ++round) {
        const double angle = uniform(random), c = std::cos(angle), s = std::sin(angle);
        const PlainPlacement turn{c,  -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0, uniform(random), uniform(random),
                                  0.4};
        BlockColumn x, y, z, force;
        for (std::size_t i = 0; i < block_size; ++i)
            x[i] = uniform(random), y[i] = uniform(random), z[i] = uniform(random),
            force[i] = std::max(0.0, uniform(random) - 0.8);
        const EdgeList faces{wall.edges().data(), wall.edges().size()};
        const EdgeList covered{wall.covered_edges().data(), wall.covered_edges().size()};
        PrismView view{
            faces,        covered,       faces, covered,        1.0,
            wall.y_low(), wall.y_high(), true,  round % 2 == 0, round % 3 == 0 ? nullptr : force.data()};
        RunSummary first;
        for (std::size_t k = 0; k < functions.size(); ++k) {
            RunSummary by{};
            functions[k].find_extent({x.data(), y.data(), z.data()}, by.extent);
            functions[k].place_nodes(turn, {x.data(), y.data(), z.data()},
                                     {by.x.data(), by.y.data(), by.z.data()}, by.of_own);
            functions[k].ask_prism(view, turn, {by.x.data(), by.y.data(), by.z.data()}, by.gap.data(),
                                   {by.nx.data(), by.ny.data(), by.nz.data()});
            if (k == 0) {
                first = by;
                for (const double gap : by.gap)
                    ++(gap < 0.0 ? inside : outside);
            }
            CHECK(std::memcmp(&by, &first, sizeof by) == 0);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const BlockColumn& of = axis == 0 ? x : axis == 1 ? y : z;
            CHECK(first.extent.low[axis] == *std::min_element(of.begin(), of.end()));
            CHECK(first.extent.high[axis] == *std::max_element(of.begin(), of.end()));
            const BlockColumn& own = axis == 0 ? first.x : axis == 1 ? first.y : first.z;
            CHECK(first.of_own.low[axis] == *std::min_element(own.begin(), own.end()));
            CHECK(first.of_own.high[axis] == *std::max_element(own.begin(), own.end()));
        }
    }
    CHECK(inside > 100 && outside > 1000);
}
