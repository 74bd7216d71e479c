#include "control/step_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "kernels/detect.hpp"
#include "kernels/integrate.hpp"
#include "scene/indentation_gaps.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

namespace {

// Position of an obstacle and relative motion of the unit (body axes).
struct RelativeObstacle {
    const Shape* shape;
    Placement placement;
    Twist motion;
};

// untouched_step() for one block of nodes; no point of its unit is faster than `fastest` (m/s).
double untouched_step_of(const TrussBlockState& block, const std::vector<RelativeObstacle>& near,
                         double fastest, double longest) {
    const Box& box = block.box;
    alignas(64) NearestOfBlock found, nearest;
    std::array<std::size_t, block_size> which;  // place in near
    nearest.gap.fill(infinity);
    which.fill(0);
    for (std::size_t j = 0; j < near.size(); ++j) {
        const Placement& in_shape = near[j].placement;
        if (!within_reach(*near[j].shape, in_shape, box, longest * fastest)) continue;
        nearest_of(*near[j].shape, in_shape, in_shape, block.x, block.y, block.z, found);
        for (std::size_t k = 0; k < block_size; ++k) {
            if (!(found.gap[k] < nearest.gap[k])) continue;
            nearest.gap[k] = found.gap[k];
            which[k] = j;
            nearest.nx[k] = found.nx[k], nearest.ny[k] = found.ny[k], nearest.nz[k] = found.nz[k];
        }
    }
    for (std::size_t k = 0; k < block_size; ++k) {
        const double gap = std::max(nearest.gap[k], 0.0);
        if (!(gap < longest * fastest) || is_slack(block, k)) continue;
        const Vec3 node(block.x[k], block.y[k], block.z[k]);
        const Twist& motion = near[which[k]].motion;
        const double approach = -Vec3(nearest.nx[k], nearest.ny[k], nearest.nz[k])
                                     .dot(motion.velocity + motion.angular_velocity.cross(node));
        const double straight = approach > 0.0 ? gap / approach : infinity;
        longest = std::min({longest, straight, (gap + tolerance::untouched_distance) / fastest});
    }
    return longest;
}

}  // namespace

double untouched_step(const Scene& scene, const State& state, double longest) {
    std::vector<RelativeObstacle> near;
    std::vector<std::size_t> about;
    const double element_speed = fastest_moving_element(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Unit& model = scene.vehicle->units[u];
        const TrussMesh& mesh = model.trusses;
        const double fastest = fastest_point(model, unit.body) + element_speed;
        if (!(fastest > 0.0)) continue;
        const auto reaches = [&](const Shape& shape, const Placement& in_shape, const Box& box) {
            return within_reach(shape, in_shape, box, longest * fastest);
        };
        const Twist motion = twist_in_body_axes(model.body, unit.body);
        const Box& all = unit.trusses.around;
        near.clear();
        scene.map.find(unit.body.position, all.radius() + longest * fastest, about);
        for (const std::size_t i : about) {
            const Shape& shape = scene.obstacles[i].shape;
            const Placement in_shape = placement(pose_of(scene, i, state), unit.body);
            if (i == scene.ground || !reaches(shape, in_shape, all)) continue;
            const Twist other = obstacle_motion(scene, i, state, unit.body);
            near.push_back(
                {&shape,
                 in_shape,
                 {motion.velocity - other.velocity, motion.angular_velocity - other.angular_velocity}});
        }
        for (std::size_t g = 0; g < unit.trusses.groups.size(); ++g) {
            const BlockGroup& group = unit.trusses.groups[g];
            if (std::any_of(near.begin(), near.end(), [&](const RelativeObstacle& in_shape) {
                    return reaches(*in_shape.shape, in_shape.placement, group.box);
                }))
                for (std::size_t b = g * TrussMesh::group_size; b < mesh.end_of_group(g); ++b)
                    longest = untouched_step_of(unit.trusses.block[b], near, fastest, longest);
        }
        if (mesh.indentation_length > 0.0)
            longest = step_to_indentation(scene, unit, model, fastest, longest);
    }
    return longest;
}

namespace {

// How far a point may move into an obstacle in one step, as a fraction of its thickness.
constexpr double passing_fraction = 0.25;

// Time in which no point of a body moves further than that into the obstacle (s). Motion along a wall does not count.
// `rotation_speed`: bound of the speed that rotation and the obstacle's motion add (m/s).
double passing_time(const Shape& shape, const Pose& pose, const Vec3& velocity, double rotation_speed) {
    const double width = thickness(shape);
    const auto* prism = std::get_if<Prism>(&shape);
    if (prism == nullptr) return passing_fraction * width / (velocity.norm() + rotation_speed);
    const Vec3 local = pose.rotation.transpose() * velocity;
    const double along =
        passing_fraction * (prism->y_high() - prism->y_low()) / (std::abs(local.y()) + rotation_speed);
    return std::min(passing_fraction * width / (std::hypot(local.x(), local.z()) + rotation_speed), along);
}

}  // namespace

double passing_step(const Scene& scene, const State& state, double longest) {
    std::vector<std::size_t> about;
    const double element_speed = fastest_moving_element(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Unit& unit = scene.vehicle->units[u];
        const double speed = fastest_point(unit, body) + element_speed;
        if (!(longest * speed > passing_fraction * scene.thinnest)) continue;
        const double rotation_speed = speed - body.velocity.norm();
        const Box& all = state.units[u].trusses.around;
        scene.map.find(body.position, all.radius() + longest * speed, about);
        for (const std::size_t i : about) {
            const Obstacle& obstacle = scene.obstacles[i];
            const Pose pose = pose_of(scene, i, state);
            const double time = passing_time(obstacle.shape, pose, body.velocity, rotation_speed);
            // Out of reach even after a step as long as this obstacle would allow.
            if (time < longest && within_reach(obstacle.shape, placement(pose, body), all, time * speed))
                longest = time;
        }
    }
    return longest;
}

}  // namespace birm3d
