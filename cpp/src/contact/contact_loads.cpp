#include "contact/contact_loads.hpp"

#include <algorithm>
#include <utility>

#include "base/block_loop.hpp"
#include "contact/corner_contacts.hpp"
#include "contact/tire_contact.hpp"
#include "kernels/friction.hpp"

namespace birm3d {

namespace {

Wrench rotated(const Wrench& w, const Mat3& R) {
    return {R * w.force, R * w.torque};
}

Mat6 rotated(const Mat6& matrix, const Mat3& R) {
    Mat6 rotated;
    for (const int i : {0, 3})
        for (const int j : {0, 3})
            rotated.block<3, 3>(i, j) = R * matrix.block<3, 3>(i, j) * R.transpose();
    return rotated;
}

// Sums over the nodes of one obstacle, body axes.
struct NodeLoads {
    double normal_force, x, y, z, tx, ty, tz;
};

// Keeps the normal forces of nodes whose nearest obstacle is the k-th, and sums their loads.
BIRM3D_BLOCK_LOOP NodeLoads select_loads(const std::array<std::size_t, block_size>& nearest, std::size_t k,
                                         const BlockContact& contact, BlockColumn& normal_force) {
    alignas(64) BlockColumn force, x, y, z, tx, ty, tz;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double magnitude = nearest[i] == k ? contact.normal_force[i] : 0.0;
        normal_force[i] = force[i] = magnitude;
        x[i] = magnitude * contact.nx[i];
        y[i] = magnitude * contact.ny[i];
        z[i] = magnitude * contact.nz[i];
        tx[i] = magnitude * contact.tx[i];
        ty[i] = magnitude * contact.ty[i];
        tz[i] = magnitude * contact.tz[i];
    }
    return {block_sum(force), block_sum(x),  block_sum(y), block_sum(z),
            block_sum(tx),    block_sum(ty), block_sum(tz)};
}

// Replaces the normals of nodes that follow an indentation by its direction into the vehicle. Such nodes move in with
// the post and slide on it only along the panel. So friction acts across that direction.
BIRM3D_BLOCK_LOOP void slide_along_panel(const NodeFaces& faces, BlockContact& contact) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const bool indented = faces.per_force[i] > 0.0;
        contact.nx[i] = indented ? faces.bx[i] : contact.nx[i];
        contact.ny[i] = indented ? faces.by[i] : contact.ny[i];
        contact.nz[i] = indented ? faces.bz[i] : contact.nz[i];
    }
}

void add(const CrushSums& sums, SkinForces& skin) {
    skin.work += sums.work();
    skin.stored += sums.stored();
    skin.stiffness += sums.stiffness();
}

// Reduces normal forces to the part that causes friction on the rigid body (TrussCurve::friction_share).
void take_share(const BlockColumn& friction_share, BlockColumn& normal_force) {
    for (std::size_t i = 0; i < block_size; ++i)
        normal_force[i] *= friction_share[i];
}

// The load on the k-th near obstacle, world axes. Adds its stored energy and its resistance to `skin`. `R`: body to
// world axes.
ContactLoad load_on(const ContactPass& pass, std::size_t k, const ContactSums& all, const Mat3& R,
                    SkinForces& skin) {
    const ObstacleSums& sums = all.obstacles[k];
    ContactLoad load;
    load.obstacle = pass.near[k].index;
    load.contact = sums.contact;
    load.contact += total_wrench(sums.sums);
    load.normal_force = sums.normal_force + sums.sums.normal_force();
    add(sums.sums, skin);
    for (const PlaneSums& plane : all.planes) {
        if (plane.near != k) continue;
        load.contact += total_wrench(plane.surface, plane.sums);
        load.normal_force += plane.sums.normal_force();
        add(plane.sums, skin);
    }
    if (pass.along_trusses) load.contact = sums.by_trusses;
    load.contact = rotated(load.contact, R);
    load.friction = rotated(sums.friction_load.friction, R);
    if (sums.friction_load.resistance.trace() > 0.0) skin.resistance += sums.friction_load.resistance;
    skin.contact += load.contact;
    skin.friction += load.friction;
    skin.normal_force += load.normal_force;
    return load;
}

