#include "control/step_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "kernels/detect.hpp"
#include "kernels/integrate.hpp"
#include "scene/indentation_gaps.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// An obstacle, as a unit sees it: where it stands, and how the unit moves against it (body axes).
struct Seen {
    const Shape* shape;
    Placement placement;
    Twist motion;
};

// As untouched_step, for a block of nodes; no point of its unit is faster than `fastest` (m/s).
double untouched_step_of(const TrussBlockState& block, const std::vector<Seen>& near, double fastest,
                         double longest) {
    const Box& box = block.box;
    alignas(64) NearestOfBlock found, nearest;
    std::array<std::size_t, block_size> of;  // place in near
    nearest.gap.fill(infinity);
    of.fill(0);
    for (std::size_t j = 0; j < near.size(); ++j) {
        const Placement& seen = near[j].placement;
        if (!within_reach(*near[j].shape, seen, box, longest * fastest)) continue;
        nearest_of(*near[j].shape, seen, seen, block.x, block.y, block.z, found);
        for (std::size_t k = 0; k < block_size; ++k) {
            if (!(found.gap[k] < nearest.gap[k])) continue;
            nearest.gap[k] = found.gap[k];
            of[k] = j;
            nearest.nx[k] = found.nx[k], nearest.ny[k] = found.ny[k], nearest.nz[k] = found.nz[k];
        }
    }
    for (std::size_t k = 0; k < block_size; ++k) {
        const double gap = std::max(nearest.gap[k], 0.0);
        if (!(gap < longest * fastest) || is_slack(block, k)) continue;
        const Vec3 node(block.x[k], block.y[k], block.z[k]);
        const Twist& motion = near[of[k]].motion;
        const double approach = -Vec3(nearest.nx[k], nearest.ny[k], nearest.nz[k])
                                     .dot(motion.velocity + motion.angular_velocity.cross(node));
        const double straight = approach > 0.0 ? gap / approach : infinity;
        longest = std::min({longest, straight, (gap + tolerance::untouched_way) / fastest});
    }
    return longest;
}

}  // namespace

double untouched_step(const Scene& scene, const State& state, double longest) {
    std::vector<Seen> near;
    std::vector<std::size_t> about;
    const double segments = fastest_segment(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Unit& model = scene.vehicle->units[u];
        const TrussMesh& mesh = model.trusses;
        const double fastest = fastest_point(model, unit.body) + segments;
        if (!(fastest > 0.0)) continue;
        const auto reaches = [&](const Shape& shape, const Placement& seen, const Box& box) {
            return within_reach(shape, seen, box, longest * fastest);
        };
        const Mat3 R = unit.body.orientation.toRotationMatrix();
        const Vec3 v = R.transpose() * unit.body.velocity;
        const Vec3 w = R.transpose() * angular_velocity(model.body, unit.body);
        const Box& all = unit.trusses.around;
        near.clear();
        scene.map.find(unit.body.position, all.radius() + longest * fastest, about);
        for (const std::size_t i : about) {
            const Shape& shape = scene.obstacles[i].shape;
            const Placement seen = placement(pose_of(scene, i, state), unit.body);
            if (i == scene.ground || !reaches(shape, seen, all)) continue;
            const Twist other = obstacle_motion(scene, i, state, unit.body);
            near.push_back({&shape, seen, {v - other.velocity, w - other.angular_velocity}});
        }
        for (std::size_t g = 0; g < unit.trusses.groups.size(); ++g) {
            const BlockGroup& group = unit.trusses.groups[g];
            if (std::any_of(near.begin(), near.end(), [&](const Seen& seen) {
                    return reaches(*seen.shape, seen.placement, group.box);
                }))
                for (std::size_t b = g * TrussMesh::group_size; b < mesh.end_of_group(g); ++b)
                    longest = untouched_step_of(unit.trusses.block[b], near, fastest, longest);
        }
        if (mesh.indentation_length > 0.0) longest = step_to_indentation(scene, unit, mesh, fastest, longest);
    }
    return longest;
}

namespace {

// How far through an obstacle a point may get in one step, as a share of its thickness.
constexpr double way_in = 0.25;

// Time in which no point of a body gets further than that into the obstacle (s). Gliding along a wall is no
// way through it; `turning`: speed that its turning, and the obstacle's motion, add anywhere (m/s).
double passing_time(const Shape& shape, const Pose& pose, const Vec3& velocity, double turning) {
    const double width = thickness(shape);
    const auto* prism = std::get_if<Prism>(&shape);
    if (prism == nullptr) return way_in * width / (velocity.norm() + turning);
    const Vec3 own = pose.rotation.transpose() * velocity;
    const double along = way_in * (prism->y_high() - prism->y_low()) / (std::abs(own.y()) + turning);
    return std::min(way_in * width / (std::hypot(own.x(), own.z()) + turning), along);
}

}  // namespace

double passing_step(const Scene& scene, const State& state, double longest) {
    std::vector<std::size_t> about;
    const double segments = fastest_segment(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Unit& unit = scene.vehicle->units[u];
        const double speed = fastest_point(unit, body) + segments;
        if (!(longest * speed > way_in * scene.thinnest)) continue;
        const double turning = speed - body.velocity.norm();
        const Box& all = state.units[u].trusses.around;
        scene.map.find(body.position, all.radius() + longest * speed, about);
        for (const std::size_t i : about) {
            const Obstacle& obstacle = scene.obstacles[i];
            const Pose pose = pose_of(scene, i, state);
            const double time = passing_time(obstacle.shape, pose, body.velocity, turning);
            // Out of reach even after a step as long as this obstacle would allow.
            if (time < longest && within_reach(obstacle.shape, placement(pose, body), all, time * speed))
                longest = time;
        }
    }
    return longest;
}

}  // namespace birm3d
