#include "contact/corner_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/contact_loads.hpp"
#include "contact/indentation.hpp"
#include "contact/released_nodes.hpp"

namespace birm3d {

namespace {

// A node that pushes and was as near as this to a surface at the start of the step was on it (m). Curved surfaces are
// followed by chords, which leave such a gap.
constexpr double on_surface = 1e-4;

// Cosine above which the normals of two instants are of the same face.
constexpr double same_face = 0.9;

// Gap of a node that already stands on its faces: positive where it leaves, negative where they drive it in. Zero would
// not say which.
constexpr double negligible_gap = 1e-30;

BIRM3D_BLOCK_LOOP void move_out(const NodeFaces& faces, const BlockContact& contact, BlockColumn& x,
                                BlockColumn& y, BlockColumn& z) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double way = faces.gap[i] < -tolerance::touching_gap ? faces.gap[i] : 0.0;
        x[i] -= way * contact.nx[i];
        y[i] -= way * contact.ny[i];
        z[i] -= way * contact.nz[i];
    }
}

// Flags nodes that lie inside another surface once they have been moved out of theirs; returns the number of all flags.
BIRM3D_BLOCK_LOOP double note_inside(const NodeFaces& faces, const BlockColumn& gap, BlockColumn& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        cornered[i] =
            faces.gap[i] < -tolerance::touching_gap && gap[i] < -tolerance::touching_gap ? 1.0 : cornered[i];
    alignas(64) BlockColumn sum = cornered;
    return block_sum(sum);
}

// Nodes that push and are near to a second surface.
BIRM3D_BLOCK_LOOP void note_pushing(const BlockColumn& force, const BlockColumn& second, double margin,
                                    BlockColumn& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i)
        cornered[i] = force[i] > 0.0 && second[i] <= margin ? 1.0 : cornered[i];
}

Vec3 anchor_of(const TrussBlock& truss, std::size_t i) {
    return {truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]};
}

// The face that the node has been found at so far.
CornerFace own_face(const ContactBlock& block, std::size_t i) {
    const NodeFaces& faces = block.faces;
    CornerFace face;
    face.seen = block.nearest[i];
    face.gap = faces.gap[i];
    face.normal = face.gradient = face.way = block.contact.normal(i);
    if (faces.per_force[i] > 0.0) {
        face.indented = true;
        face.way = {faces.bx[i], faces.by[i], faces.bz[i]};
        face.per_force = faces.per_force[i];
        // The gap follows the node's own path in full, but the post's motion only in part: the indentation widens.
        face.gradient = face.per_force * face.normal;
        face.gradient += (1.0 - face.gradient.dot(face.way)) * face.way;
        face.place = {block.contact.px[i], block.contact.py[i], block.contact.pz[i]};
        face.torque = block.contact.torque(i);
    }
    return face;
}

// The face of the k-th seen obstacle that is nearest to a place; its gap is that of the node.
CornerFace face_at(const ContactPass& pass, const ContactBlock& block, std::size_t k, const Vec3& place,
                   const Vec3& node) {
    const NearObstacle& near = pass.near[block.seen[k]];
    const Nearest there = nearest(pass.shape(block.seen[k]), near.now.to_own(place));
    CornerFace face;
    face.seen = k;
    face.normal = face.gradient = face.way = near.now.direction_from_own(there.normal);
    face.gap = there.gap + face.normal.dot(node - place);
    return face;
}

// Was the node on the k-th seen obstacle at the start of the step, where that had this normal?
bool stood_on(const ContactPass& pass, const ContactBlock& block, std::size_t k, const Vec3& normal,
              const Vec3& node) {
    const NearObstacle& near = pass.near[block.seen[k]];
    const Nearest then = nearest(pass.shape(block.seen[k]), near.before.to_own(node));
    return std::abs(then.gap) <= on_surface &&
           near.before.direction_from_own(then.normal).dot(normal) > same_face;
}