// Keeps an entry of zero load for each contact that has ended. The divided differences of its structure contain its
// last loads for two more steps.
void keep_ended_loads(const std::vector<ContactLoad>& before, std::vector<ContactLoad>& loads) {
    for (const ContactLoad& last : before) {
        const Load &rate = last.history.rate, &second = last.history.second_difference;
        if (!(last.normal_force > 0.0) && rate.normal_force == 0.0 && second.normal_force == 0.0) continue;
        const auto place = std::lower_bound(
            loads.begin(), loads.end(), last.obstacle,
            [](const ContactLoad& load, std::size_t obstacle) { return load.obstacle < obstacle; });
        if (place != loads.end() && place->obstacle == last.obstacle) continue;
        ContactLoad ended;
        ended.obstacle = last.obstacle;
        loads.insert(place, ended);
    }
}

// Puts the contacts of one structure side by side. Edges and ends of a block come after all blocks of a row.
void sort_by_structure(const Scene& scene, std::vector<ContactLoad>& loads) {
    std::sort(loads.begin(), loads.end(), [&](const ContactLoad& one, const ContactLoad& other) {
        const auto place = [&](const ContactLoad& load) {
            return std::pair(scene.obstacles[load.obstacle].structure, load.obstacle);
        };
        return place(one) < place(other);
    });
}

}  // namespace

void apply_friction(const ContactPass& pass, std::size_t k, const Places& places, const BlockContact& contact,
                    const ContactBlock& block, ContactSums& sums) {
    ObstacleSums& to = sums.obstacles[k];
    if (pass.along_trusses) to.by_trusses += along_trusses(pass.mesh.block[block.index], *block.end, contact);
    if (block.index >= pass.mesh.shell_blocks)
        return note_tire_nodes(pass, k, block.index, places, contact, sums);
    const double mu = pass.obstacle(k).friction;
    if (!(mu > 0.0)) return;
    const Vec3* const normal = block.flat_normal ? &*block.flat_normal : nullptr;
    const Twist& motion = pass.relative_motion[k];
    const bool shares = !pass.mesh.friction_share.empty();
    if (block.indentations.empty() && !shares)
        return add_friction(mu, pass.full_friction_speed, motion, places, contact, normal, to.friction_load);
    BlockContact along = contact;
    if (shares) take_share(pass.mesh.friction_share[block.index], along.normal_force);
    if (block.indentations.empty())
        return add_friction(mu, pass.full_friction_speed, motion, places, along, normal, to.friction_load);
    slide_along_panel(block.faces, along);
    add_friction(mu, pass.full_friction_speed, motion, places, along, nullptr, to.friction_load);
}

void distribute_loads(const ContactPass& pass, ContactBlock& block, ContactSums& sums) {
    if (!block.corners.empty()) distribute_corner_forces(pass, block, sums);
    BlockContact part = block.contact;
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        const NodeLoads loads = select_loads(block.nearest, k, block.contact, part.normal_force);
        if (!(loads.normal_force > 0.0)) continue;
        ObstacleSums& to = sums.obstacles[block.reachable[k]];
        to.contact += {Vec3(loads.x, loads.y, loads.z), Vec3(loads.tx, loads.ty, loads.tz)};
        to.normal_force += loads.normal_force;
        apply_friction(pass, block.reachable[k], block.contact.places(), part, block, sums);
    }
}

void store_loads(const ContactPass& pass, Trial& trial) {
    UnitState& now = trial.state.units[pass.unit_index];
    const ContactSums& sums = trial.skin.sums;
    const Mat3 R = now.body.orientation.toRotationMatrix();
    SkinForces& skin = now.skin;
    skin = {};
    skin.friction_motion = {R * pass.motion.velocity, R * pass.motion.angular_velocity};
    std::vector<ContactLoad>& loads = trial.skin.contact_loads;
    loads.clear();
    add(sums.several, skin);
    for (std::size_t k = 0; k < pass.near.size(); ++k) {
        if (!sums.obstacles[k].reached) continue;
        trial.reached.push_back(pass.near[k].index);
        const ContactLoad load = load_on(pass, k, sums, R, skin);
        if (load.normal_force > 0.0) loads.push_back(load);
    }
    if (skin.resistance.trace() > 0.0) skin.resistance = rotated(skin.resistance, R);
    keep_ended_loads(pass.before.contact_loads, loads);
    sort_by_structure(pass.scene, loads);
    now.contact_loads = loads;
}

}  // namespace birm3d
