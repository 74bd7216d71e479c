#include "contact/stopping_face.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "contact/corner_contacts.hpp"
#include "contact/released_nodes.hpp"

namespace birm3d {

namespace {

// Distances beyond the stop at which the face is searched, one after the other (m).
constexpr double behind_stop[] = {1e-5, 1e-4, 1e-3};

bool is_outside(const ContactPass& pass, std::size_t b, std::size_t i, const Vec3& place) {
    for (std::size_t k = 0; k < pass.near.size(); ++k)
        if (is_solid_to(pass, b, i, k) &&
            nearest(pass.shape(k), pass.near[k].now.to_own(place)).gap < -tolerance::touching_gap)
            return false;
    return true;
}

// The nearest face to `place` that a path with the direction `along` enters. `was`: the node at the start of the step.
MetFace face_entered(const ContactPass& pass, const ContactBlock& block, const StoppedNode& node,
                     const Vec3& place, const Vec3& along, const Vec3& was) {
    MetFace face;
    double least = 0.0;
    for (std::size_t k = 0; k < pass.near.size(); ++k) {
        if (!is_solid_to(pass, block.index, node.node_index, k)) continue;
        const Nearest there = nearest(pass.shape(k), pass.near[k].now.to_own(place));
        const Vec3 normal = pass.near[k].now.direction_from_own(there.normal);
        if (!(there.gap < least) || !(normal.dot(along) < 0.0)) continue;
        least = there.gap;
        face = {k, normal, normal.dot(was - node.place)};
    }
    return face;
}

CornerFace corner_face(const MetFace& met, const ContactBlock& block) {
    CornerFace face;
    face.reachable_index = static_cast<std::size_t>(
        std::find(block.reachable.begin(), block.reachable.end(), met.near) - block.reachable.begin());
    face.gap = met.gap;
    face.normal = face.gradient = face.direction = met.normal;
    return face;
}

// The corner of the two faces: the one that stopped the node and the one that released it.
Corner corner_of(const StoppedNode& node, const ContactBlock& block) {
    Corner corner;
    corner.node_index = node.node_index;
    corner.add(corner_face(node.stopped_by, block));
    corner.add(corner_face(node.released_by, block));
    return corner;
}

// Was the node on the face before, and can it be on both faces now?
bool stays_on(const ContactPass& pass, const ContactBlock& block, const StoppedNode& node, const Vec3& was) {
    const NearObstacle& near = pass.near[node.stopped_by.near];
    const Vec3 moved = near.before.to_own(was) - near.now.to_own(node.place);
    if (std::abs(near.now.direction_to_own(node.stopped_by.normal).dot(moved)) > tolerance::on_surface)
        return false;
    const std::size_t i = node.node_index;
    const Vec3 to = was + corner_of(node, block).displacement();
    const Vec3 arm = anchor_of(pass.mesh.block[block.index], i) - to;
    return arm.norm() > tolerance::truss_length && arm.dot(node.stopped_by.normal) > 0.0 &&
           is_outside(pass, block.index, i, to);
}

}  // namespace

void find_stopping_face(const ContactPass& pass, const ContactBlock& block, const Vec3& along,
                        StoppedNode& node) {
    const std::size_t i = node.node_index;
    const Vec3 was(block.start->x[i], block.start->y[i], block.start->z[i]);
    for (const double behind : behind_stop) {
        node.stopped_by = face_entered(pass, block, node, node.place + behind * along, along, was);
        if (node.stopped_by.normal.isZero(0.0)) continue;
        node.stays = stays_on(pass, block, node, was);
        return;
    }
}

void stand_on_stopping_faces(const ContactPass& pass, ContactBlock& block) {
    for (const StoppedNode& node : block.stopped) {
        const std::size_t i = node.node_index;
        const bool resolved = std::any_of(block.corners.begin(), block.corners.end(),
                                          [i](const Corner& corner) { return corner.node_index == i; });
        if (resolved) continue;
        if (node.stays) {
            resolve_known_corner(pass, corner_of(node, block), block);
            continue;
        }
        const Vec3 arm = anchor_of(pass.mesh.block[block.index], i) - node.place;
        const bool presses_on_nearest =
            block.faces.per_force[i] > 0.0 || arm.dot(block.contact.normal(i)) > 0.0;
        if (presses_on_nearest || !(arm.dot(node.stopped_by.normal) > 0.0)) continue;
        const CornerFace face = corner_face(node.stopped_by, block);
        if (face.reachable_index == block.reachable.size()) continue;
        block.nearest[i] = face.reachable_index;
        block.faces.gap[i] = -tolerance::negligible_gap;
        block.set_normals(i, face.normal, face.normal);
    }
}

}  // namespace birm3d
