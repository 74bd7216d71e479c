#include "contact/corner_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/contact_loads.hpp"
#include "contact/indentation.hpp"
#include "contact/lagging_nodes.hpp"
#include "contact/released_nodes.hpp"

namespace birm3d {

namespace {

// Moves the places of nodes that are inside their nearest face onto it, along its normal.
BIRM3D_BLOCK_LOOP void move_out(const NodeFaces& faces, const BlockContact& contact, BlockColumn& x,
                                BlockColumn& y, BlockColumn& z) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double depth = faces.gap[i] < -tolerance::touching_gap ? faces.gap[i] : 0.0;
        x[i] -= depth * contact.nx[i];
        y[i] -= depth * contact.ny[i];
        z[i] -= depth * contact.nz[i];
    }
}

// Sets `cornered` to 1 for nodes that lie inside another surface once they have been moved out of theirs. `gap`: of the moved
// nodes to that surface (m). Returns the number of all nodes with a 1.
BIRM3D_BLOCK_LOOP double note_inside(const NodeFaces& faces, const BlockColumn& gap, BlockColumn& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        cornered[i] =
            faces.gap[i] < -tolerance::touching_gap && gap[i] < -tolerance::touching_gap ? 1.0 : cornered[i];
    alignas(64) BlockColumn sum = cornered;
    return block_sum(sum);
}

// Sets `cornered` to 1 for nodes whose truss pushes and that are within `margin` of a second surface (m). `second`: gap to the
// second nearest one (m).
BIRM3D_BLOCK_LOOP void note_pushing(const BlockColumn& force, const BlockColumn& second, double margin,
                                    BlockColumn& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        cornered[i] = force[i] > 0.0 && second[i] <= margin ? 1.0 : cornered[i];
}

// The face of the node's nearest obstacle.
CornerFace nearest_face_of(const ContactBlock& block, std::size_t i) {
    const NodeFaces& faces = block.faces;
    CornerFace face;
    face.reachable_index = block.nearest[i];
    face.gap = faces.gap[i];
    face.normal = face.gradient = face.direction = block.contact.normal(i);
    if (faces.per_force[i] > 0.0) {
        face.indented = true;
        face.direction = {faces.bx[i], faces.by[i], faces.bz[i]};
        face.per_force = faces.per_force[i];
        // A displacement of the node changes the gap in full. One of the post changes it only in part, as the
        // indentation widens.
        face.gradient = face.per_force * face.normal;
        face.gradient += (1.0 - face.gradient.dot(face.direction)) * face.direction;
        face.place = {block.contact.px[i], block.contact.py[i], block.contact.pz[i]};
        face.torque = block.contact.torque(i);
    }
    return face;
}

// The face of the k-th reachable obstacle that is nearest to `place`; its gap is that of the i-th node, without its lag.
CornerFace face_at(const ContactPass& pass, const ContactBlock& block, std::size_t i, std::size_t k,
                   const Vec3& place) {
    const Vec3 node(block.start->x[i], block.start->y[i], block.start->z[i]);
    const NearObstacle& near = pass.near[block.reachable[k]];
    const Nearest there = nearest(pass.shape(block.reachable[k]), near.now.to_own(place));
    CornerFace face;
    face.reachable_index = k;
    face.normal = face.gradient = face.direction = near.now.direction_from_own(there.normal);
    face.gap = there.gap + face.normal.dot(node - place);
    if (block.start->may_lag(i) || block.lagging[i])
        face.gap = without_lag(near, node, face.normal, face.gap);
    return face;
}

// Is the place beside the k-th reachable obstacle, past an end where the next one begins? There the neighbour's surface
// continues, so that the edge at that end is not a real one.
bool is_past_covered_end(const ContactPass& pass, const ContactBlock& block, std::size_t k,
                         const Vec3& place) {
    const auto* prism = std::get_if<Prism>(&pass.shape(block.reachable[k]));
    return prism != nullptr &&
           prism->is_past_covered_end(pass.near[block.reachable[k]].now.to_own(place).y());
}

// Was the node on the k-th reachable obstacle at the start of the step, at a face with this normal?
bool stood_on(const ContactPass& pass, const ContactBlock& block, std::size_t k, const Vec3& normal,
              const Vec3& node) {
    const NearObstacle& near = pass.near[block.reachable[k]];
    const Nearest then = nearest(pass.shape(block.reachable[k]), near.before.to_own(node));
    return std::abs(then.gap) <= tolerance::on_surface &&
           near.before.direction_from_own(then.normal).dot(normal) > tolerance::same_face;
}

