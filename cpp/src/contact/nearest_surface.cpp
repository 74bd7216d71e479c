#include "contact/nearest_surface.hpp"

#include <algorithm>
#include <array>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/corner_contacts.hpp"
#include "contact/entered_face.hpp"
#include "contact/indentation.hpp"
#include "contact/lagging_nodes.hpp"
#include "kernels/indentation_simd.hpp"

namespace birm3d {

namespace {

BIRM3D_BLOCK_LOOP void set_nothing_met(NodeFaces& faces, BlockContact& contact,
                                       std::array<std::size_t, block_size>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        faces.gap[i] = infinity;
        faces.per_force[i] = 0.0;
        contact.nx[i] = faces.bx[i] = 1.0;
        contact.ny[i] = contact.nz[i] = faces.by[i] = faces.bz[i] = 0.0;
        nearest[i] = 0;
    }
}

// An indentation that held pushing nodes may have moved on so far that nothing is left near them. They are released, for which
// find_leaving() wants a finite gap.
BIRM3D_BLOCK_LOOP void bound_gaps(const BlockColumn& force, BlockColumn& gap) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        gap[i] = force[i] > 0.0 && gap[i] > away ? away : gap[i];
}

// Takes the k-th obstacle for all nodes to which it is nearer than those before.
BIRM3D_BLOCK_LOOP void take_nearer(const NearestOfBlock& found, std::size_t k, NodeFaces& faces,
                                   BlockContact& contact, std::array<std::size_t, block_size>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const bool nearer = found.gap[i] < faces.gap[i];
        nearest[i] = nearer ? k : nearest[i];
        faces.gap[i] = nearer ? found.gap[i] : faces.gap[i];
        contact.nx[i] = nearer ? found.nx[i] : contact.nx[i];
        contact.ny[i] = nearer ? found.ny[i] : contact.ny[i];
        contact.nz[i] = nearer ? found.nz[i] : contact.nz[i];
    }
}

// Updates the gap to the second nearest obstacle, before the k-th is taken. Free nodes outside need no gap.
BIRM3D_BLOCK_LOOP void take_second(const NearestOfBlock& found, const NodeFaces& faces, BlockColumn& second) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double farther = found.gap[i] < faces.gap[i] ? faces.gap[i] : found.gap[i];
        second[i] = farther < second[i] ? farther : second[i];
    }
}

// Does any node push, or is any node inside?
BIRM3D_BLOCK_LOOP bool any_meets(const BlockColumn& force, const BlockColumn& gap) {
    alignas(64) BlockColumn meets;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        meets[i] = gap[i] < (force[i] > 0.0 ? infinity : 0.0) ? 1.0 : 0.0;
    return block_max(meets) > 0.0;
}

// Greatest distance (m), at the start of the step, of any loaded node of the k-th obstacle from its present contact plane.
// It stood at p + D p + s then, D by columns.
BIRM3D_BLOCK_LOOP double furthest_off_plane(const double* D, const double* s, std::size_t k,
                                            const TrussBlockState& block, const NodeFaces& faces,
                                            const BlockContact& contact,
                                            const std::array<std::size_t, block_size>& nearest) {
    const double xx = D[0], yx = D[1], zx = D[2], xy = D[3], yy = D[4], zy = D[5], xz = D[6], yz = D[7],
                 zz = D[8], sx = s[0], sy = s[1], sz = s[2];
    alignas(64) BlockColumn off;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = block.x[i], y = block.y[i], z = block.z[i];
        const double before = faces.gap[i] + contact.nx[i] * (xx * x + xy * y + xz * z + sx) +
                              contact.ny[i] * (yx * x + yy * y + yz * z + sy) +
                              contact.nz[i] * (zx * x + zy * y + zz * z + sz);
        const double distance = before > 0.0 ? before : -before;
        off[i] = block.force[i] > 0.0 && nearest[i] == k ? distance : 0.0;
    }
    return block_max(off);
}

// The same at the start of the step.
BIRM3D_BLOCK_LOOP void take_nearer_before(const NearestOfBlock& found, BlockColumn& gap, NodeFaces& faces) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const bool nearer = found.gap[i] < gap[i];
        gap[i] = nearer ? found.gap[i] : gap[i];
        faces.bx[i] = nearer ? found.nx[i] : faces.bx[i];
        faces.by[i] = nearer ? found.ny[i] : faces.by[i];
        faces.bz[i] = nearer ? found.nz[i] : faces.bz[i];
    }
}

// Marks nodes inside that arrive, or seem to have changed to another face (1, else 0). Returns how many.
BIRM3D_BLOCK_LOOP double find_doubtful(const NodeFaces& faces, const BlockContact& contact,
                                       const BlockColumn& force, BlockColumn& doubtful) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double rotation =
            contact.nx[i] * faces.bx[i] + contact.ny[i] * faces.by[i] + contact.nz[i] * faces.bz[i];
        const bool same = force[i] > 0.0 && rotation > tolerance::same_face;
        doubtful[i] = faces.gap[i] < 0.0 && !same ? 1.0 : 0.0;
    }
    alignas(64) BlockColumn sum = doubtful;
    return block_sum(sum);
}

// Normals at the start of the step of nodes on the k-th obstacle, from its rotation since.
BIRM3D_BLOCK_LOOP void rotate_back(const double* rotation, std::size_t k,
                                   const std::array<std::size_t, block_size>& nearest,
                                   const BlockContact& contact, NodeFaces& faces) {
    const double xx = rotation[0], yx = rotation[1], zx = rotation[2], xy = rotation[3], yy = rotation[4],
                 zy = rotation[5], xz = rotation[6], yz = rotation[7], zz = rotation[8];
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = contact.nx[i], y = contact.ny[i], z = contact.nz[i];
        const bool of_this = nearest[i] == k;
        faces.bx[i] = of_this ? xx * x + xy * y + xz * z : faces.bx[i];
        faces.by[i] = of_this ? yx * x + yy * y + yz * z : faces.by[i];
        faces.bz[i] = of_this ? zx * x + zy * y + zz * z : faces.bz[i];
    }
}

