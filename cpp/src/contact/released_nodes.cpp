#include "contact/released_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "base/block_loop.hpp"
#include "birm3d/base/tolerances.hpp"
#include "contact/leaving_nodes.hpp"
#include "contact/stopping_face.hpp"

namespace birm3d {

namespace {

// Least distance between two tested points of a path (m): thinner surfaces may be missed.
constexpr double least_stride = 2e-3;

double gap_at(const ContactPass& pass, std::size_t k, const Vec3& place) {
    return nearest(pass.shape(k), pass.near[k].now.to_own(place)).gap;
}

double gap_at(const ContactPass& pass, const NearObstacle& distant, const Vec3& place) {
    return nearest(pass.scene.obstacles[distant.index].shape, distant.now.to_own(place)).gap;
}

// Finds obstacles that a released node may reach, though no other part of the vehicle is near them.
void find_distant(const ContactPass& pass, DistantObstacles& distant) {
    if (distant.are_found) return;
    distant.are_found = true;
    const BodyState& body = pass.now.units[pass.unit_index].body;
    std::vector<std::size_t> about;
    pass.scene.map.find(body.position, 2.0 * pass.mesh.reach, about);
    for (const std::size_t i : about) {
        if (i == pass.scene.ground && !pass.scene.skin_meets_ground[pass.unit_index]) continue;
        const bool known = std::any_of(pass.near.begin(), pass.near.end(),
                                       [i](const NearObstacle& near) { return near.index == i; });
        if (!known) distant.list.push_back({i, placement(pose_of(pass.scene, i, pass.now), body), {}});
    }
}

// The path of a released node.
struct Path {
    std::size_t block, node_index;
    Vec3 start, end;

    Vec3 at(double fraction) const { return start + fraction * (end - start); }
};

// Least gap between a point of the path and any surface that can stop the node, at most `enough` (m).
double least_gap(const ContactPass& pass, const DistantObstacles& distant, const Path& path, double fraction,
                 double enough) {
    const Vec3 place = path.at(fraction);
    double least = enough;
    for (const NearObstacle& other : distant.list)
        if (other.index != pass.scene.ground || path.block < pass.mesh.shell_blocks)
            least = std::min(least, gap_at(pass, other, place));
    for (std::size_t k = 0; k < pass.near.size(); ++k)
        if (is_solid_to(pass, path.block, path.node_index, k))
            least = std::min(least, gap_at(pass, k, place));
    return least;
}

// The point at which the first surface stops the node; none if the path is free.
std::optional<Vec3> first_stop(const ContactPass& pass, const DistantObstacles& distant, const Path& path) {
    const double length = (path.end - path.start).norm();
    const auto gap_of = [&](double fraction) { return least_gap(pass, distant, path, fraction, length); };
    double outside = 0.0, gap = gap_of(0.0);
    if (gap < -tolerance::touching_gap) return path.start;
    // No surface is nearer than the gap, so the path is free over that distance.
    while (gap >= -tolerance::touching_gap) {
        if (outside >= 1.0) return std::nullopt;
        const double next = std::min(1.0, outside + std::max(gap, least_stride) / length);
        gap = gap_of(next);
        if (gap >= -tolerance::touching_gap) {
            outside = next;
            continue;
        }
        double inside = next;
        constexpr int halvings = 40;
        for (int n = 0; n < halvings && (inside - outside) * length > 1e-12; ++n) {
            const double middle = 0.5 * (outside + inside);
            (gap_of(middle) >= 0.0 ? outside : inside) = middle;
        }
    }
    return path.at(outside);
}

// The same. Distant obstacles, near which there is no other part of the vehicle, can stop the node, too.
std::optional<Vec3> find_first_stop(const ContactPass& pass, const Path& path, DistantObstacles& distant) {
    find_distant(pass, distant);
    const auto stop = first_stop(pass, distant, path);
    distant.were_met =
        distant.were_met ||
        (stop && std::any_of(distant.list.begin(), distant.list.end(), [&](const NearObstacle& other) {
             return gap_at(pass, other, *stop) < least_stride;
         }));
    return stop;
}

// The place to which the truss of a released node returns it.
Vec3 free_place(const TrussBlock& truss, const TrussBlockState& nodes, std::size_t i) {
    const Vec3 anchor = anchor_of(truss, i);
    return anchor - (truss.length[i] - nodes.residual[i]) *
                        (anchor - Vec3(nodes.x[i], nodes.y[i], nodes.z[i])).normalized();
}

void set_truss(const StoppedNode& node, TrussBlockState& nodes) {
    const std::size_t i = node.node_index;
    nodes.unloading[i] = node.unloading;
    nodes.x[i] = node.place.x(), nodes.y[i] = node.place.y(), nodes.z[i] = node.place.z();
    nodes.deflection[i] = node.deflection;
    nodes.residual[i] = node.residual;
    nodes.peak_deflection[i] = node.peak_deflection;
    nodes.force[i] = node.force;
}

// Places to which the surface held the nodes until the end of the step (body axes).
struct HeldNodes {
    alignas(64) BlockColumn x, y, z;
};

BIRM3D_BLOCK_LOOP void find_held_on_plane(const TrussBlockState& last, double nx, double ny, double nz,
                                          double offset, double hx, double hy, double hz, HeldNodes& held) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double gap = (nx * last.x[i] + (ny * last.y[i] + nz * last.z[i])) - offset;
        held.x[i] = last.x[i] - gap * hx;
        held.y[i] = last.y[i] - gap * hy;
        held.z[i] = last.z[i] - gap * hz;
    }
}

