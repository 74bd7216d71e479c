// A vehicle: one or more rigid units, each with a crushable skin and wheels, and joints between them. Constant
// while simulating.
#pragma once

#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/geometry/box.hpp"
#include "birm3d/model/joint.hpp"
#include "birm3d/model/settings.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/model/wheel.hpp"

namespace birm3d {

// Body axes r, s, t (forward, left, up) of ISO 8855 with their origin at the mass centre.
struct RigidBody {
    RigidBody(double mass, const Mat3& inertia);

    double mass;           // kg
    double inverse_mass;   // 1/kg
    Mat3 inertia;          // kg m^2, body axes
    Mat3 inverse_inertia;  // 1/(kg m^2), body axes
};

struct Unit {
    Unit(const RigidBody& body, const TrussInput& trusses, std::vector<Wheel> wheels,
         double mass_center_height, const Vec3& offset = Vec3::Zero(), std::vector<Box> core = {});
    Unit(const RigidBody& body, TrussMesh trusses, std::vector<Wheel> wheels, double mass_center_height,
         const Vec3& offset = Vec3::Zero(), std::vector<Box> core = {});

    RigidBody body;
    TrussMesh trusses;
    std::vector<Wheel> wheels;
    double mass_center_height;  // above the ground in the position of rest (m)
    // Of the mass centre from the vehicle's reference point, forward and to the left in the position of rest; no
    // height (m).
    Vec3 offset;
    // Boxes that the rigid body behind the trusses fills, body axes. They tell how deep it is inside a barrier. Empty
    // for a vehicle that is given by its trusses only.
    std::vector<Box> core;

    // May a post pass the anchor while its truss is open? It may where no box of the rigid body holds the anchor. Vehicles
    // without boxes, or without indentation (indentation_length 0), are rigid at all anchors: their nodes slip round a post,
    // and only anchors stop it.
    bool gives_way(const Vec3& anchor) const;

    // Of the mass centre above the vehicle's reference point on the ground, position of rest (m).
    Vec3 place() const { return offset + mass_center_height * Vec3::UnitZ(); }
};

// Has it wheels to stand on, with all of its skin above the ground in the position of rest?
bool stands_on_wheels(const Unit& unit);

struct Vehicle {
    std::vector<Unit> units;
    std::vector<Joint> joints;
    // Numbers of settings that are this vehicle's own, see usual_settings().
    double cornering_stiffness = Settings{}.cornering_stiffness;
    double edge_flank_factor = Settings{}.edge_flank_factor;
};

// Refuses joints of units that do not exist or of a unit with itself. Refuses joints whose two places are more than
// tolerance::joint_fit apart in the position of rest. Below that the trailing unit's place is moved to the leading
// one's.
Vehicle joined(std::vector<Unit> units, std::vector<Joint> joints);

}  // namespace birm3d
