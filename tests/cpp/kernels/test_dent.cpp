#include "birm3d/kernels/dent.hpp"

#include <vector>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

// 8 by 8 nodes at x = 3 m, trusses straight back to x = 1 m.
const TrussMesh mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8));

std::span<const DentDriver> one(const DentDriver& driver) {
    return {&driver, 1};
}

Vec3 node(std::size_t i) {
    return mesh.node(i);
}

}  // namespace

TEST("a dent falls off with its slope from the node that is pressed") {
    const DentDriver driver{node(20), Vec3::UnitX(), 0.5};
    for (const double slope : {0.5, 1.0, 2.0}) {
        Hanging hanging;
        hang(mesh.block[0], mesh.node_box[0], slope, one(driver), grouped(one(driver)), hanging);
        for (std::size_t i = 0; i < lanes; ++i) {
            const double expected = 0.5 - slope * (node(i) - node(20)).norm();
            if (expected > 0.0)
                CHECK_CLOSE(hanging.deflection[i], expected, 1e-15, "rounding");
            else
                CHECK(hanging.deflection[i] <= 0.0);
        }
    }
}

TEST("each node hangs on the driver that draws it in furthest") {
    const std::vector<DentDriver> drivers = {{node(3), Vec3::UnitX(), 0.4}, {node(40), Vec3::UnitX(), 0.7}};
    Hanging hanging;
    hang(mesh.block[0], mesh.node_box[0], 0.8, drivers, grouped(drivers), hanging);
    for (std::size_t i = 0; i < lanes; ++i) {
        double best = -1.0;
        std::size_t by = 0;
        for (std::size_t k = 0; k < drivers.size(); ++k) {
            const double drawn = drivers[k].deflection - 0.8 * (node(i) - drivers[k].place).norm();
            if (drawn > best) best = drawn, by = k;
        }
        if (best <= 0.0) continue;
        CHECK(hanging.driver[i] == by);
        CHECK_CLOSE(hanging.deflection[i], best, 1e-15, "rounding");
    }
}

TEST("a node between two drivers hangs on both, on the lower one where one stands higher") {
    const auto around_node_20 = [](const Vec3& way) {
        return std::vector<DentDriver>{{node(20) + way, Vec3::UnitX(), 0.5},
                                       {node(20) - way, Vec3::UnitX(), 0.5}};
    };
    Hanging hanging;
    const std::vector<DentDriver> beside = around_node_20(0.1 * Vec3::UnitY());
    hang(mesh.block[0], mesh.node_box[0], 1.0, beside, grouped(beside), hanging);
    CHECK(hanging.driver[20] != hanging.second[20]);
    const std::vector<DentDriver> above = around_node_20(0.1 * Vec3::UnitZ());
    hang(mesh.block[0], mesh.node_box[0], 1.0, above, grouped(above), hanging);
    CHECK(hanging.driver[20] == 1);
    CHECK(hanging.second[20] == 1);
}

TEST("nodes of another panel do not hang on a dent") {
    const DentDriver driver{node(20), Vec3::UnitY(), 0.5};
    Hanging hanging;
    hang(mesh.block[0], mesh.node_box[0], 1.0, one(driver), grouped(one(driver)), hanging);
    for (const double deflection : hanging.deflection)
        CHECK(deflection < 0.0);
}

TEST("a driver does not draw itself in further, nor a node that is pressed as deep") {
    // The slope between neighbours that a wall presses alike is nil: nothing hangs deeper than it is pressed.
    std::vector<DentDriver> drivers;
    for (std::size_t i = 0; i < lanes; ++i)
        drivers.push_back({node(i), Vec3::UnitX(), 0.3});
    Hanging hanging;
    hang(mesh.block[0], mesh.node_box[0], 1.0, drivers, grouped(drivers), hanging);
    for (std::size_t i = 0; i < lanes; ++i) {
        CHECK(hanging.deflection[i] == 0.3);
        CHECK(hanging.driver[i] == i);
    }
}
