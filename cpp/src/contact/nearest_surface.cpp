// What the nodes of a block see of the obstacles about them: gaps and normals now, and normals an instant before.
#include <algorithm>
#include <array>
#include <limits>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/contact/entered_face.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Cosine above which the normals of two instants are of the same face.
constexpr double same_face = 0.9;

BIRM3D_LANE_LOOP void see_nothing(NodeFaces& faces, BlockContact& contact,
                                  std::array<std::size_t, lanes>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        faces.gap[i] = infinity;
        faces.per_force[i] = 0.0;
        contact.nx[i] = faces.bx[i] = 1.0;
        contact.ny[i] = contact.nz[i] = faces.by[i] = faces.bz[i] = 0.0;
        nearest[i] = 0;
    }
}

// Nodes to which this obstacle, the k-th, is nearer than those before.
BIRM3D_LANE_LOOP void take_nearer(const NearestLanes& found, std::size_t k, NodeFaces& faces,
                                  BlockContact& contact, std::array<std::size_t, lanes>& nearest) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool nearer = found.gap[i] < faces.gap[i];
        nearest[i] = nearer ? k : nearest[i];
        faces.gap[i] = nearer ? found.gap[i] : faces.gap[i];
        contact.nx[i] = nearer ? found.nx[i] : contact.nx[i];
        contact.ny[i] = nearer ? found.ny[i] : contact.ny[i];
        contact.nz[i] = nearer ? found.nz[i] : contact.nz[i];
    }
}

// The second nearest of several: before the k-th is taken. Of nodes outside without force the gap need not be known.
BIRM3D_LANE_LOOP void take_second(const NearestLanes& found, const NodeFaces& faces, Lanes& second) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double farther = found.gap[i] < faces.gap[i] ? faces.gap[i] : found.gap[i];
        second[i] = farther < second[i] ? farther : second[i];
    }
}

// Does any of the nodes push on what it sees, or is it inside?
BIRM3D_LANE_LOOP bool any_meets(const Lanes& force, const Lanes& gap) {
    alignas(64) Lanes meets;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i)
        meets[i] = gap[i] < (force[i] > 0.0 ? infinity : 0.0) ? 1.0 : 0.0;
    return lane_max(meets) > 0.0;
}

// Of nodes that push and see the k-th obstacle: how far was any off the plane that it sees now, an instant before (m)? It
// was at p + D p + s then, D by columns.
BIRM3D_LANE_LOOP double furthest_off_plane(const double* D, const double* s, std::size_t k,
                                           const TrussBlockState& block, const NodeFaces& faces,
                                           const BlockContact& contact,
                                           const std::array<std::size_t, lanes>& nearest) {
    const double xx = D[0], yx = D[1], zx = D[2], xy = D[3], yy = D[4], zy = D[5], xz = D[6], yz = D[7],
                 zz = D[8], sx = s[0], sy = s[1], sz = s[2];
    alignas(64) Lanes off;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = block.x[i], y = block.y[i], z = block.z[i];
        const double before = faces.gap[i] + contact.nx[i] * (xx * x + xy * y + xz * z + sx) +
                              contact.ny[i] * (yx * x + yy * y + yz * z + sy) +
                              contact.nz[i] * (zx * x + zy * y + zz * z + sz);
        const double way = before > 0.0 ? before : -before;
        off[i] = block.force[i] > 0.0 && nearest[i] == k ? way : 0.0;
    }
    return lane_max(off);
}

// The same of the instant before.
BIRM3D_LANE_LOOP void take_nearer_before(const NearestLanes& found, Lanes& gap, NodeFaces& faces) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool nearer = found.gap[i] < gap[i];
        gap[i] = nearer ? found.gap[i] : gap[i];
        faces.bx[i] = nearer ? found.nx[i] : faces.bx[i];
        faces.by[i] = nearer ? found.ny[i] : faces.by[i];
        faces.bz[i] = nearer ? found.nz[i] : faces.bz[i];
    }
}

// Nodes inside that arrive, or seem to have changed over to another face (1, else 0). Returns how many.
BIRM3D_LANE_LOOP double find_doubtful(const NodeFaces& faces, const BlockContact& contact, const Lanes& force,
                                      Lanes& doubtful) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double turn =
            contact.nx[i] * faces.bx[i] + contact.ny[i] * faces.by[i] + contact.nz[i] * faces.bz[i];
        const bool same = force[i] > 0.0 && turn > same_face;
        doubtful[i] = faces.gap[i] < 0.0 && !same ? 1.0 : 0.0;
    }
    alignas(64) Lanes sum = doubtful;
    return lane_sum(sum);
}

}  // namespace

// What each node of a block sees: the nearest of the surfaces in its reach.
void Skin::look(std::size_t b) {
    const TrussBlockState& block = from(b);
    see_nothing(faces_, contact_, nearest_);
    plane_normal_.reset();
    corners_.clear();
    const bool only_dents = std::all_of(
        seen_.begin(), seen_.end(), [&](std::size_t k) { return is_left_to_dents(mesh_.panels_of[b], k); });
    const bool changed = !only_dents && look_at_surfaces(b, block);
    draw_in(b, block);
    // Of one obstacle the nearest place lies in no corner.
    if (changed || seen_.size() > 1) settle_in_corners(b);
}