// Adds the faces that a pushing node has been on since the start of the step. Where two segments of a wall meet, the
// nearest face replaces that of the other segment. `stays`: was the node on its nearest face before?
void add_faces_since_start(const ContactPass& pass, const ContactBlock& block, const Vec3& node,
                           const CornerFace& nearest_face, bool stays, Corner& corner) {
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        if (k == nearest_face.reachable_index ||
            !is_solid_to(pass, block.index, corner.node_index, block.reachable[k]))
            continue;
        if (!stays && stood_on(pass, block, k, nearest_face.normal, node)) {
            if (corner.count == 0) corner.add(nearest_face);
            continue;
        }
        if (is_past_covered_end(pass, block, k, node)) continue;
        const CornerFace face = face_at(pass, block, corner.node_index, k, node);
        const bool was_on =
            std::abs(face.gap) <= tolerance::touching_gap || stood_on(pass, block, k, face.normal, node);
        if (was_on) corner.add(face);
    }
}

// Adds the surfaces that the node would enter when it is moved onto the surfaces that it is on.
void add_driving(const ContactPass& pass, const ContactBlock& block, const Vec3& node, Corner& corner) {
    for (std::size_t round = 0; round < Corner::most && corner.count < Corner::most; ++round) {
        const Vec3 place = node + corner.displacement();
        bool any = false;
        for (std::size_t k = 0; k < block.reachable.size(); ++k) {
            if (!is_solid_to(pass, block.index, corner.node_index, block.reachable[k])) continue;
            const CornerFace face = face_at(pass, block, corner.node_index, k, place);
            const double gap = face.gap + face.normal.dot(place - node);
            any = (gap < -tolerance::touching_gap && corner.add(face)) || any;
        }
        if (!any) return;
    }
}

// Moves the node onto the faces of its corner. Along faces that its truss does not push on it moves freely: energy
// that its truss releases there is lost.
void place_in_corner(const ContactPass& pass, const Corner& corner, const Vec3& to, ContactBlock& block) {
    const TrussBlock& truss = pass.mesh.block[block.index];
    TrussBlockState& nodes = block.alter();
    const std::size_t i = corner.node_index;
    const Vec3 anchor = anchor_of(truss, i);
    // Deflections of the truss (m): with the node on all faces, and on those only that the truss pushes on.
    const double deflection = truss.length[i] - (anchor - to).norm();
    const double free = truss.length[i] - (anchor - (to - corner.pushed_displacement())).norm();
    double lost_work = 0.0;
    if (nodes.force[i] > 0.0 && free < nodes.deflection[i]) {
        const double before = nodes.force[i];
        // A line goes on from its force. From the residual, as unloading_force(), it would round otherwise.
        nodes.force[i] =
            has_recovery(truss.recovery[i])
                ? std::min(nodes.force[i], unloading_force(truss, nodes, i, free))
                : std::max(0.0, nodes.force[i] + nodes.unloading[i] * (free - nodes.deflection[i]));
        nodes.deflection[i] = free;
        // By the trapezoid rule the force before the drop has acted over half of the step.
        lost_work = 0.5 * (before - nodes.force[i]) * std::max(0.0, deflection - free);
    }
    nodes.x[i] = to.x(), nodes.y[i] = to.y(), nodes.z[i] = to.z();
    block.faces.gap[i] = nodes.force[i] > 0.0 && deflection < nodes.deflection[i]
                             ? tolerance::negligible_gap
                             : -tolerance::negligible_gap;
    const Vec3 along_truss = (anchor - to).normalized();
    block.set_normals(i, along_truss, along_truss);
    block.faces.per_force[i] = 0.0;
    const auto most =
        std::max_element(corner.face.begin(), corner.face.begin() + static_cast<std::ptrdiff_t>(corner.count),
                         [](const CornerFace& a, const CornerFace& c) { return a.weight < c.weight; });
    block.nearest[i] = most->reachable_index;
    block.corners.push_back(corner);
    block.corners.back().lost_work = lost_work;
}

// Finds all faces that the node is in contact with, and moves it onto them.
void resolve_corner(const ContactPass& pass, std::size_t i, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    const Vec3 node(nodes.x[i], nodes.y[i], nodes.z[i]);
    const Vec3 anchor = anchor_of(pass.mesh.block[block.index], i);
    if ((anchor - node).norm() <= tolerance::truss_length) return;
    Corner corner;
    corner.node_index = i;
    const CornerFace nearest_face = nearest_face_of(block, i);
    // An indentation that releases the node is no face of its corner: its gap is that of a node far away. Other faces may
    // still hold the node.
    const bool leaves = nearest_face.indented && block.released[i] > 0.0;
    const bool stays =
        !leaves && (nearest_face.indented ||
                    stood_on(pass, block, nearest_face.reachable_index, nearest_face.normal, node));
    if (stays || nearest_face.gap <= tolerance::touching_gap) corner.add(nearest_face);
    if (nodes.force[i] > 0.0) {
        add_faces_since_start(pass, block, node, nearest_face, stays || leaves, corner);
        corner.distribute((anchor - node).normalized());
        corner.release();
    }
    if (corner.count == 0) {
        if (leaves) return;
        corner.add(nearest_face);
    }
    add_driving(pass, block, node, corner);
    const bool alone = corner.count == 1 && corner.face[0].reachable_index == nearest_face.reachable_index &&
                       corner.face[0].gap == nearest_face.gap;
    if (alone) return;
    const Vec3 to = node + corner.displacement();
    const Vec3 arm = anchor - to;
    if (!(arm.norm() > tolerance::truss_length) || corner.distribute(arm.normalized()) == 0) return;
    place_in_corner(pass, corner, to, block);
}

