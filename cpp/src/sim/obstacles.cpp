#include "birm3d/sim/obstacles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/dent.hpp"
#include "birm3d/kernels/detect.hpp"
#include "birm3d/kernels/integrate.hpp"
#include "birm3d/sim/bodies.hpp"

namespace birm3d {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Around its nodes; that of the state is kept up only while nothing touches.
Box box_of(const TrussBlockState& block) {
    if (!block.touching) return block.box;
    return Box::around(lanes, [&block](std::size_t i) { return Vec3(block.x[i], block.y[i], block.z[i]); });
}

Box everything(const TrussMesh& mesh, const TrussState& trusses) {
    Box box{Vec3::Zero(), Vec3::Constant(mesh.reach)};
    for (const TrussBlockState& block : trusses.block) {
        if (!block.slack) continue;  // else no node is further away than where it was made
        const Box around = box_of(block);
        box.half = box.half.cwiseMax(around.center.cwiseAbs() + around.half);
    }
    return box;
}

// The least of `least` and the gaps of some points, of which a box can be left out that is further away.
template <class Blocks>
double nearest_in_blocks(const Shape& shape, const Placement& seen, std::size_t blocks, const Blocks& block,
                         double least) {
    alignas(64) NearestLanes found;
    for (std::size_t b = 0; b < blocks; ++b) {
        const auto [box, x, y, z] = block(b);
        if (!within_reach(shape, seen, box, least)) continue;
        nearest_of(shape, seen, seen, *x, *y, *z, found);
        least = std::min(least, *std::min_element(found.gap.begin(), found.gap.end()));
    }
    return least;
}

}  // namespace

Pose pose_of(const Scene& scene, std::size_t i, const State& state) {
    const Obstacle& obstacle = scene.obstacles[i];
    if (i >= state.segments.size()) return {obstacle.rotation, obstacle.position};
    const BodyState& segment = state.segments[i];
    return {segment.orientation.toRotationMatrix(),
            segment.position - scene.barrier->segments[i].mass_center_height * Vec3::UnitZ()};
}

Twist obstacle_motion(const Scene& scene, std::size_t i, const State& state, const BodyState& seen_from) {
    if (i >= state.segments.size()) return {};
    const BodyState& segment = state.segments[i];
    const Mat3 R = seen_from.orientation.toRotationMatrix();
    const Vec3 spin = angular_velocity(scene.barrier->segments[i].body, segment);
    return {R.transpose() * (segment.velocity + spin.cross(seen_from.position - segment.position)),
            R.transpose() * spin};
}

Placement placement(const Pose& obstacle, const BodyState& seen_from) {
    const Mat3 to_own = obstacle.rotation.transpose();
    return {to_own * seen_from.orientation.toRotationMatrix(),
            to_own * (seen_from.position - obstacle.position)};
}

void find_near(const Scene& scene, std::size_t u, const State& before, const State& now, double margin,
               std::vector<NearObstacle>& near) {
    near.clear();
    const Box box = everything(scene.vehicle->units[u].trusses, before.units[u].trusses);
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
        if (i == scene.ground && !scene.skin_meets_ground[u]) continue;
        const Placement seen = placement(pose_of(scene, i, now), now.units[u].body);
        if (within_reach(scene.obstacles[i].shape, seen, box, margin))
            near.push_back({i, seen, placement(pose_of(scene, i, before), before.units[u].body)});
    }
}

double fastest_point(const Unit& unit, const BodyState& body) {
    return body.velocity.norm() + angular_velocity(unit.body, body).norm() * unit.trusses.reach;
}

double fastest_segment(const Scene& scene, const State& state) {
    double fastest = 0.0;
    for (std::size_t i = 0; i < state.segments.size(); ++i)
        fastest = std::max(fastest, fastest_point(scene.barrier->segments[i], state.segments[i]));
    return fastest;
}

double nearest_gap(const Scene& scene, const State& state, const Nearness& what) {
    double least = infinity;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        const Box all = everything(mesh, unit.trusses);
        for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
            if (i == scene.ground && !(what.ground && scene.skin_meets_ground[u])) continue;
            const Shape& shape = scene.obstacles[i].shape;
            const Placement seen = placement(pose_of(scene, i, state), unit.body);
            if (!within_reach(shape, seen, all, least)) continue;
            struct Points {
                Box box;
                const Lanes *x, *y, *z;
            };
            if (what.nodes)
                least = nearest_in_blocks(
                    shape, seen, i == scene.ground ? mesh.skin_blocks : mesh.blocks,
                    [&](std::size_t b) {
                        const TrussBlockState& block = unit.trusses.block[b];
                        return Points{box_of(block), &block.x, &block.y, &block.z};
                    },
                    least);
            if (!what.anchors) continue;
            least = nearest_in_blocks(
                shape, seen, mesh.skin_blocks,
                [&](std::size_t b) {
                    const TrussBlock& block = mesh.block[b];
                    return Points{mesh.anchor_box[b], &block.anchor_x, &block.anchor_y, &block.anchor_z};
                },
                least);
        }
    }
    return least;
}

