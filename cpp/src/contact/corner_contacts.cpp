// Nodes that several surfaces hold at once: see corner.hpp.
#include <algorithm>
#include <cmath>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

namespace {

// A node that pushes and stood as near as this to a surface an instant before was on it (m): curved surfaces are followed
// by chords.
constexpr double stood = 1e-4;

// Cosine above which the normals of two instants are of the same face.
constexpr double same_face = 0.9;

// Gap of a node that stands on its faces already, negative where they drive it in. Nil would tell nothing.
constexpr double nil = 1e-30;

BIRM3D_LANE_LOOP void move_out(const NodeFaces& faces, const BlockContact& contact, Lanes& x, Lanes& y,
                               Lanes& z) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double way = faces.gap[i] < -tolerance::touching_gap ? faces.gap[i] : 0.0;
        x[i] -= way * contact.nx[i];
        y[i] -= way * contact.ny[i];
        z[i] -= way * contact.nz[i];
    }
}

// Flags nodes that lie inside another surface once they have been moved out of theirs; returns the number of all flags.
BIRM3D_LANE_LOOP double note_inside(const NodeFaces& faces, const Lanes& gap, Lanes& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        cornered[i] =
            faces.gap[i] < -tolerance::touching_gap && gap[i] < -tolerance::touching_gap ? 1.0 : cornered[i];
    alignas(64) Lanes sum = cornered;
    return lane_sum(sum);
}

// Nodes that push and are near to a second surface.
BIRM3D_LANE_LOOP void note_pushing(const Lanes& force, const Lanes& second, double margin, Lanes& cornered) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        cornered[i] = force[i] > 0.0 && second[i] <= margin ? 1.0 : cornered[i];
}

}  // namespace

void Skin::settle_in_corners(std::size_t b) {
    const auto is_post = [&](std::size_t k) { return std::holds_alternative<Post>(near_shape(k)); };
    if (std::all_of(seen_.begin(), seen_.end(), is_post)) return;  // they stand apart
    alignas(64) Lanes cornered;
    cornered.fill(0.0);
    const TrussBlockState& block = from(b);
    if (block.touching) note_pushing(block.force, second_gap_, margin_, cornered);
    if (*std::min_element(faces_.gap.begin(), faces_.gap.end()) < -tolerance::touching_gap) {
        alignas(64) Lanes x = block.x, y = block.y, z = block.z;
        move_out(faces_, contact_, x, y, z);
        alignas(64) NearestLanes found;
        for (std::size_t k = 0; k < seen_.size(); ++k) {
            const NearObstacle& obstacle = near_[seen_[k]];
            nearest_of(near_shape(seen_[k]), obstacle.now, obstacle.now, x, y, z, found);
            leave_to_dents(b, seen_[k], found);
            note_inside(faces_, found.gap, cornered);
        }
    }
    for (std::size_t i = 0; i < lanes; ++i)
        if (cornered[i] > 0.0) settle(b, i);
}

// The face that the node has been found at so far.
CornerFace Skin::own_face(std::size_t i) const {
    CornerFace face;
    face.seen = nearest_[i];
    face.gap = faces_.gap[i];
    face.normal = face.gradient = face.way = contact_.normal(i);
    if (faces_.per_force[i] > 0.0) {
        face.dented = true;
        face.way = {faces_.bx[i], faces_.by[i], faces_.bz[i]};
        face.per_force = faces_.per_force[i];
        // The gap follows the node's own way in full, but the post's motion there only in part: the dent widens.
        face.gradient = face.per_force * face.normal;
        face.gradient += (1.0 - face.gradient.dot(face.way)) * face.way;
        face.place = {contact_.px[i], contact_.py[i], contact_.pz[i]};
        face.torque = contact_.torque(i);
    }
    return face;
}

// The face of the k-th of what is seen that is nearest to a place; its gap is that of the node.
CornerFace Skin::face_at(std::size_t k, const Vec3& place, const Vec3& node) const {
    const NearObstacle& obstacle = near_[seen_[k]];
    const Nearest there = nearest(near_shape(seen_[k]), obstacle.now.to_own(place));
    CornerFace face;
    face.seen = k;
    face.normal = face.gradient = face.way = obstacle.now.direction_from_own(there.normal);
    face.gap = there.gap + face.normal.dot(node - place);
    return face;
}

// Was a node on the k-th of what is seen an instant before, where it had this normal?
bool Skin::stood_on(std::size_t k, const Vec3& normal, const Vec3& node) const {
    const NearObstacle& obstacle = near_[seen_[k]];
    const Nearest then = nearest(near_shape(seen_[k]), obstacle.before.to_own(node));
    return std::abs(then.gap) <= stood &&
           obstacle.before.direction_from_own(then.normal).dot(normal) > same_face;
}

bool Skin::was_on(const CornerFace& face, const Vec3& node) const {
    return std::abs(face.gap) <= tolerance::touching_gap || stood_on(face.seen, face.normal, node);
}

// Adds the faces that a node which pushes has been on since an instant before. Where two segments of a wall meet, the
// face at hand takes over from that of the other, and the node leaves that.
void Skin::add_pushed(std::size_t b, const Vec3& node, const CornerFace& own, bool stays,
                      Corner& corner) const {
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        if (k == own.seen || !is_solid_to(b, corner.lane, seen_[k])) continue;
        if (!stays && stood_on(k, own.normal, node)) {
            if (corner.count == 0) corner.add(own);
            continue;
        }
        const CornerFace face = face_at(k, node, node);
        if (was_on(face, node)) corner.add(face);
    }
}

