#include "birm3d/model/vehicle.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

Mat3 checked_inertia(const Mat3& inertia) {
    if (!inertia.allFinite()) refuse("inertia", "finite", "an entry that is not");
    const double size = inertia.cwiseAbs().maxCoeff();
    const double skew = (inertia - inertia.transpose()).cwiseAbs().maxCoeff();
    if (skew > tolerance::symmetric_inertia * size)
        refuse("inertia", "symmetric", "a difference of " + to_text(skew) + " kg m^2");
    const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
    if (!(principal[0] > 0.0)) refuse("smallest principal moment of inertia", "> 0 kg m^2", principal[0]);
    // No body of positive mass has one principal moment above the sum of the others.
    if (principal[2] > (principal[0] + principal[1]) * (1.0 + tolerance::symmetric_inertia))
        refuse("largest principal moment of inertia",
               "at most the sum of the others (" + to_text(principal[0] + principal[1]) + " kg m^2)",
               principal[2]);
    return 0.5 * (inertia + inertia.transpose());
}

}  // namespace

RigidBody::RigidBody(double mass_, const Mat3& inertia_)
    : mass(require_positive("mass", mass_)),
      inverse_mass(1.0 / mass_),
      inertia(checked_inertia(inertia_)),
      inverse_inertia(inertia.inverse()) {}

namespace {

// Notes the two ends of each beam axle: sprung wheels side by side whose springs stand inside of them.
void find_axles(std::vector<Wheel>& wheels) {
    constexpr double same_place = 0.02;  // m
    const auto on_axle = [](const Wheel& wheel) {
        return wheel.suspension.springs() && wheel.suspension.roll_ratio < 1.0;
    };
    for (Wheel& wheel : wheels)
        wheel.opposite = Wheel::none;
    // How far two wheels are from a mirrored pair (m); infinite where they are on one side, or not side by side.
    const auto asymmetry = [](const Vec3& one, const Vec3& other) {
        const bool beside =
            one.y() * other.y() < 0.0 && std::hypot(one.x() - other.x(), one.z() - other.z()) < same_place;
        return beside ? std::abs(one.y() + other.y()) : infinity;
    };
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        if (!on_axle(wheels[i]) || wheels[i].opposite != Wheel::none) continue;
        double least = infinity;
        std::size_t nearest = Wheel::none;
        for (std::size_t j = i + 1; j < wheels.size(); ++j) {
            if (!on_axle(wheels[j]) || wheels[j].opposite != Wheel::none) continue;
            const double off = asymmetry(wheels[i].center, wheels[j].center);
            if (off < least) least = off, nearest = j;
        }
        if (nearest == Wheel::none) continue;
        wheels[i].opposite = nearest, wheels[nearest].opposite = i;
    }
}

}  // namespace

// The list of wheels is a parameter by value for both constructors, so that callers may move theirs.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
Unit::Unit(const RigidBody& body_, const TrussInput& trusses_, std::vector<Wheel> wheels_,
           double mass_center_height_, const Vec3& offset_, std::vector<Box> core_)
    : Unit(body_, TrussMesh(trusses_, wheels_), wheels_, mass_center_height_, offset_, std::move(core_)) {}

