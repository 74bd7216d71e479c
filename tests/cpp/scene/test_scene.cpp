#include "birm3d/scene/scene.hpp"

#include <stdexcept>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

double nearest_gap(const Scene& scene) {
    const State state = scene.initial_state();
    const BodyState& body = state.units[0].body;
    const TrussMesh& mesh = scene.vehicle->units[0].trusses;
    double least = 1e9;
    for (std::size_t i = 0; i < mesh.count; ++i)
        least = std::min(least,
                         laboratory::gap_to_barrier(scene, body.position + body.orientation * mesh.node(i)));
    return least;
}

}  // namespace

TEST("the vehicle stands before the wall, its nearest node at the standoff") {
    const auto vehicle = laboratory::block(laboratory::w2_curve());
    for (const double heading : {0.0, 0.5, -2.0}) {
        for (const double degrees : {1.0, 24.0, 90.0, 130.0}) {
            for (const double standoff : {0.0, 0.3}) {
                const Scene scene(vehicle, laboratory::wall(0.2, heading, {3.0, -4.0, 0.0}),
                                  Approach{20.0, degrees * pi / 180.0, 1.5, standoff},
                                  laboratory::weightless(), {});
                CHECK_CLOSE(nearest_gap(scene), standoff, 1e-12, "rounding of a path up to 150 m long");
            }
        }
    }
}

TEST("an upright prism is drawn upwards from its plan") {
    // Seen from above: 2 m along x, 1 m along y, from the corner at (3, 4), turned by 90 degrees; 1.5 m high.
    Element block{Prism({{0.0, 0.0}, {2.0, 0.0}, {2.0, -1.0}, {0.0, -1.0}}, -1.0, 1.5, {.low_end = true}),
                  {3.0, 4.0, 0.0},
                  0.5 * pi};
    block.upright = true;
    const Scene scene(laboratory::block(laboratory::w2_curve()),
                      std::make_shared<Barrier>(std::vector{block}, 0.0, Vec3::Zero(), 0.0), Approach{20.0},
                      laboratory::weightless(), {});
    const auto gap = [&](double x, double y, double z) {
        return laboratory::gap_to_barrier(scene, Vec3(x, y, z) - scene.base);
    };
    CHECK_CLOSE(gap(2.5, 5.0, 0.5), -0.5, 1e-12, "rounding; in the middle of its width");
    CHECK_CLOSE(gap(2.5, 3.0, 0.5), 1.0, 1e-12, "rounding; before it");
    CHECK_CLOSE(gap(2.5, 6.5, 0.5), 0.5, 1e-12, "rounding; behind it");
    CHECK_CLOSE(gap(2.5, 5.0, 1.75), 0.25, 1e-12, "rounding; above its top");
    CHECK_CLOSE(gap(4.0, 5.0, 0.5), 1.0, 1e-12, "rounding; beside it");
}

TEST("speed and angle are those asked for, and the nose is ahead") {
    const double angle = 24.0 * pi / 180.0;
    const Scene scene(laboratory::block(laboratory::w2_curve()), laboratory::wall(),
                      Approach{20.0, angle, 0.0, 0.0}, laboratory::weightless(), {});
    const BodyState body = scene.initial_state().units[0].body;
    CHECK_CLOSE(body.velocity.norm(), 20.0, 1e-14, "rounding");
    CHECK_CLOSE(-body.velocity.dot(scene.barrier->normal()), 20.0 * std::sin(angle), 1e-14, "rounding");
    CHECK_CLOSE((body.orientation * Vec3::UnitX() - body.velocity / 20.0).norm(), 0.0, 1e-15, "rounding");
    CHECK_CLOSE(scene.initial_state().energies.kinetic, 0.5 * 6804.0 * 400.0, 1e-6, "rounding");
}

