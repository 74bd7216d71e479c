#include "kernels/core_friction.hpp"

#include <vector>

#include "check.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;

namespace {

const RigidBody heavy(2000.0, Vec3(800.0, 3000.0, 3200.0).asDiagonal());

// At the end of a segment of 4 m, which the body hits along its own x axis and slides along.
RigidContact at_end(double impulse) {
    RigidContact contact;
    contact.source = ContactSource::core;
    contact.body = 0;
    contact.other = 1;
    contact.other_arm = {0.3, 2.0, 0.0};
    contact.normal = -Vec3::UnitX();
    contact.friction = 0.5;
    contact.impulse = impulse;
    return contact;
}

}  // namespace

TEST("friction does not reverse a sliding, however light the other side") {
    const Twist motion{Vec3(10.0, 3.0, 0.0), Vec3::Zero()};
    for (const double mass : {20.0, 200.0, 2000.0, 1e9})
        for (const double impulse : {10.0, 1e3, 1e5}) {
            const double inverse_inertia = 12.0 / (mass * 16.0);
            std::vector<RigidContact> contacts{at_end(impulse)};
            const Wrench sum =
                core_friction(contacts, 0, heavy, 0.1, motion,
                              1.0 / mass + inverse_inertia * at_end(0.0).other_arm.head<2>().squaredNorm());
            const RigidContact& contact = contacts[0];
            const Vec3 push = -contact.friction_impulse;
            const double turn = inverse_inertia * contact.other_arm.cross(push).z();
            const double other = push.y() / mass + turn * contact.other_arm.x();
            const double left = motion.velocity.y() + heavy.inverse_mass * sum.force.y() - other;
            CHECK(contact.friction_impulse.y() < 0.0);
            CHECK(left > 0.0);
            CHECK(contact.friction_impulse.norm() <= 0.5 * impulse);
        }
}

TEST("fixed surfaces take the whole of it") {
    std::vector<RigidContact> contacts{at_end(100.0)};
    contacts[0].other = -1;
    const Twist motion{Vec3(10.0, 3.0, 0.0), Vec3::Zero()};
    const Wrench sum = core_friction(contacts, 0, heavy, 0.1, motion, 0.0);
    CHECK_CLOSE(sum.force.y(), -50.0, 1e-12, "rounding");
}