// Marks with 1 the nodes that the surface has released though their trusses do not point into it.
BIRM3D_BLOCK_LOOP void find_released(const TrussBlock& truss, const TrussBlockState& last,
                                     const TrussBlockState& next, const BlockContact& contact,
                                     const HeldNodes& held, BlockColumn& released) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < block_size; ++i) {
        const double into = (truss.anchor_x[i] - held.x[i]) * contact.nx[i] +
                            ((truss.anchor_y[i] - held.y[i]) * contact.ny[i] +
                             (truss.anchor_z[i] - held.z[i]) * contact.nz[i]);
        released[i] = last.force[i] > 0.0 && next.force[i] == 0.0 && !(into > 0.0) ? 1.0 : 0.0;
    }
}

// The face held the nodes to the end of the step, unless they left by themselves: see release() in crush_simd.cpp.
void find_released(const ContactPass& pass, const FlatContact* plane, const ContactBlock& block,
                   HeldNodes& held, BlockColumn& released) {
    if (plane != nullptr) {
        const Vec3 &n = plane->face.normal, &h = plane->holding;
        find_held_on_plane(*block.start, n.x(), n.y(), n.z(), plane->face.offset, h.x(), h.y(), h.z(), held);
    } else {
        held = {block.contact.px, block.contact.py, block.contact.pz};
    }
    find_released(pass.mesh.block[block.index], *block.start, *block.end, block.contact, held, released);
}

// A surface has released the node: another one may stop it.
void find_stop(const ContactPass& pass, const FlatContact* plane, std::size_t i, const Vec3& held,
               ContactBlock& block, DistantObstacles& distant) {
    const TrussBlock& truss = pass.mesh.block[block.index];
    const TrussBlockState &last = *block.start, &next = *block.end;
    if (plane == nullptr && block.faces.per_force[i] > 0.0) return;  // an indentation holds it
    if (plane == nullptr && block.lags[i]) return;                   // it is inside a surface already
    const Vec3 anchor = anchor_of(truss, i);
    const Vec3 to(next.x[i], next.y[i], next.z[i]), was(last.x[i], last.y[i], last.z[i]);
    const Vec3 n = block.contact.normal(i);
    if ((to - held).norm() <= tolerance::touching_gap) return;
    const auto stop = find_first_stop(pass, {block.index, i, held, to}, distant);
    if (!stop) return;
    const double deflection = truss.length[i] - (*stop - anchor).norm();
    const double at_release = truss.length[i] - (held - anchor).norm();
    block.stopped.push_back({i, *stop, deflection, next.residual[i], next.peak_deflection[i],
                             unloading_force(truss, next, i, deflection), next.unloading[i],
                             0.5 * last.force[i] * (at_release - last.deflection[i])});
    StoppedNode& node = block.stopped.back();
    node.released_by = {block.reachable[plane != nullptr ? 0 : block.nearest[i]], n, n.dot(was - held)};
    find_stopping_face(pass, block, (to - held).normalized(), node);
}

// Does the path lead into a surface that its start is at? Skin that follows a post slides on the ground.
bool leads_into_surface(const ContactPass& pass, const Path& path) {
    for (std::size_t k = 0; k < pass.near.size(); ++k) {
        if (!is_solid_to(pass, path.block, path.node_index, k)) continue;
        const double gap = gap_at(pass, k, path.start);
        if (gap <= tolerance::touching_gap && gap_at(pass, k, path.end) < gap - tolerance::touching_gap)
            return true;
    }
    return false;
}

// Does the node lag inside a wall that its block hangs over? The block's other nodes may stand before the wall.
bool lags_inside(const ContactPass& pass, std::size_t b, std::size_t i, const TrussBlockState& nodes) {
    if (!nodes.may_lag(i)) return false;
    const Vec3 place(nodes.x[i], nodes.y[i], nodes.z[i]);
    for (std::size_t k = 0; k < pass.near.size(); ++k)
        if (is_solid_to(pass, b, i, k) && gap_at(pass, k, place) < -tolerance::touching_gap) return true;
    return false;
}

