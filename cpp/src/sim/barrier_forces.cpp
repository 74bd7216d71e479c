#include "birm3d/sim/barrier_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/crush.hpp"
#include "birm3d/kernels/detect.hpp"
#include "birm3d/kernels/friction.hpp"
#include "birm3d/kernels/integrate.hpp"

namespace birm3d {

namespace {

// A wall's plane is met only within its width and height: a node that presses on it beyond them would need
// the wall's end, which is not modelled.
void require_on_wall(const Barrier& barrier, const BodyState& body, const Mat3& R,
                     const TrussBlockState& block) {
    const Vec3 line(-std::sin(barrier.heading), std::cos(barrier.heading), 0.0);
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(block.force[i] > 0.0)) continue;
        const Vec3 place = body.position + R * Vec3(block.x[i], block.y[i], block.z[i]) - barrier.origin;
        const double across = 2.0 * std::abs(place.dot(line));
        if (across > barrier.width)
            refuse("width",
                   ">= " + to_text(across, 4) +
                       " m, where the vehicle meets the wall's plane (its ends are not modelled)",
                   barrier.width);
        if (place.z() > barrier.height)
            refuse("height",
                   ">= " + to_text(place.z(), 4) +
                       " m, where the vehicle meets the wall's plane (its top is not modelled)",
                   barrier.height);
    }
}

Wrench turned(const Wrench& w, const Mat3& R) {
    return {R * w.force, R * w.torque};
}

FlatContact contact_of(const RigidBody& body, const HalfSpace& now, const HalfSpace& before) {
    return {body, now, before};
}

CurvedContact contact_of(const RigidBody& body, const Cylinder& now, const Cylinder& before) {
    return {body, now, before};
}

void set_normals(const FlatContact& surface, BlockContact& contact) {
    contact.set_normal(surface.face.normal);
}

void set_normals(const CurvedContact&, BlockContact&) {}  // crush sets them, node by node

// Motion at the end of the step, body axes: what the drift has made of it, and what the load so far will add
// in the second half of the step.
Twist predicted_motion(const Unit& unit, const LoadCourse& course, double dt, const BodyState& drifted,
                       const Mat3& R) {
    BodyState body = drifted;
    Load coming = scaled(course.now, 0.5 * dt);
    coming += scaled(course.rate, dt * dt / 3.0);
    kick(unit.body, coming.wrench, body);
    return {R.transpose() * body.velocity, R.transpose() * angular_velocity(unit.body, body)};
}

// Crushes one block. The rate of deflection is taken where the nodes will be, so that a rate-sensitive block is
// first crushed without it.
template <class Contact>
void crush_with_rate(const Contact& surface, const TrussMesh& mesh, std::size_t b, const Twist& motion,
                     const TrussBlockState& before, TrussBlockState& now, BlockContact& contact,
                     CrushSums& sums) {
    if (mesh.rate_sensitivity == 0.0) {
        crush(surface, mesh, b, nullptr, before, now, contact, sums);
        return;
    }
    CrushSums without;
    crush(surface, mesh, b, nullptr, before, now, contact, without);
    alignas(64) const Lanes factor = rate_factor(mesh, b, now, motion, contact);
    crush(surface, mesh, b, &factor, before, now, contact, sums);
}

// The forces of one surface on one unit, body axes.
template <class Contact>
SkinForces press_blocks(const Scene& scene, std::size_t u, const State& from, const Contact& surface,
                        const Twist& motion, const Mat3& R, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const TrussMesh& mesh = unit.trusses;
    const UnitState& before = from.units[u];
    UnitState& now = trial.state.units[u];
    const double mu = scene.barrier->friction;
    const double full_speed = std::max(tolerance::full_friction_speed * scene.reference_speed(),
                                       trial.dt * before.skin.friction_rate);
    const bool along = scene.settings.contact_model == ContactModel::along_truss;

    BlockSet& active = trial.active[u];
    active.clear();
    BlockContact contact;
    set_normals(surface, contact);
    CrushSums sums;
    Wrench by_trusses;
    SkinForces friction;
    for (std::size_t b = 0; b < mesh.blocks; ++b) {
        const TrussBlockState& block = before.trusses.block[b];
        if (!block.touching && !surface.face.within_reach(block.box, 0.0)) continue;
        active.add(b);
        trial.stale[u].add(b);
        TrussBlockState& next = now.trusses.block[b];
        crush_with_rate(surface, mesh, b, motion, block, next, contact, sums);
        if (!next.touching) continue;
        if (along) by_trusses += along_trusses(mesh.block[b], next, contact);
        if (mu > 0.0) add_friction(unit.body, mu, full_speed, motion, next, contact, friction);
        if (scene.barrier->finite()) require_on_wall(*scene.barrier, now.body, R, next);
    }
    SkinForces sum = total(surface, sums);
    if (along) sum.contact = by_trusses;
    sum += friction;
    return sum;
}

}  // namespace

void barrier_forces(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const UnitState& before = from.units[u];
    UnitState& now = trial.state.units[u];
    const Mat3 R = now.body.orientation.toRotationMatrix();
    const Mat3 R_before = before.body.orientation.toRotationMatrix();
    // Only friction and the rate of deflection ask for the motion.
    Twist motion;
    if (scene.barrier->friction > 0.0 || unit.trusses.rate_sensitivity > 0.0)
        motion = predicted_motion(unit, before.course, trial.dt, now.body, R);
    now.skin = std::visit(
        [&](const auto& face) {
            const auto surface = contact_of(unit.body, face.seen_from(now.body.position, R),
                                            face.seen_from(before.body.position, R_before));
            return press_blocks(scene, u, from, surface, motion, R, trial);
        },
        scene.barrier->face);
    now.skin.contact = turned(now.skin.contact, R);
    now.skin.friction = turned(now.skin.friction, R);
    trial.state.statistics.node_evaluations += trial.active[u].blocks().size() * lanes;
}

double nearest_gap(const Scene& scene, const State& state) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Mat3 R = unit.body.orientation.toRotationMatrix();
        const Surface face = seen_from(scene.barrier->face, unit.body.position, R);
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        for (std::size_t b = 0; b < mesh.blocks; ++b) {
            const TrussBlockState& block = unit.trusses.block[b];
            if (!within_reach(face, block.box, nearest)) continue;
            const Lanes gap =
                std::visit([&](const auto& shape) { return gaps(shape, block.x, block.y, block.z); }, face);
            nearest = std::min(nearest, *std::min_element(gap.begin(), gap.end()));
        }
    }
    return nearest;
}

}  // namespace birm3d