TEST("the path of the mass centre meets the wall's line at the offset from the world's origin") {
    const double heading = 0.7, angle = 0.6;
    const Vec3 origin(2.0, 1.0, 0.0);
    const Scene scene(laboratory::block(laboratory::w2_curve()), laboratory::wall(0.0, heading, origin),
                      Approach{20.0, angle, 1.25, 0.0}, laboratory::weightless(), {});
    const BodyState body = scene.initial_state().units[0].body;
    const Vec3 start = scene.base + body.position;
    const double t =
        (start - origin).dot(scene.barrier->normal()) / -scene.barrier->normal().dot(body.velocity);
    const Vec3 line(-std::sin(heading), std::cos(heading), 0.0);
    const Vec3 nearest = origin - origin.dot(line) * line;
    CHECK_CLOSE((start + t * body.velocity - nearest - 1.25 * line).norm(), 0.0, 1e-13, "rounding");
}

TEST("the vehicle does not follow a barrier that is moved along its line") {
    const double heading = 0.7;
    const Vec3 line(-std::sin(heading), std::cos(heading), 0.0), away(line.y(), -line.x(), 0.0);
    const auto start = [&](const Vec3& origin) {
        const Scene scene(laboratory::block(laboratory::w2_curve()), laboratory::wall(0.0, heading, origin),
                          Approach{20.0, 0.6, 1.25, 0.3}, laboratory::weightless(), {});
        return Vec3(scene.base + scene.initial_state().units[0].body.position);
    };
    const Vec3 here = start(Vec3::Zero());
    CHECK_CLOSE((start(0.6 * line) - here).norm(), 0.0, 1e-13, "rounding");
    CHECK_CLOSE((start(2.0 * away) - here - 2.0 * away).norm(), 0.0, 1e-13, "rounding");
}

TEST("what can not be run is refused") {
    const auto vehicle = laboratory::block(laboratory::w2_curve());
    const auto refused = [&](const Approach& approach, const Settings& settings,
                             std::optional<double> duration) {
        CHECK_THROWS(Scene(vehicle, laboratory::wall(), approach, settings, duration), std::invalid_argument);
    };
    const Settings good = laboratory::weightless();
    refused({-1.0, 1.0, 0.0, 0.0}, good, {});
    refused({std::nan(""), 1.0, 0.0, 0.0}, good, {});
    refused({20.0, -0.1, 0.0, 0.0}, good, {});
    refused({20.0, pi + 0.1, 0.0, 0.0}, good, {});
    refused({20.0, 1.0, 0.0, -0.1}, good, {});
    refused({20.0, 1.0, 0.0, 0.0}, good, 0.0);
    refused({0.0, 1.0, 0.0, 0.0}, good, {});
    Settings bad = good;
    bad.time_step = 0.0;
    refused({20.0, 1.0, 0.0, 0.0}, bad, {});
    bad = good;
    bad.restitution = 1.5;
    refused({20.0, 1.0, 0.0, 0.0}, bad, {});
    CHECK_THROWS(Scene(nullptr, laboratory::wall(), Approach{20.0, 1.0, 0.0, 0.0}, good, {}),
                 std::invalid_argument);
    CHECK_THROWS(Scene(vehicle, nullptr, Approach{20.0, 1.0, 0.0, 0.0}, good, {}), std::invalid_argument);
    CHECK_THROWS(Barrier::wall(-0.1, Vec3::Zero(), 0.0), std::invalid_argument);
}

TEST("parts are of an element before them, and stand fast") {
    const Element face{Prism::box(0.5, 2.0, 1.0, 1.0)};
    const auto refused = [&](std::size_t whole, std::optional<FreeStanding> free) {
        Element part = face;
        part.part_of = whole;
        try {
            const Barrier barrier({face, part}, 0.0, Vec3::Zero(), 0.0, free);
        } catch (const std::invalid_argument&) {
            return true;
        }
        return false;
    };
    CHECK(!refused(0, {}));
    CHECK(refused(1, {}));
    CHECK(refused(0, FreeStanding{2400.0, 0.5, SegmentJoint::loose}));
}