Unit::Unit(const RigidBody& body_, TrussMesh trusses_, std::vector<Wheel> wheels_, double mass_center_height_,
           const Vec3& offset_, std::vector<Box> core_)
    : body(body_),
      trusses(std::move(trusses_)),
      wheels(std::move(wheels_)),
      mass_center_height(require_finite("mass_center_height", mass_center_height_)),
      offset(offset_),
      core(std::move(core_)) {
    for (std::size_t i = 0; i < core.size(); ++i)
        if (!core[i].center.allFinite() || !core[i].half.allFinite() || !(core[i].half.minCoeff() > 0.0))
            refuse("core[" + std::to_string(i) + "]", "finite, with a size > 0 m along each axis",
                   "one that is not");
    if (!offset.allFinite()) refuse("offset", "finite", "a coordinate that is not");
    if (offset.z() != 0.0) refuse("offset height", "0 m (the height is mass_center_height)", offset.z());
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        const std::string name = "wheels[" + std::to_string(i) + "]";
        require_positive((name + " radius").c_str(), wheels[i].radius);
        if (!(wheels[i].breakaway > 0.0)) refuse(name + " breakaway", "> 0 N", wheels[i].breakaway);
        if (!(wheels[i].travel >= 0.0 && std::isfinite(wheels[i].travel)))
            refuse(name + " travel", "finite and >= 0 m", wheels[i].travel);
        const auto require_at_least_zero = [&](const char* what, const char* unit, double value) {
            if (!(value >= 0.0 && std::isfinite(value)))
                refuse(name + " " + what, std::string("finite and >= 0 ") + unit, value);
        };
        require_at_least_zero("stiffness", "N/m", wheels[i].suspension.stiffness);
        require_at_least_zero("damping", "N s/m", wheels[i].suspension.damping);
        require_at_least_zero("compression at rest", "m", wheels[i].suspension.at_rest);
        require_at_least_zero("bump travel", "m", wheels[i].suspension.bump);
        if (!(wheels[i].suspension.roll_ratio > 0.0 && wheels[i].suspension.roll_ratio <= 1.0))
            refuse(name + " roll ratio", "> 0 and <= 1", wheels[i].suspension.roll_ratio);
        if (!(wheels[i].steering_time > 0.0))
            refuse(name + " steering time", "> 0 s", wheels[i].steering_time);
        if (!(wheels[i].tread_radius >= 0.0 && wheels[i].tread_radius <= wheels[i].radius))
            refuse(name + " tread radius", ">= 0 m and at most the wheel's", wheels[i].tread_radius);
        require_at_least_zero("camber ratio", "", wheels[i].camber_ratio);
        require_at_least_zero("rolling resistance", "", wheels[i].rolling_resistance);
        if (i >= most_breakaway_wheels && std::isfinite(wheels[i].breakaway))
            refuse(name + " breakaway", "inf beyond the first 64 wheels", wheels[i].breakaway);
        if (!wheels[i].center.allFinite()) refuse(name + " center", "finite", "a coordinate that is not");
        const double height = mass_center_height + wheels[i].center.z() - wheels[i].radius;
        if (height < -1e-3)
            refuse(name + " height of the lowest point above the ground", ">= -0.001 m", height);
    }
    find_axles(wheels);
}

bool Unit::gives_way(const Vec3& anchor) const {
    return !core.empty() && trusses.indentation_length > 0.0 &&
           std::none_of(core.begin(), core.end(), [&](const Box& box) {
               return ((anchor - box.center).cwiseAbs() - box.half).maxCoeff() <= tolerance::touching_gap;
           });
}

bool stands_on_wheels(const Unit& unit) {
    if (unit.wheels.empty()) return false;
    const TrussMesh& mesh = unit.trusses;
    for (std::size_t b = 0; b < mesh.skin_blocks; ++b) {
        const auto first = mesh.block[b].node_z.begin();
        const double lowest = *std::min_element(first, first + static_cast<std::ptrdiff_t>(mesh.nodes_in(b)));
        if (lowest + unit.mass_center_height < 0.0) return false;
    }
    return true;
}

namespace {

// Of a sliding joint at least one knot, at slips that increase from zero on, with forces that are no less than zero.
void check_slide(const Joint& joint, const std::string& name) {
    const bool slides = joint.kind == JointKind::sliding;
    if (slides == joint.slide.empty())
        refuse(name + " slide",
               slides ? "a knot or more of a sliding joint" : "none of a joint that does not slide",
               static_cast<double>(joint.slide.size()));
    for (std::size_t k = 0; k < joint.slide.size(); ++k) {
        const auto& [slip, force] = joint.slide[k];
        const bool follows = k == 0 ? slip == 0.0 : slip > joint.slide[k - 1].slip;
        if (!follows || !std::isfinite(slip))
            refuse(name + " slide", "0 first, then increasing and finite slips", slip);
        if (!(force >= 0.0) || !std::isfinite(force)) refuse(name + " slide", "finite forces >= 0", force);
    }
}

}  // namespace

Vehicle joined(std::vector<Unit> units, std::vector<Joint> joints) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
        Joint& joint = joints[i];
        const std::string name = "joints[" + std::to_string(i) + "]";
        for (const std::size_t unit : {joint.leading, joint.trailing})
            if (unit >= units.size())
                refuse(name + " unit", "below " + std::to_string(units.size()), static_cast<double>(unit));
        if (joint.leading == joint.trailing)
            refuse(name + " units", "two", "unit " + std::to_string(joint.leading) + " with itself");
        for (const Vec3& place : {joint.place_on_leading, joint.place_on_trailing})
            if (!place.allFinite()) refuse(name + " place", "finite", "a coordinate that is not");
        require_within((name + " roll_limit").c_str(), joint.roll_limit, 0.0, 0.5 * std::numbers::pi);
        check_slide(joint, name);
        const Vec3 place = units[joint.leading].place() + joint.place_on_leading;
        const Vec3 on_trailing = place - units[joint.trailing].place();
        const double apart = (on_trailing - joint.place_on_trailing).norm();
        if (!(apart <= tolerance::joint_fit))
            refuse("distance of the two places of " + name + " at rest",
                   "<= " + to_text(tolerance::joint_fit) + " m", apart);
        joint.place_on_trailing = on_trailing;
    }
    return {std::move(units), std::move(joints)};
}

}  // namespace birm3d
