// Bottomed-out trusses: anchors at an obstacle, where the rigid body itself is in contact.
#pragma once

#include <span>

#include "birm3d/geometry/shape.hpp"
#include "birm3d/model/truss_mesh.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/state.hpp"
#include "geometry/placement.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// An obstacle in the axes of a body.
struct PlacedShape {
    const Shape* shape = nullptr;
    Placement placement;
    std::size_t obstacle = 0;
    double friction = 0.0;
    Twist motion = {};    // of the obstacle, as a twist about the body's origin, body axes
    bool pushes = false;  // on any node of the unit
};

// Distance within which an anchor can reach a surface in dt, in any direction (m); `motion` in body axes.
double core_margin(const TrussMesh& mesh, const Twist& motion, double dt);

// Adds a contact for each anchor that is at the nearest of the surfaces or, as it now moves, will be within dt;
// `motion` in body axes, contacts in world axes. Of obstacles that move too the relative motion counts.
//
// Anchors in no rigid box give way (Unit::gives_way). One that is more than 1 mm inside an obstacle was passed. It is skipped
// while more than 10 % of its truss's depth is left, and then rests where it is. At a post that pushes on any node of the
// unit, those not yet passed are skipped as long, too. A post in the bumper may stand where trusses of the fender are
// anchored: the bumper's trusses stop it there.
void find_core_contacts(const Unit& unit, std::size_t body, const UnitState& state,
                        std::span<const PlacedShape> shapes, const Twist& motion, double dt,
                        std::vector<RigidContact>& contacts);

}  // namespace birm3d