// The truss of a node that an indentation releases extends to its free length. The first surface on its way stops it. A post
// or a wall's upright edge releases it outside all surfaces but the one that it stands on. Skin that hung over a top may
// be inside the wall: no surface stops that.
StoppedNode left_node(const ContactPass& pass, std::size_t i, double work, const ContactBlock& block,
                      DistantObstacles& distant) {
    const TrussBlock& truss = pass.mesh.block[block.index];
    const TrussBlockState& last = *block.start;
    const Path path{block.index, i, {last.x[i], last.y[i], last.z[i]}, free_place(truss, last, i)};
    const double residual = last.residual[i];
    StoppedNode node{i, path.end, residual, residual, last.peak_deflection[i], 0.0, last.unloading[i], work};
    const auto stop =
        lags_inside(pass, block.index, i, last) ? std::nullopt : find_first_stop(pass, path, distant);
    if (!stop || (*stop == path.start && !leads_into_surface(pass, path))) return node;
    node.place = *stop;
    node.deflection = truss.length[i] - (*stop - anchor_of(truss, i)).norm();
    node.force = unloading_force(truss, last, i, node.deflection);
    return node;
}

}  // namespace

void snap_back(const ContactPass& pass, ContactBlock& block) {
    const TrussBlockState& start = *block.start;
    if (!start.slack) return;
    const TrussBlock& truss = pass.mesh.block[block.index];
    bool slack = false;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!is_slack(start, i)) continue;
        const Vec3 place = free_place(truss, start, i);
        bool free = true;
        for (std::size_t k = 0; k < pass.near.size() && free; ++k)
            free = !pass.meets(block.index, k) || gap_at(pass, k, place) >= 0.0;
        if (!free) {
            slack = true;
            continue;
        }
        TrussBlockState& altered = block.alter();
        altered.x[i] = place.x(), altered.y[i] = place.y(), altered.z[i] = place.z();
        altered.deflection[i] = start.residual[i];
    }
    if (!block.is_altered()) return;
    block.altered.slack = slack;
    block.altered.box = box_around(block.altered.x, block.altered.y, block.altered.z);
}

bool is_solid_to(const ContactPass& pass, std::size_t b, std::size_t i, std::size_t k) {
    if (!pass.meets(b, k)) return false;
    return std::none_of(pass.indentations.begin(), pass.indentations.end(),
                        [&](const IndentedPanel& indented) {
                            return indented.near == k && pass.replaces_surface(indented) &&
                                   pass.mesh.block[b].panel[i] == static_cast<double>(indented.panel);
                        });
}

bool may_release(const ContactPass& pass, const ContactBlock& block, bool ceased) {
    if (ceased || !was_indented(pass, block)) return ceased;
    alignas(64) BlockColumn leaves;
    find_leaving(pass, block, leaves);
    return block_max(leaves) > 0.0;
}

bool find_stopped(const ContactPass& pass, const FlatContact* plane, ContactBlock& block,
                  DistantObstacles& distant) {
    block.stopped.clear();
    alignas(64) BlockColumn leaves, released, work;
    HeldNodes held;
    find_leaving(pass, block, leaves);
    if (std::any_of(leaves.begin(), leaves.end(), [](double leaving) { return leaving > 0.0; }))
        find_work_until_leaving(pass, block, work);
    find_released(pass, plane, block, held, released);
    for (std::size_t i = 0; i < block_size; ++i) {
        if (leaves[i] > 0.0)
            block.stopped.push_back(left_node(pass, i, work[i], block, distant));
        else if (released[i] > 0.0)
            find_stop(pass, plane, i, {held.x[i], held.y[i], held.z[i]}, block, distant);
    }
    return !block.stopped.empty() && !distant.were_met;
}

// Counts the work on their trusses up to their release.
void stop_nodes(const ContactPass& pass, ContactBlock& block, ContactSums& sums) {
    TrussBlockState& nodes = block.alter();
    nodes.touching = true;
    for (const StoppedNode& node : block.stopped) {
        if (!node.stays) {
            set_truss(node, nodes);
            sums.several.released_work += node.work;
        }
        for (std::size_t k = 0; k < pass.near.size(); ++k) {
            const auto place = std::lower_bound(block.reachable.begin(), block.reachable.end(), k);
            if ((place == block.reachable.end() || *place != k) && pass.meets(block.index, k) &&
                gap_at(pass, k, node.place) < least_stride)
                block.reachable.insert(place, k);
        }
    }
    for (const std::size_t k : block.reachable)
        sums.obstacles[k].reached = true;
}

}  // namespace birm3d
