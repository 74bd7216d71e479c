#include "contact/nearest_surface.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/corner_contacts.hpp"
#include "contact/entered_face.hpp"
#include "contact/indentation.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Cosine above which the normals of two instants are of the same face.
constexpr double same_face = 0.9;

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

// Nodes to which this obstacle, the k-th, is nearer than those before.
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

// The second nearest of several: before the k-th is taken. Of nodes outside without force the gap need not be known.
BIRM3D_BLOCK_LOOP void take_second(const NearestOfBlock& found, const NodeFaces& faces, BlockColumn& second) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double farther = found.gap[i] < faces.gap[i] ? faces.gap[i] : found.gap[i];
        second[i] = farther < second[i] ? farther : second[i];
    }
}

// Does any of the nodes push on what it sees, or is it inside?
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
        const double way = before > 0.0 ? before : -before;
        off[i] = block.force[i] > 0.0 && nearest[i] == k ? way : 0.0;
    }
    return block_max(off);
}

// The same of the instant before.
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

// Nodes inside that arrive, or seem to have changed over to another face (1, else 0). Returns how many.
BIRM3D_BLOCK_LOOP double find_doubtful(const NodeFaces& faces, const BlockContact& contact,
                                       const BlockColumn& force, BlockColumn& doubtful) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double turn =
            contact.nx[i] * faces.bx[i] + contact.ny[i] * faces.by[i] + contact.nz[i] * faces.bz[i];
        const bool same = force[i] > 0.0 && turn > same_face;
        doubtful[i] = faces.gap[i] < 0.0 && !same ? 1.0 : 0.0;
    }
    alignas(64) BlockColumn sum = doubtful;
    return block_sum(sum);
}

// Normals that nodes of one obstacle had before, by its turn since.
BIRM3D_BLOCK_LOOP void turn_back(const double* turn, std::size_t seen,
                                 const std::array<std::size_t, block_size>& nearest,
                                 const BlockContact& contact, NodeFaces& faces) {
    const double xx = turn[0], yx = turn[1], zx = turn[2], xy = turn[3], yy = turn[4], zy = turn[5],
                 xz = turn[6], yz = turn[7], zz = turn[8];
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double x = contact.nx[i], y = contact.ny[i], z = contact.nz[i];
        const bool of_this = nearest[i] == seen;
        faces.bx[i] = of_this ? xx * x + xy * y + xz * z : faces.bx[i];
        faces.by[i] = of_this ? yx * x + yy * y + yz * z : faces.by[i];
        faces.bz[i] = of_this ? zx * x + zy * y + zz * z : faces.bz[i];
    }
}

// Have all nodes that push on what they see done so on the plane that they see now?
bool stay_on_planes(const ContactPass& pass, const ContactBlock& block) {
    for (std::size_t k = 0; k < block.seen.size(); ++k) {
        if (std::holds_alternative<Post>(pass.shape(block.seen[k]))) return false;
        const NearObstacle& near = pass.near[block.seen[k]];
        const Mat3 to_body = near.now.rotation.transpose();
        const Mat3 turn = to_body * near.before.rotation - Mat3::Identity();
        const Vec3 shift = to_body * (near.before.position - near.now.position);
        const double off = furthest_off_plane(turn.data(), shift.data(), k, *block.start, block.faces,
                                              block.contact, block.nearest);
        if (!(off <= tolerance::touching_gap)) return false;
    }
    return true;
}

// The nearest of all surfaces now, but those whose indentations the nodes follow.
void find_surfaces_now(const ContactPass& pass, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    alignas(64) NearestOfBlock found;
    block.second_gap.fill(infinity);
    for (std::size_t k = 0; k < block.seen.size(); ++k) {
        const std::size_t at = block.seen[k];
        if (only_indented(pass, pass.mesh.panels_of[block.index], at)) continue;
        nearest_of(pass.shape(at), pass.near[at].now, pass.near[at].before, nodes.x, nodes.y, nodes.z, found,
                   &nodes.force);
        omit_indented(pass, block.index, at, found);
        if (k > 0) take_second(found, block.faces, block.second_gap);
        take_nearer(found, k, block.faces, block.contact, block.nearest);
    }
}