// Has any node gone in by another face than the nearest?
bool Skin::look_at_surfaces(std::size_t b, const TrussBlockState& block) {
    look_at(b, block);
    const bool changed = find_entered_faces(block);
    if (block.touching) turn_flat_faces();
    return changed;
}

void Skin::look_at(std::size_t b, const TrussBlockState& block) {
    alignas(64) NearestLanes found;
    second_gap_.fill(infinity);
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        if (is_left_to_dents(mesh_.panels_of[b], seen_[k])) continue;
        const NearObstacle& obstacle = near_[seen_[k]];
        const Shape& shape = scene_.obstacles[obstacle.index].shape;
        nearest_of(shape, obstacle.now, obstacle.before, block.x, block.y, block.z, found, &block.force);
        leave_to_dents(b, seen_[k], found);
        if (k > 0) take_second(found, faces_, second_gap_);
        take_nearer(found, k, faces_, contact_, nearest_);
    }
    faces_.bx = contact_.nx, faces_.by = contact_.ny, faces_.bz = contact_.nz;
    // What pushes on no more than dents had their direction then, too; nodes that stay on a plane have its own.
    if (!block.touching || !any_meets(block.force, faces_.gap) || stay_on_planes(block)) return;
    // Of all surfaces at that instant: segments of a wall take over from each other.
    alignas(64) Lanes gap_before;
    gap_before.fill(infinity);
    for (const std::size_t k : seen_) {
        if (is_left_to_dents(mesh_.panels_of[b], k)) continue;
        const NearObstacle& obstacle = near_[k];
        nearest_of(scene_.obstacles[obstacle.index].shape, obstacle.before, obstacle.before, block.x, block.y,
                   block.z, found, &block.force);
        leave_to_dents(b, k, found);
        take_nearer_before(found, gap_before, faces_);
    }
}

// Have all nodes that push on what they see done so on the plane that they see now?
bool Skin::stay_on_planes(const TrussBlockState& block) const {
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        const NearObstacle& obstacle = near_[seen_[k]];
        if (std::holds_alternative<Post>(scene_.obstacles[obstacle.index].shape)) return false;
        const Mat3 to_body = obstacle.now.rotation.transpose();
        const Mat3 turn = to_body * obstacle.before.rotation - Mat3::Identity();
        const Vec3 shift = to_body * (obstacle.before.position - obstacle.now.position);
        const double off =
            furthest_off_plane(turn.data(), shift.data(), k, block, faces_, contact_, nearest_);
        if (!(off <= tolerance::touching_gap)) return false;
    }
    return true;
}

namespace {

// Normals that nodes of one obstacle had before, by its turn since.
BIRM3D_LANE_LOOP void turn_back(const double* turn, std::size_t seen,
                                const std::array<std::size_t, lanes>& nearest, const BlockContact& contact,
                                NodeFaces& faces) {
    const double xx = turn[0], yx = turn[1], zx = turn[2], xy = turn[3], yy = turn[4], zy = turn[5],
                 xz = turn[6], yz = turn[7], zz = turn[8];
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double x = contact.nx[i], y = contact.ny[i], z = contact.nz[i];
        const bool of_this = nearest[i] == seen;
        faces.bx[i] = of_this ? xx * x + xy * y + xz * z : faces.bx[i];
        faces.by[i] = of_this ? yx * x + yy * y + yz * z : faces.by[i];
        faces.bz[i] = of_this ? zx * x + zy * y + zz * z : faces.bz[i];
    }
}

}  // namespace

// A flat face, or an edge, had the same normal in its own axes an instant before, whatever was nearest then.
void Skin::turn_flat_faces() {
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        const NearObstacle& obstacle = near_[seen_[k]];
        if (std::holds_alternative<Post>(scene_.obstacles[obstacle.index].shape)) continue;
        const Mat3 turn = obstacle.before.rotation.transpose() * obstacle.now.rotation;
        turn_back(turn.data(), k, nearest_, contact_, faces_);
    }
}

// The nearest face can be the wrong one to nodes beside an edge: those that arrive, and those that seem to have changed
// over to another face. Meshes do the like with all that come in. Was it the wrong one to any?
bool Skin::find_entered_faces(const TrussBlockState& block) {
    bool changed = false;
    alignas(64) Lanes doubtful;
    if (find_doubtful(faces_, contact_, block.force, doubtful) == 0.0) return false;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(doubtful[i] > 0.0)) continue;
        const Shape& shape = scene_.obstacles[near_[seen_[nearest_[i]]].index].shape;
        if (std::holds_alternative<HalfSpace>(shape) || std::holds_alternative<TriangleMesh>(shape)) continue;
        const auto entered = entered_face(scene_, near_, seen_, {block.x[i], block.y[i], block.z[i]},
                                          nearest_[i], contact_.normal(i));
        if (!entered) continue;
        changed = true;
        nearest_[i] = entered->seen;
        const Vec3 &n = entered->now.normal, &m = entered->normal_before;
        faces_.gap[i] = entered->now.gap;
        contact_.nx[i] = n.x(), contact_.ny[i] = n.y(), contact_.nz[i] = n.z();
        faces_.bx[i] = m.x(), faces_.by[i] = m.y(), faces_.bz[i] = m.z();
    }
    return changed;
}

}  // namespace birm3d
