#include "birm3d/sim/step_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/detect.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/obstacles.hpp"
#include "birm3d/sim/panel_dents.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

double untouched_step(const Scene& scene, const State& state, double longest) {
    struct Seen {
        const Shape* shape;
        Placement placement;
        Twist motion;
    };
    std::vector<Seen> near;
    std::vector<std::size_t> about;
    alignas(64) NearestLanes found, nearest;
    std::array<std::size_t, lanes> of;  // place in near
    const double segments = fastest_segment(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const Unit& model = scene.vehicle->units[u];
        const double fastest = fastest_point(model, unit.body) + segments;
        if (!(fastest > 0.0)) continue;
        const Mat3 R = unit.body.orientation.toRotationMatrix();
        const Vec3 v = R.transpose() * unit.body.velocity;
        const Vec3 w = R.transpose() * angular_velocity(model.body, unit.body);
        const Box& all = unit.trusses.around;
        near.clear();
        scene.map.find(unit.body.position, all.radius() + longest * fastest, about);
        for (const std::size_t i : about) {
            const Placement seen = placement(pose_of(scene, i, state), unit.body);
            if (i != scene.ground && within_reach(scene.obstacles[i].shape, seen, all, longest * fastest))
                near.push_back(
                    {&scene.obstacles[i].shape, seen, obstacle_motion(scene, i, state, unit.body)});
        }
        for (const TrussBlockState& block : unit.trusses.block) {
            const Box box = box_of(block);
            nearest.gap.fill(infinity);
            of.fill(0);
            for (std::size_t j = 0; j < near.size(); ++j) {
                const Placement& seen = near[j].placement;
                if (!within_reach(*near[j].shape, seen, box, longest * fastest)) continue;
                nearest_of(*near[j].shape, seen, seen, block.x, block.y, block.z, found);
                for (std::size_t k = 0; k < lanes; ++k) {
                    if (!(found.gap[k] < nearest.gap[k])) continue;
                    nearest.gap[k] = found.gap[k];
                    of[k] = j;
                    nearest.nx[k] = found.nx[k], nearest.ny[k] = found.ny[k], nearest.nz[k] = found.nz[k];
                }
            }
            for (std::size_t k = 0; k < lanes; ++k) {
                const double gap = std::max(nearest.gap[k], 0.0);
                if (!(gap < longest * fastest) || is_slack(block, k)) continue;
                const Vec3 node(block.x[k], block.y[k], block.z[k]);
                const Twist& other = near[of[k]].motion;
                const double approach =
                    -Vec3(nearest.nx[k], nearest.ny[k], nearest.nz[k])
                         .dot(v - other.velocity + (w - other.angular_velocity).cross(node));
                const double straight = approach > 0.0 ? gap / approach : infinity;
                longest = std::min({longest, straight, (gap + tolerance::untouched_way) / fastest});
            }
        }
        if (model.trusses.dent_reach > 0.0)
            longest = undented_step(scene, unit, model.trusses, fastest, longest);
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