// The same of the start of the step: segments of a wall take over from each other.
void find_surfaces_before(const ContactPass& pass, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    alignas(64) NearestOfBlock found;
    alignas(64) BlockColumn gap_before;
    gap_before.fill(infinity);
    for (const std::size_t at : block.seen) {
        if (only_indented(pass, pass.mesh.panels_of[block.index], at)) continue;
        const Placement& before = pass.near[at].before;
        nearest_of(pass.shape(at), before, before, nodes.x, nodes.y, nodes.z, found, &nodes.force);
        omit_indented(pass, block.index, at, found);
        take_nearer_before(found, gap_before, block.faces);
    }
}

// A flat face, or an edge, had the same normal in its own axes at the start of the step, whatever was nearest then.
void turn_flat_faces(const ContactPass& pass, ContactBlock& block) {
    for (std::size_t k = 0; k < block.seen.size(); ++k) {
        if (std::holds_alternative<Post>(pass.shape(block.seen[k]))) continue;
        const NearObstacle& near = pass.near[block.seen[k]];
        const Mat3 turn = near.before.rotation.transpose() * near.now.rotation;
        turn_back(turn.data(), k, block.nearest, block.contact, block.faces);
    }
}

// The nearest face can be the wrong one to nodes beside an edge: to those that arrive, and to those that seem to have
// changed to another face. Returns whether it was wrong to any. Meshes tell by themselves.
bool find_entered_faces(const ContactPass& pass, ContactBlock& block) {
    bool changed = false;
    alignas(64) BlockColumn doubtful;
    if (find_doubtful(block.faces, block.contact, block.start->force, doubtful) == 0.0) return false;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(doubtful[i] > 0.0)) continue;
        const Shape& shape = pass.shape(block.seen[block.nearest[i]]);
        if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<TriangleMesh>(shape)) continue;
        const Vec3 node(block.start->x[i], block.start->y[i], block.start->z[i]);
        const auto entered =
            entered_face(pass.scene, pass.near, block.seen, node, block.nearest[i], block.contact.normal(i));
        if (!entered) continue;
        changed = true;
        block.nearest[i] = entered->seen;
        block.faces.gap[i] = entered->now.gap;
        block.set_normals(i, entered->now.normal, entered->normal_before);
    }
    return changed;
}

// Returns whether any node has gone in through another face than the nearest.
bool find_surfaces(const ContactPass& pass, ContactBlock& block) {
    find_surfaces_now(pass, block);
    block.faces.bx = block.contact.nx, block.faces.by = block.contact.ny, block.faces.bz = block.contact.nz;
    // Nodes that push on indentations only need no other direction; nodes that stay on a plane keep its own.
    const bool pushes = block.start->touching && any_meets(block.start->force, block.faces.gap);
    if (pushes && !stay_on_planes(pass, block)) find_surfaces_before(pass, block);
    const bool changed = find_entered_faces(pass, block);
    if (block.start->touching) turn_flat_faces(pass, block);
    return changed;
}

}  // namespace

void find_nearest_surface(const ContactPass& pass, ContactBlock& block) {
    set_nothing_met(block.faces, block.contact, block.nearest);
    block.flat_normal.reset();
    block.corners.clear();
    const std::uint8_t of = pass.mesh.panels_of[block.index];
    const bool all_indented = std::all_of(block.seen.begin(), block.seen.end(),
                                          [&](std::size_t k) { return only_indented(pass, of, k); });
    const bool changed = !all_indented && find_surfaces(pass, block);
    follow_indentations(pass, block);
    // Of one obstacle the nearest place lies in no corner.
    if (changed || block.seen.size() > 1) resolve_corner_contacts(pass, block);
}

}  // namespace birm3d