// Adds the faces that a pushing node has been on since the start of the step. Where two segments of a wall meet, the
// node's own face takes over from that of the other segment, and the node leaves the latter. `stays`: on its own face.
void add_held(const ContactPass& pass, const ContactBlock& block, const Vec3& node, const CornerFace& own,
              bool stays, Corner& corner) {
    for (std::size_t k = 0; k < block.seen.size(); ++k) {
        if (k == own.seen || !is_solid_to(pass, block.index, corner.lane, block.seen[k])) continue;
        if (!stays && stood_on(pass, block, k, own.normal, node)) {
            if (corner.count == 0) corner.add(own);
            continue;
        }
        const CornerFace face = face_at(pass, block, k, node, node);
        const bool was_on =
            std::abs(face.gap) <= tolerance::touching_gap || stood_on(pass, block, k, face.normal, node);
        if (was_on) corner.add(face);
    }
}

// Adds the surfaces that the node would get into on its way onto those that it is on.
void add_driving(const ContactPass& pass, const ContactBlock& block, const Vec3& node, Corner& corner) {
    for (std::size_t round = 0; round < Corner::most && corner.count < Corner::most; ++round) {
        const Vec3 place = node + corner.way();
        bool any = false;
        for (std::size_t k = 0; k < block.seen.size(); ++k) {
            if (!is_solid_to(pass, block.index, corner.lane, block.seen[k])) continue;
            const CornerFace face = face_at(pass, block, k, place, node);
            const double gap = face.gap + face.normal.dot(place - node);
            any = (gap < -tolerance::touching_gap && corner.add(face)) || any;
        }
        if (!any) return;
    }
}

// Places the node of a corner. Along faces that its truss does not push on it moves freely: what its truss loses there
// is lost.
void place_in_corner(const ContactPass& pass, const Corner& corner, const Vec3& to, ContactBlock& block) {
    const TrussBlock& truss = pass.mesh.block[block.index];
    TrussBlockState& nodes = block.alter();
    const std::size_t i = corner.lane;
    const Vec3 anchor = anchor_of(truss, i);
    const double deflection = truss.length[i] - (anchor - to).norm();
    const double free = truss.length[i] - (anchor - (to - corner.pushed_way())).norm();
    if (nodes.force[i] > 0.0 && free < nodes.deflection[i]) {
        nodes.force[i] = std::max(0.0, nodes.force[i] + nodes.unloading[i] * (free - nodes.deflection[i]));
        nodes.deflection[i] = free;
    }
    nodes.x[i] = to.x(), nodes.y[i] = to.y(), nodes.z[i] = to.z();
    block.faces.gap[i] =
        nodes.force[i] > 0.0 && deflection < nodes.deflection[i] ? negligible_gap : -negligible_gap;
    const Vec3 along_truss = (anchor - to).normalized();
    block.set_normals(i, along_truss, along_truss);
    block.faces.per_force[i] = 0.0;
    const auto most =
        std::max_element(corner.face.begin(), corner.face.begin() + static_cast<std::ptrdiff_t>(corner.count),
                         [](const CornerFace& a, const CornerFace& c) { return a.share < c.share; });
    block.nearest[i] = most->seen;
    block.corners.push_back(corner);
}

// Finds all faces that hold the node, and places it on them.
void resolve_corner(const ContactPass& pass, std::size_t i, ContactBlock& block) {
    const TrussBlockState& nodes = *block.start;
    const Vec3 node(nodes.x[i], nodes.y[i], nodes.z[i]);
    const Vec3 anchor = anchor_of(pass.mesh.block[block.index], i);
    if ((anchor - node).norm() <= tolerance::truss_length) return;
    Corner corner;
    corner.lane = i;
    const CornerFace own = own_face(block, i);
    const bool stays = own.indented || stood_on(pass, block, own.seen, own.normal, node);
    if (stays || own.gap <= tolerance::touching_gap) corner.add(own);
    if (nodes.force[i] > 0.0) {
        add_held(pass, block, node, own, stays, corner);
        corner.share_out((anchor - node).normalized());
        corner.release();
    }
    if (corner.count == 0) corner.add(own);
    add_driving(pass, block, node, corner);
    const bool alone = corner.count == 1 && corner.face[0].seen == own.seen && corner.face[0].gap == own.gap;
    if (alone) return;
    const Vec3 to = node + corner.way();
    const Vec3 arm = anchor - to;
    if (!(arm.norm() > tolerance::truss_length) || corner.share_out(arm.normalized()) == 0) return;
    place_in_corner(pass, corner, to, block);
}

