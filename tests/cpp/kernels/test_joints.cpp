#include "kernels/joints.hpp"

#include "check.hpp"
#include "kernels/impulse.hpp"
#include "laboratory.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

Quat turn(double angle, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(angle, axis));
}

BodyState at(const Vec3& position, const Quat& orientation) {
    BodyState state;
    state.position = position;
    state.orientation = orientation.normalized();
    return state;
}

const Vec3 on_leading(-2.0, 0.2, 0.3), on_trailing(4.0, 0.2, -0.6);
const Quat attitude = turn(0.3, Vec3(1.0, -2.0, 0.5).normalized());

// A trailing body that follows on the leading one at these angles.
std::pair<BodyState, BodyState> hanging(double pitch, double roll, double yaw) {
    const BodyState leading = at({1.0, -2.0, 0.7}, attitude);
    const Quat q =
        attitude * turn(pitch, Vec3::UnitY()) * turn(roll, Vec3::UnitX()) * turn(yaw, Vec3::UnitZ());
    return {leading, at(leading.position + attitude * on_leading - q * on_trailing, q)};
}

std::vector<RigidContact> rows(const Joint& joint, const BodyState& leading, const BodyState& trailing) {
    std::vector<RigidContact> result;
    find_joint_rows(joint, 0, leading, trailing, result);
    return result;
}

// The pair a little later, for velocities of its rows by differences.
BodyState later(const BodyState& state, const Twist& motion, double dt) {
    const Quat q = turn(motion.angular_velocity.norm() * dt, motion.angular_velocity.normalized());
    return at(state.position + dt * motion.velocity, q * state.orientation);
}

}  // namespace

TEST("angles of a joint are those of a Cardan joint") {
    for (const double pitch : {-0.3, 0.0, 0.2})
        for (const double roll : {-0.03, 0.0, 0.4})
            for (const double yaw : {-2.9, -0.5, 0.0, 1.57}) {
                const auto [leading, trailing] = hanging(pitch, roll, yaw);
                const JointAngles angles = joint_angles(leading.orientation, trailing.orientation);
                CHECK_CLOSE(angles.pitch, pitch, 1e-12, "rounding");
                CHECK_CLOSE(angles.roll, roll, 1e-12, "rounding");
                CHECK_CLOSE(angles.yaw, yaw, 1e-12, "rounding");
            }
}

TEST("a row's velocity is the rate of its gap") {
    const Twist leading_motion{{3.0, -1.0, 0.5}, {0.4, -0.2, 0.7}},
        trailing_motion{{2.0, 0.3, -0.4}, {-0.3, 0.5, 0.1}};
    for (const JointKind kind : {JointKind::fifth_wheel, JointKind::welded, JointKind::sliding}) {
        const Joint joint{kind, 0, 1, on_leading, on_trailing, 0.1, {{0.0, 1e5}}};
        // What is welded is at rest to each other but for rounding; a fifth wheel may stand at any angle.
        const bool welded = kind != JointKind::fifth_wheel;
        const auto [leading, trailing] = welded ? hanging(0.0, 0.0, 0.0) : hanging(0.2, 0.05, -0.8);
        const std::vector<ContactBody> bodies = {{0.0, Mat3::Zero(), leading_motion},
                                                 {0.0, Mat3::Zero(), trailing_motion}};
        const double dt = 1e-6;
        const auto before =
            rows(joint, later(leading, leading_motion, -dt), later(trailing, trailing_motion, -dt));
        const auto now = rows(joint, leading, trailing);
        const auto after =
            rows(joint, later(leading, leading_motion, dt), later(trailing, trailing_motion, dt));
        CHECK(now.size() == (welded ? 6 : 5));
        for (std::size_t i = 0; i < now.size(); ++i) {
            // The row that slides has no gap: it may be anywhere.
            if (may_slide(now[i])) continue;
            CHECK_CLOSE(separation_velocity(now[i], bodies), (after[i].gap - before[i].gap) / (2.0 * dt),
                        1e-8, "differences over 2e-6 s");
            CHECK(now[i].bilateral == (welded || i < 3));
            CHECK(now[i].about_axis == (i >= 3));
            if (now[i].bilateral) CHECK_CLOSE(now[i].gap, 0.0, 1e-14, "closed");
        }
        if (!welded) {
            CHECK_CLOSE(now[3].gap, 0.05, 1e-12, "0.1 less the roll");
            CHECK_CLOSE(now[4].gap, 0.15, 1e-12, "0.1 and the roll");
        }
    }
}

TEST("both bodies are pushed at one place, also when the joint gapes") {
    const Joint joint{JointKind::fifth_wheel, 0, 1, on_leading, on_trailing, 0.1};
    auto [leading, trailing] = hanging(0.1, 0.0, 0.4);
    trailing.position += Vec3(0.01, -0.02, 0.005);
    for (const RigidContact& row : rows(joint, leading, trailing)) {
        CHECK_CLOSE((leading.position + row.arm - trailing.position - row.other_arm).norm(), 0.0, 1e-14,
                    "rounding");
        if (row.bilateral) CHECK_CLOSE(row.gap, -row.normal.dot(Vec3(0.01, -0.02, 0.005)), 1e-14, "rounding");
    }
}
