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

}  // namespace

void barrier_forces(const Scene& scene, std::size_t u, const State& from, Trial& trial) {
    const Unit& unit = scene.vehicle->units[u];
    const UnitState& before = from.units[u];
    UnitState& now = trial.state.units[u];
    const Mat3 R = now.body.orientation.toRotationMatrix();
    const HalfSpace face = scene.barrier->face.seen_from(now.body.position, R);
    const double mu = scene.barrier->friction;
    const double full_speed = std::max(tolerance::full_friction_speed * scene.reference_speed(),
                                       trial.dt * before.skin.friction_rate);
    const Vec3 spin = R.transpose() * angular_velocity(unit.body, now.body);
    const Twist motion{R.transpose() * now.body.velocity, spin};

    const InverseMass inverse_mass(unit.body, face.normal);
    const bool along = scene.settings.contact_model == ContactModel::along_truss;
    CrushSums sums;
    Wrench by_trusses;
    SkinForces friction;
    BlockContact contact;
    trial.active[u].clear();
    for (std::size_t b = 0; b < unit.trusses.blocks; ++b) {
        const TrussBlockState& block = before.trusses.block[b];
        if (!block.touching && !face.within_reach(block.box, 0.0)) continue;
        TrussBlockState& next = now.trusses.block[b];
        crush(inverse_mass, unit.trusses, b, face, block, next, contact, sums);
        if (next.touching) {
            if (along) by_trusses += along_trusses(unit.trusses.block[b], next, face.normal);
            if (mu > 0.0) add_friction(unit.body, mu, full_speed, motion, next, contact, friction);
            if (scene.barrier->finite()) require_on_wall(*scene.barrier, now.body, R, next);
        }
        trial.active[u].add(b);
        trial.stale[u].add(b);
    }
    SkinForces sum = total(sums, face.normal);
    if (along) sum.contact = by_trusses;
    sum += friction;
    now.skin = sum;
    now.skin.contact = turned(sum.contact, R);
    now.skin.friction = turned(sum.friction, R);
    trial.state.statistics.node_evaluations += trial.active[u].blocks().size() * lanes;
}

double nearest_gap(const Scene& scene, const State& state) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Mat3 R = unit.body.orientation.toRotationMatrix();
        const HalfSpace face = scene.barrier->face.seen_from(unit.body.position, R);
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        for (std::size_t b = 0; b < mesh.blocks; ++b) {
            const TrussBlockState& block = unit.trusses.block[b];
            if (!face.within_reach(block.box, nearest)) continue;
            const Lanes gap = gaps(face, block.x, block.y, block.z);
            nearest = std::min(nearest, *std::min_element(gap.begin(), gap.end()));
        }
    }
    return nearest;
}

}  // namespace birm3d
