// A vehicle: one or more rigid units, each with a crushable skin and wheels. Constant while simulating.
#pragma once

#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

// Body axes r, s, t (forward, left, up) of ISO 8855 with their origin at the mass centre.
struct RigidBody {
    RigidBody(double mass, const Mat3& inertia);

    double mass;           // kg
    double inverse_mass;   // 1/kg
    Mat3 inertia;          // kg m^2, body axes
    Mat3 inverse_inertia;  // 1/(kg m^2), body axes
};

// A disc that rolls about the body's s axis; only its lowest point meets the ground.
struct Wheel {
    Vec3 center = Vec3::Zero();  // body axes (m)
    double radius = 0.0;         // m
};

struct Unit {
    Unit(const RigidBody& body, const TrussInput& trusses, std::vector<Wheel> wheels,
         double mass_center_height);

    RigidBody body;
    TrussMesh trusses;
    std::vector<Wheel> wheels;
    double mass_center_height;  // above the ground in the position of rest (m)
};

struct Vehicle {
    std::vector<Unit> units;
};

}  // namespace birm3d
