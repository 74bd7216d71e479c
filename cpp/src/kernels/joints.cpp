#include "kernels/joints.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

Vec3 place_of(const BodyState& body, const Vec3& place) {
    return body.position + body.orientation * place;
}

// Rotation vector of the leading body from the trailing one, world axes (rad).
Vec3 rotation_between(const BodyState& leading, const BodyState& trailing) {
    const Quat rotation = leading.orientation * trailing.orientation.conjugate();
    const Vec3 half = rotation.w() < 0.0 ? Vec3(-rotation.vec()) : Vec3(rotation.vec());
    const double sine = half.norm();
    if (sine < 1e-6) return 2.0 * half;
    return 2.0 * std::atan2(sine, std::abs(rotation.w())) / sine * half;
}

// Rows of a sliding joint from one that has what they share: displacements along the leading body's axes, of which that
// along r is limited, and rotations.
void find_sliding_rows(const Joint& joint, const BodyState& leading, const BodyState& trailing,
                       RigidContact row, std::vector<RigidContact>& rows) {
    for (const int axis : {0, 1, 2}) {
        row.normal = leading.orientation * Vec3::Unit(axis);
        row.axis = axis;
        row.most_force = axis == 0 ? slide_force(joint, slip_of(joint, leading, trailing)) : infinity;
        row.gap = axis == 0 ? 0.0 : bilateral_gap(joint, row, leading, trailing);
        rows.push_back(row);
    }
    row.about_axis = true;
    for (const int axis : {0, 1, 2}) {
        row.normal = Vec3::Unit(axis);
        row.gap = bilateral_gap(joint, row, leading, trailing);
        rows.push_back(row);
    }
}

}  // namespace

void find_joint_rows(const Joint& joint, std::size_t index, const BodyState& leading,
                     const BodyState& trailing, std::vector<RigidContact>& rows) {
    const Vec3 middle =
        0.5 * (place_of(leading, joint.place_on_leading) + place_of(trailing, joint.place_on_trailing));
    RigidContact row;
    row.source = ContactSource::joint;
    row.index = index;
    row.body = joint.leading;
    row.other = static_cast<int>(joint.trailing);
    row.arm = middle - leading.position;
    row.other_arm = middle - trailing.position;
    row.compliance = tolerance::body_compliance;
    row.bilateral = true;
    if (joint.kind == JointKind::pinned) {
        for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
            row.normal = direction;
            row.gap = bilateral_gap(joint, row, leading, trailing);
            rows.push_back(row);
        }
        return;
    }
    if (joint.kind == JointKind::sliding) return find_sliding_rows(joint, leading, trailing, row, rows);
    const auto hold_along_axes = [&] {
        for (const Vec3& direction : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
            row.normal = direction;
            row.gap = bilateral_gap(joint, row, leading, trailing);
            rows.push_back(row);
        }
    };
    hold_along_axes();
    row.about_axis = true;
    if (joint.kind == JointKind::welded) {
        hold_along_axes();
        return;
    }
    row.bilateral = false;
    const Vec3 axis = (leading.orientation * Vec3::UnitY()).cross(trailing.orientation * Vec3::UnitZ());
    // If the kingpin is parallel to the tilting axis, the direction of the stop is undefined. The stops prevent this
    // position.
    const double size = axis.norm();
    if (size < 1e-6) return;
    const double roll = joint_angles(leading.orientation, trailing.orientation).roll;
    for (const double side : {1.0, -1.0}) {
        row.normal = side / size * axis;
        row.gap = joint.roll_limit - side * roll;
        rows.push_back(row);
    }
}

double bilateral_gap(const Joint& joint, const RigidContact& row, const BodyState& leading,
                     const BodyState& trailing) {
    if (row.about_axis) return row.normal.dot(rotation_between(leading, trailing));
    // The axes of a sliding joint turn with the leading body.
    const Vec3 direction =
        joint.kind == JointKind::sliding ? Vec3(leading.orientation * Vec3::Unit(row.axis)) : row.normal;
    return direction.dot(place_of(leading, joint.place_on_leading) -
                         place_of(trailing, joint.place_on_trailing));
}

double slip_of(const Joint& joint, const BodyState& leading, const BodyState& trailing) {
    const Vec3 apart =
        place_of(trailing, joint.place_on_trailing) - place_of(leading, joint.place_on_leading);
    return apart.dot(leading.orientation * Vec3::UnitX());
}

double slide_force(const Joint& joint, double slip) {
    const double size = std::abs(slip);
    const std::vector<SlideKnot>& knots = joint.slide;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        if (size >= knots[i].slip) continue;
        const double part = (size - knots[i - 1].slip) / (knots[i].slip - knots[i - 1].slip);
        return knots[i - 1].force + part * (knots[i].force - knots[i - 1].force);
    }
    return knots.back().force;
}

JointAngles joint_angles(const Quat& leading, const Quat& trailing) {
    const Mat3 R = (leading.conjugate() * trailing).toRotationMatrix();
    return {std::asin(std::clamp(-R(1, 2), -1.0, 1.0)), std::atan2(R(0, 2), R(2, 2)),
            std::atan2(R(1, 0), R(1, 1))};
}

}  // namespace birm3d
