#include "scene/obstacles.hpp"

#include <algorithm>
#include <optional>

#include "kernels/detect.hpp"
#include "kernels/integrate.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Points of a block and a box around them.
struct Points {
    Box box;
    const BlockColumn *x, *y, *z;
};

// The least of `least` and the gaps of the points of some blocks. Blocks whose box is further away are skipped.
// `block`: returns the points of a block, or none.
template <class Blocks>
double nearest_in_blocks(const Shape& shape, const Placement& in_shape, std::size_t blocks,
                         const Blocks& block, double least) {
    alignas(64) NearestOfBlock found;
    for (std::size_t b = 0; b < blocks; ++b) {
        const std::optional<Points> points = block(b);
        if (!points || !within_reach(shape, in_shape, points->box, least)) continue;
        nearest_of(shape, in_shape, in_shape, *points->x, *points->y, *points->z, found);
        least = std::min(least, *std::min_element(found.gap.begin(), found.gap.end()));
    }
    return least;
}

}  // namespace

Pose pose_of(const Scene& scene, std::size_t i, const State& state) {
    const Obstacle& obstacle = scene.obstacles[i];
    if (i >= state.moving_elements.size()) return {obstacle.rotation, obstacle.position};
    const BodyState& element = state.moving_elements[i];
    return {element.orientation.toRotationMatrix(),
            element.position - scene.barrier->moving_elements[i].mass_center_height * Vec3::UnitZ()};
}

Twist obstacle_motion(const Scene& scene, std::size_t i, const State& state, const BodyState& observer) {
    if (i >= state.moving_elements.size()) return {};
    const BodyState& element = state.moving_elements[i];
    const Mat3 R = observer.orientation.toRotationMatrix();
    const Vec3 spin = angular_velocity(scene.barrier->moving_elements[i].body, element);
    return {R.transpose() * (element.velocity + spin.cross(observer.position - element.position)),
            R.transpose() * spin};
}

Placement placement(const Pose& obstacle, const BodyState& observer) {
    const Mat3 to_own = obstacle.rotation.transpose();
    return {to_own * observer.orientation.toRotationMatrix(),
            to_own * (observer.position - obstacle.position)};
}

void find_near(const Scene& scene, std::size_t u, const State& before, const State& now, double margin,
               std::vector<std::size_t>& about, std::vector<NearObstacle>& near) {
    near.clear();
    const Box& box = before.units[u].trusses.around;
    scene.map.find(now.units[u].body.position, box.radius() + margin, about);
    for (const std::size_t i : about) {
        if (i == scene.ground && !scene.skin_meets_ground[u]) continue;
        const Placement in_shape = placement(pose_of(scene, i, now), now.units[u].body);
        if (within_reach(scene.obstacles[i].shape, in_shape, box, margin))
            near.push_back({i, in_shape, placement(pose_of(scene, i, before), before.units[u].body)});
    }
}

bool pushes_on(const UnitState& unit, std::size_t obstacle) {
    return std::any_of(unit.contact_loads.begin(), unit.contact_loads.end(), [=](const ContactLoad& load) {
        return load.obstacle == obstacle && load.normal_force > 0.0;
    });
}

double fastest_point(const Unit& unit, const BodyState& body) {
    return body.velocity.norm() + angular_velocity(unit.body, body).norm() * unit.trusses.reach;
}

double fastest_moving_element(const Scene& scene, const State& state) {
    double fastest = 0.0;
    for (std::size_t i = 0; i < state.moving_elements.size(); ++i)
        fastest =
            std::max(fastest, fastest_point(scene.barrier->moving_elements[i], state.moving_elements[i]));
    return fastest;
}

namespace {

// Some points of a block. Each of the others is replaced by one of these.
class SelectedPoints {
  public:
    template <class Keep>
    SelectedPoints(const Points& all, const Keep& keeps) : box_(all.box), x_(*all.x), y_(*all.y), z_(*all.z) {
        std::size_t known = 0;
        while (known < block_size && !keeps(known))
            ++known;
        any_ = known < block_size;
        if (!any_) return;
        for (std::size_t n = 0; n < block_size; ++n) {
            if (keeps(n)) continue;
            x_[n] = x_[known];
            y_[n] = y_[known];
            z_[n] = z_[known];
        }
    }
    std::optional<Points> points() const {
        return any_ ? std::optional(Points{box_, &x_, &y_, &z_}) : std::nullopt;
    }

  private:
    bool any_ = false;
    Box box_;
    alignas(64) BlockColumn x_, y_, z_;
};

}  // namespace

double nearest_gap(const Scene& scene, const State& state, const Nearness& what) {
    double least = infinity;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const UnitState& unit = state.units[u];
        const TrussMesh& mesh = scene.vehicle->units[u].trusses;
        const Box& all = unit.trusses.around;
        for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
            if (i == scene.ground && !(what.ground && scene.skin_meets_ground[u])) continue;
            const Shape& shape = scene.obstacles[i].shape;
            const Placement in_shape = placement(pose_of(scene, i, state), unit.body);
            if (!within_reach(shape, in_shape, all, least)) continue;
            // Skin that it has pushed aside may be inside its outline (kernels/indentation.hpp).
            const std::uint8_t indented = panels_by(unit.indented, i).panels;
            std::optional<SelectedPoints> selected;
            if (what.nodes)
                least = nearest_in_blocks(
                    shape, in_shape, i == scene.ground ? mesh.shell_blocks : mesh.blocks,
                    [&](std::size_t b) -> std::optional<Points> {
                        const TrussBlockState& block = unit.trusses.block[b];
                        if ((mesh.panels_of[b] & indented) != 0 || block.may_lag()) return std::nullopt;
                        if (b < mesh.skin_blocks || b >= mesh.shell_blocks)
                            return Points{block.box, &block.x, &block.y, &block.z};
                        // Nodes of second trusses count where they push, as the first trusses' nodes are the skin.
                        return selected
                            .emplace(Points{block.box, &block.x, &block.y, &block.z},
                                     [&](std::size_t n) { return block.force[n] > 0.0; })
                            .points();
                    },
                    least);
            if (!what.anchors) continue;
            least = nearest_in_blocks(
                shape, in_shape, mesh.skin_blocks,
                [&](std::size_t b) -> std::optional<Points> {
                    const TrussBlock& block = mesh.block[b];
                    Points anchors{mesh.anchor_box[b], &block.anchor_x, &block.anchor_y, &block.anchor_z};
                    if (!std::holds_alternative<Post>(shape)) return anchors;
                    const Unit& model = scene.vehicle->units[u];
                    return selected
                        .emplace(anchors,
                                 [&](std::size_t n) { return !model.gives_way(anchor_of(block, n)); })
                        .points();
                },
                least);
        }
    }
    return least;
}

}  // namespace birm3d