double gap_of_panel(const Dent& dent, std::size_t panel, const TrussMesh& mesh, const TrussState& trusses,
                    double far, double enough) {
    double least = infinity;
    alignas(64) DentLanes found;
    for (std::size_t b = 0; b < mesh.blocks && least > enough; ++b) {
        const TrussBlockState& block = trusses.block[b];
        if ((mesh.panels_of[b] >> panel & 1U) == 0 || -most_inside(dent, box_of(block)) > far) continue;
        dent_of(dent, block, found);
        for (std::size_t i = 0; i < lanes; ++i)
            if (mesh.block[b].panel[i] == static_cast<double>(panel)) least = std::min(least, found.gap[i]);
    }
    return least;
}

namespace {

// Calls `use` with each dent that a post makes or would make, and how far the nodes of the panel are from it, at least
// (m); infinite where that is more than `far`. `whole`: as if the panel had no ends.
template <class Use>
void for_each_dent(const Scene& scene, const UnitState& unit, const TrussMesh& mesh, double far, bool whole,
                   const Use& use) {
    for (const Obstacle& obstacle : scene.obstacles) {
        const Post* post = std::get_if<Post>(&obstacle.shape);
        if (post == nullptr) continue;
        const Placement seen =
            placement({obstacle.rotation, obstacle.position}, unit.body);  // posts are fixed
        for (std::size_t p = 0; p < panels; ++p) {
            const Panel& panel = mesh.panel[p];
            if (!panel.any || !stands_across(seen, panel, false)) continue;
            Dent dent(*post, seen, panel, mesh.dent_reach);
            if (whole) {
                dent.low = -infinity;
                dent.high = infinity;
            } else if (!dent.overlaps(panel)) {
                continue;
            }
            use(dent.fastest_growth(panel), gap_of_panel(dent, p, mesh, unit.trusses, far, -infinity));
        }
    }
}

// A step in which no post comes to dent a panel (s). Those that stand beside it or within come from the side.
double undented_step(const Scene& scene, const UnitState& unit, const TrussMesh& mesh, double fastest,
                     double longest) {
    for_each_dent(scene, unit, mesh, (2.0 + mesh.reach / mesh.dent_reach) * longest * fastest, true,
                  [&](double growth, double gap) {
                      if (gap > 0.0)
                          longest = std::min(longest, (gap + tolerance::untouched_way) / (growth * fastest));
                  });
    return longest;
}

}  // namespace

double overlap_of_dents(const Scene& scene, const State& state, double deepest) {
    double most = 0.0;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        if (mesh.dent_reach == 0.0) continue;
        for_each_dent(scene, state.units[u], mesh, 0.0, false, [&](double, double gap) {
            if (-gap < deepest) most = std::max(most, -gap);
        });
    }
    return most;
}

double untouched_step(const Scene& scene, const State& state) {
    double longest = infinity;
    struct Seen {
        const Shape* shape;
        Placement placement;
        Twist motion;
    };
    std::vector<Seen> near;
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
        const Box all = everything(model.trusses, unit.trusses);
        near.clear();
        for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
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

// Time in which no point of a body gets further than a quarter through the obstacle (s). Gliding along a wall is no
// way through it; `turning`: speed that its turning, and the obstacle's motion, add anywhere (m/s).
double passing_time(const Shape& shape, const Pose& pose, const Vec3& velocity, double turning) {
    const double width = thickness(shape);
    const auto* prism = std::get_if<Prism>(&shape);
    if (prism == nullptr) return 0.25 * width / (velocity.norm() + turning);
    const Vec3 own = pose.rotation.transpose() * velocity;
    const double along = 0.25 * (prism->y_high() - prism->y_low()) / (std::abs(own.y()) + turning);
    return std::min(0.25 * width / (std::hypot(own.x(), own.z()) + turning), along);
}

}  // namespace

double passing_step(const Scene& scene, const State& state) {
    double longest = infinity;
    const double segments = fastest_segment(scene, state);
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Unit& unit = scene.vehicle->units[u];
        const double speed = fastest_point(unit, body) + segments;
        if (!(speed > 0.0)) continue;
        const double turning = speed - body.velocity.norm();
        for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
            const Obstacle& obstacle = scene.obstacles[i];
            const Pose pose = pose_of(scene, i, state);
            const double time = passing_time(obstacle.shape, pose, body.velocity, turning);
            // Out of reach even after a step as long as this obstacle would allow.
            if (time < longest &&
                within_reach(obstacle.shape, placement(pose, body),
                             everything(unit.trusses, state.units[u].trusses), time * speed))
                longest = time;
        }
    }
    return longest;
}

}  // namespace birm3d