// Surfaces that the node would get into on its way onto those that it is on.
void Skin::add_driving(std::size_t b, const Vec3& node, Corner& corner) const {
    for (std::size_t round = 0; round < Corner::most && corner.count < Corner::most; ++round) {
        const Vec3 place = node + corner.way();
        bool any = false;
        for (std::size_t k = 0; k < seen_.size(); ++k) {
            if (!is_solid_to(b, corner.lane, seen_[k])) continue;
            const CornerFace face = face_at(k, place, node);
            const double gap = face.gap + face.normal.dot(place - node);
            any = (gap < -tolerance::touching_gap && corner.add(face)) || any;
        }
        if (!any) return;
    }
}

// Finds all faces that hold the node, and takes it onto them.
void Skin::settle(std::size_t b, std::size_t i) {
    const TrussBlock& truss = mesh_.block[b];
    const TrussBlockState& block = from(b);
    const Vec3 node(block.x[i], block.y[i], block.z[i]);
    const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
    if ((anchor - node).norm() <= tolerance::truss_length) return;
    Corner corner;
    corner.lane = i;
    const CornerFace own = own_face(i);
    const bool stays = own.dented || stood_on(own.seen, own.normal, node);
    if (stays || own.gap <= tolerance::touching_gap) corner.add(own);
    if (block.force[i] > 0.0) {
        add_pushed(b, node, own, stays, corner);
        corner.share_out((anchor - node).normalized());
        corner.release();
    }
    if (corner.count == 0) corner.add(own);
    add_driving(b, node, corner);
    const bool alone = corner.count == 1 && corner.face[0].seen == own.seen && corner.face[0].gap == own.gap;
    if (alone) return;
    const Vec3 to = node + corner.way();
    const Vec3 arm = anchor - to;
    if (!(arm.norm() > tolerance::truss_length) || corner.share_out(arm.normalized()) == 0) return;
    place(b, corner, to);
}

// Along faces that the truss does not push on the node moves freely; what its truss loses there is lost.
void Skin::place(std::size_t b, const Corner& corner, const Vec3& to) {
    const TrussBlock& truss = mesh_.block[b];
    TrussBlockState& block = altered(b);
    const std::size_t i = corner.lane;
    const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
    const double deflection = truss.length[i] - (anchor - to).norm();
    const double free = truss.length[i] - (anchor - (to - corner.pushed_way())).norm();
    if (block.force[i] > 0.0 && free < block.deflection[i]) {
        block.force[i] = std::max(0.0, block.force[i] + block.unloading[i] * (free - block.deflection[i]));
        block.deflection[i] = free;
    }
    block.x[i] = to.x(), block.y[i] = to.y(), block.z[i] = to.z();
    faces_.gap[i] = block.force[i] > 0.0 && deflection < block.deflection[i] ? nil : -nil;
    const Vec3 b_ = (anchor - to).normalized();
    contact_.nx[i] = faces_.bx[i] = b_.x();
    contact_.ny[i] = faces_.by[i] = b_.y();
    contact_.nz[i] = faces_.bz[i] = b_.z();
    faces_.per_force[i] = 0.0;
    const auto most =
        std::max_element(corner.face.begin(), corner.face.begin() + static_cast<std::ptrdiff_t>(corner.count),
                         [](const CornerFace& a, const CornerFace& c) { return a.share < c.share; });
    nearest_[i] = most->seen;
    corners_.push_back(corner);
}

// To each surface its part of what nodes in corners push.
void Skin::share_out_corners(std::size_t b, const TrussBlockState& next) {
    std::vector<double> force;
    for (const Corner& corner : corners_) {
        force.push_back(contact_.pressure[corner.lane]);
        contact_.pressure[corner.lane] = 0.0;
    }
    BlockContact part = contact_;
    for (std::size_t of = 0; of < Corner::most; ++of)
        for (std::size_t k = 0; k < seen_.size(); ++k) {
            part.pressure.fill(0.0);
            double sum = 0.0;
            for (std::size_t c = 0; c < corners_.size(); ++c) {
                const CornerFace& face = corners_[c].face[of];
                const std::size_t i = corners_[c].lane;
                if (of >= corners_[c].count || face.seen != k || !(face.share * force[c] > 0.0)) continue;
                const Vec3 node(next.x[i], next.y[i], next.z[i]);
                const Vec3 at = face.dented ? face.place : node;
                const Vec3 torque = face.dented ? face.torque : Vec3(node.cross(face.normal));
                const double pressure = force[c] * face.share * face.per_force;
                part.pressure[i] = pressure;
                part.nx[i] = face.normal.x(), part.ny[i] = face.normal.y(), part.nz[i] = face.normal.z();
                part.px[i] = at.x(), part.py[i] = at.y(), part.pz[i] = at.z();
                obstacles_[seen_[k]].contact += {pressure * face.normal, pressure * torque};
                sum += pressure;
            }
            if (!(sum > 0.0)) continue;
            obstacles_[seen_[k]].normal_force += sum;
            rub(seen_[k], b, next, part.places(), part);
        }
}

}  // namespace birm3d