// Adds the forces that the k-th reachable obstacle gets at the faces number `face_index` of all corners. `force`: of the truss
// of each corner (N). `part`: working memory.
void add_corner_forces(const ContactPass& pass, const std::vector<double>& force, std::size_t face_index,
                       std::size_t k, const ContactBlock& block, BlockContact& part, ContactSums& sums) {
    ObstacleSums& to = sums.obstacles[block.reachable[k]];
    part.normal_force.fill(0.0);
    double sum = 0.0;
    for (std::size_t c = 0; c < block.corners.size(); ++c) {
        const CornerFace& face = block.corners[c].face[face_index];
        const std::size_t i = block.corners[c].node_index;
        if (face_index >= block.corners[c].count || face.reachable_index != k ||
            !(face.weight * force[c] > 0.0))
            continue;
        const Vec3 node(block.end->x[i], block.end->y[i], block.end->z[i]);
        const Vec3 at = face.indented ? face.place : node;
        const Vec3 torque = face.indented ? face.torque : Vec3(node.cross(face.normal));
        const double normal_force = force[c] * face.weight * face.per_force;
        part.normal_force[i] = normal_force;
        // Friction acts across the direction in which an indentation moves the node, as on nodes outside of corners.
        const Vec3& across = face.indented ? face.direction : face.normal;
        part.nx[i] = across.x(), part.ny[i] = across.y(), part.nz[i] = across.z();
        part.px[i] = at.x(), part.py[i] = at.y(), part.pz[i] = at.z();
        to.contact += {normal_force * face.normal, normal_force * torque};
        sum += normal_force;
    }
    if (!(sum > 0.0)) return;
    to.normal_force += sum;
    apply_friction(pass, block.reachable[k], part.places(), part, block, sums);
}

}  // namespace

void resolve_corner_contacts(const ContactPass& pass, ContactBlock& block) {
    const auto is_post = [&](std::size_t k) { return std::holds_alternative<Post>(pass.shape(k)); };
    // Posts are too far apart for a node to touch two.
    if (std::all_of(block.reachable.begin(), block.reachable.end(), is_post)) return;
    alignas(64) BlockColumn cornered;  // 1 for nodes that may be in a corner, else 0
    cornered.fill(0.0);
    const TrussBlockState& nodes = *block.start;
    if (nodes.touching) note_pushing(nodes.force, block.second_gap, pass.margin, cornered);
    if (*std::min_element(block.faces.gap.begin(), block.faces.gap.end()) < -tolerance::touching_gap) {
        alignas(64) BlockColumn x = nodes.x, y = nodes.y, z = nodes.z;
        move_out(block.faces, block.contact, x, y, z);
        alignas(64) NearestOfBlock found;
        for (const std::size_t k : block.reachable) {
            nearest_of(pass.shape(k), pass.near[k].now, pass.near[k].now, x, y, z, found);
            omit_indented(pass, block.index, k, found);
            note_inside(block.faces, found.gap, cornered);
        }
    }
    for (std::size_t i = 0; i < block_size; ++i)
        if (cornered[i] > 0.0) resolve_corner(pass, i, block);
}

void resolve_known_corner(const ContactPass& pass, Corner corner, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    const std::size_t i = corner.node_index;
    const Vec3 to = Vec3(nodes.x[i], nodes.y[i], nodes.z[i]) + corner.displacement();
    const Vec3 arm = anchor_of(pass.mesh.block[block.index], i) - to;
    if (arm.norm() > tolerance::truss_length && corner.distribute(arm.normalized()) > 0)
        place_in_corner(pass, corner, to, block);
}

void distribute_corner_forces(const ContactPass& pass, ContactBlock& block, ContactSums& sums) {
    std::vector<double> force;
    for (const Corner& corner : block.corners) {
        force.push_back(block.contact.normal_force[corner.node_index]);
        block.contact.normal_force[corner.node_index] = 0.0;
    }
    BlockContact part = block.contact;
    for (std::size_t face_index = 0; face_index < Corner::most; ++face_index)
        for (std::size_t k = 0; k < block.reachable.size(); ++k)
            add_corner_forces(pass, force, face_index, k, block, part, sums);
}

}  // namespace birm3d