// Have all pushing nodes been on their present contact planes since the start of the step?
bool stay_on_planes(const ContactPass& pass, const ContactBlock& block) {
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        if (std::holds_alternative<Post>(pass.shape(block.reachable[k]))) return false;
        const NearObstacle& near = pass.near[block.reachable[k]];
        const Mat3 to_body = near.now.rotation.transpose();
        const Mat3 rotation = to_body * near.before.rotation - Mat3::Identity();
        const Vec3 shift = to_body * (near.before.position - near.now.position);
        const double off = furthest_off_plane(rotation.data(), shift.data(), k, *block.start, block.faces,
                                              block.contact, block.nearest);
        if (!(off <= tolerance::touching_gap)) return false;
    }
    return true;
}

// Finds the nearest of all surfaces now. Posts whose indentations the nodes follow are left out.
void find_surfaces_now(const ContactPass& pass, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    alignas(64) NearestOfBlock found;
    block.second_gap.fill(infinity);
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        const std::size_t at = block.reachable[k];
        if (only_indented(pass, pass.mesh.panels_of[block.index], at)) continue;
        nearest_of(pass.shape(at), pass.near[at].now, pass.near[at].before, nodes.x, nodes.y, nodes.z, found,
                   &nodes.force);
        omit_indented(pass, block.index, at, found);
        if (k > 0) take_second(found, block.faces, block.second_gap);
        take_nearer(found, k, block.faces, block.contact, block.nearest);
    }
}

// The same at the start of the step, over all obstacles: a node may pass from one segment of a wall to the next.
void find_surfaces_before(const ContactPass& pass, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    alignas(64) NearestOfBlock found;
    alignas(64) BlockColumn gap_before;
    gap_before.fill(infinity);
    for (const std::size_t at : block.reachable) {
        if (only_indented(pass, pass.mesh.panels_of[block.index], at)) continue;
        const Placement& before = pass.near[at].before;
        nearest_of(pass.shape(at), before, before, nodes.x, nodes.y, nodes.z, found, &nodes.force);
        omit_indented(pass, block.index, at, found);
        take_nearer_before(found, gap_before, block.faces);
    }
}

// The normal of a flat face or an edge is constant in the obstacle's axes. So only the obstacle's rotation changed
// it.
void rotate_flat_faces(const ContactPass& pass, ContactBlock& block) {
    for (std::size_t k = 0; k < block.reachable.size(); ++k) {
        if (std::holds_alternative<Post>(pass.shape(block.reachable[k]))) continue;
        const NearObstacle& near = pass.near[block.reachable[k]];
        const Mat3 rotation = near.before.rotation.transpose() * near.now.rotation;
        rotate_back(rotation.data(), k, block.nearest, block.contact, block.faces);
    }
}

// Near an edge the nearest face can be the wrong one, for nodes that arrive or seem to have changed to another face.
// Returns whether any was wrong. Triangle meshes find the entered face by themselves.
bool find_entered_faces(const ContactPass& pass, ContactBlock& block) {
    bool changed = false;
    alignas(64) BlockColumn doubtful;
    if (find_doubtful(block.faces, block.contact, block.start->force, doubtful) == 0.0) return false;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(doubtful[i] > 0.0)) continue;
        const Shape& shape = pass.shape(block.reachable[block.nearest[i]]);
        if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<TriangleMesh>(shape)) continue;
        const Vec3 node(block.start->x[i], block.start->y[i], block.start->z[i]);
        const auto entered = entered_face(pass.scene, pass.near, block.reachable, node, block.nearest[i],
                                          block.contact.normal(i), block.start->force[i] > 0.0);
        if (!entered) continue;
        changed = true;
        block.nearest[i] = entered->reachable_index;
        block.faces.gap[i] = entered->now.gap;
        block.set_normals(i, entered->now.normal, entered->normal_before);
    }
    return changed;
}

// Returns whether any node has gone in through another face than the nearest.
bool find_surfaces(const ContactPass& pass, ContactBlock& block) {
    find_surfaces_now(pass, block);
    block.faces.bx = block.contact.nx, block.faces.by = block.contact.ny, block.faces.bz = block.contact.nz;
    // Nodes on indentations have their directions already; nodes that stay on a plane keep its normal.
    const bool pushes = block.start->touching && any_meets(block.start->force, block.faces.gap);
    if (pushes && !stay_on_planes(pass, block)) find_surfaces_before(pass, block);
    const bool changed = find_entered_faces(pass, block);
    if (block.start->touching) rotate_flat_faces(pass, block);
    return changed;
}

}  // namespace

void find_nearest_surface(const ContactPass& pass, ContactBlock& block) {
    set_nothing_met(block.faces, block.contact, block.nearest);
    block.flat_normal.reset();
    block.corners.clear();
    const std::uint8_t panel_bits = pass.mesh.panels_of[block.index];
    const bool all_indented = std::all_of(block.reachable.begin(), block.reachable.end(),
                                          [&](std::size_t k) { return only_indented(pass, panel_bits, k); });
    const bool changed = !all_indented && find_surfaces(pass, block);
    follow_indentations(pass, block);
    keep_lags(pass, block);
    if (block.start->touching) bound_gaps(block.start->force, block.faces.gap);
    // The nearest point of a single obstacle is in no corner.
    if (changed || block.reachable.size() > 1) resolve_corner_contacts(pass, block);
}

}  // namespace birm3d