// Adds the forces of the `of`-th faces of all corners on the k-th seen obstacle. `part`: memory.
void add_corner_forces(const ContactPass& pass, const std::vector<double>& force, std::size_t of,
                       std::size_t k, const ContactBlock& block, BlockContact& part, ContactSums& sums) {
    ObstacleSums& to = sums.obstacles[block.seen[k]];
    part.pressure.fill(0.0);
    double sum = 0.0;
    for (std::size_t c = 0; c < block.corners.size(); ++c) {
        const CornerFace& face = block.corners[c].face[of];
        const std::size_t i = block.corners[c].lane;
        if (of >= block.corners[c].count || face.seen != k || !(face.share * force[c] > 0.0)) continue;
        const Vec3 node(block.end->x[i], block.end->y[i], block.end->z[i]);
        const Vec3 at = face.indented ? face.place : node;
        const Vec3 torque = face.indented ? face.torque : Vec3(node.cross(face.normal));
        const double pressure = force[c] * face.share * face.per_force;
        part.pressure[i] = pressure;
        part.nx[i] = face.normal.x(), part.ny[i] = face.normal.y(), part.nz[i] = face.normal.z();
        part.px[i] = at.x(), part.py[i] = at.y(), part.pz[i] = at.z();
        to.contact += {pressure * face.normal, pressure * torque};
        sum += pressure;
    }
    if (!(sum > 0.0)) return;
    to.normal_force += sum;
    apply_friction(pass, block.seen[k], part.places(), part, block, sums);
}

}  // namespace

void resolve_corner_contacts(const ContactPass& pass, ContactBlock& block) {
    const auto is_post = [&](std::size_t k) { return std::holds_alternative<Post>(pass.shape(k)); };
    // Posts stand apart: no node is held by two.
    if (std::all_of(block.seen.begin(), block.seen.end(), is_post)) return;
    alignas(64) BlockColumn cornered;
    cornered.fill(0.0);
    const TrussBlockState& nodes = *block.start;
    if (nodes.touching) note_pushing(nodes.force, block.second_gap, pass.margin, cornered);
    if (*std::min_element(block.faces.gap.begin(), block.faces.gap.end()) < -tolerance::touching_gap) {
        alignas(64) BlockColumn x = nodes.x, y = nodes.y, z = nodes.z;
        move_out(block.faces, block.contact, x, y, z);
        alignas(64) NearestOfBlock found;
        for (const std::size_t k : block.seen) {
            nearest_of(pass.shape(k), pass.near[k].now, pass.near[k].now, x, y, z, found);
            omit_indented(pass, block.index, k, found);
            note_inside(block.faces, found.gap, cornered);
        }
    }
    for (std::size_t i = 0; i < block_size; ++i)
        if (cornered[i] > 0.0) resolve_corner(pass, i, block);
}

void share_corner_forces(const ContactPass& pass, ContactBlock& block, ContactSums& sums) {
    std::vector<double> force;
    for (const Corner& corner : block.corners) {
        force.push_back(block.contact.pressure[corner.lane]);
        block.contact.pressure[corner.lane] = 0.0;
    }
    BlockContact part = block.contact;
    for (std::size_t of = 0; of < Corner::most; ++of)
        for (std::size_t k = 0; k < block.seen.size(); ++k)
            add_corner_forces(pass, force, of, k, block, part, sums);
}

}  // namespace birm3d
