#include "kernels/steering.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "kernels/tires.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

constexpr double lag = 0.08;  // s
const std::vector<double> loads{3.0, 1.0, 2.0, 2.0};

Unit steered_in_front() {
    std::vector<Wheel> wheels = laboratory::four_wheels();
    for (Wheel& wheel : wheels)
        if (wheel.center.x() > 0.0) wheel.steering_time = lag;
    return Unit(laboratory::body(), laboratory::front_face(laboratory::w2_curve(), 2, 2), wheels, 1.0);
}

Twist moving(double direction) {
    return {20.0 * Vec3(std::cos(direction), std::sin(direction), 0.0), Vec3::Zero()};
}

double steered_from(double angle, double travel, double dt, const std::vector<double>& impulses = loads) {
    return steered(steered_in_front(), Quat::Identity(), moving(travel), angle, dt, impulses);
}

}  // namespace

TEST("wheels follow the direction of travel with their lag, in any number of steps") {
    const double once = steered_from(0.05, 0.2, 0.1);
    CHECK_CLOSE(once, 0.2 - 0.15 * std::exp(-0.1 / lag), 1e-12, "first order");
    double angle = 0.05;
    for (int i = 0; i < 100; ++i)
        angle = steered_from(angle, 0.2, 0.001);
    CHECK_CLOSE(angle, once, 1e-12, "rounding");
    CHECK_CLOSE(steered_from(-0.05, -0.2, 0.1), -once, 1e-15, "mirror image");
}

TEST("steering ends at its stops, and stays without a load or backwards") {
    CHECK_CLOSE(steered_from(0.0, 1.5, 100.0), 0.6, 1e-15, "34 degrees");
    CHECK(steered_from(0.05, 0.2, 0.1, {0.0, 0.0, 5.0, 5.0}) == 0.05);
    CHECK(steered_from(0.05, 3.0, 0.1) == 0.05);
}

TEST("wheels that travel where they are steered feel no force, and friction never drives") {
    const Unit unit = steered_in_front();
    const std::vector<double> front{1000.0, 1000.0, 0.0, 0.0};
    for (const double travel : {-0.5, 0.0, 0.3, 1.2}) {
        const Twist straight = moving(travel), motion{straight.velocity, {0.0, 0.0, 0.4}};
        for (const double angle : {-0.6, 0.0, 0.25}) {
            const Wrench f = tire_friction(unit, Settings(), {}, angle, {motion, motion}, loads);
            CHECK(f.force.dot(motion.velocity) + f.torque.dot(motion.angular_velocity) <= 0.0);
        }
        const Wrench none = tire_friction(unit, Settings(), {}, travel, {straight, straight}, front);
        CHECK_CLOSE(none.force.norm(), 0.0, 1e-9, "rounding, of 2,000 N s");
    }
}
