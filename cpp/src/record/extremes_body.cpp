// How far the rigid bodies got past the barrier's line, and how high their wheels.
#include <algorithm>
#include <cmath>
#include <optional>

#include "birm3d/record/extremes.hpp"

namespace birm3d {

namespace {

// Finds the anchor of a skin that is furthest along a direction.
//
// The box of a block bounds how far its anchors can be, so that most blocks are skipped. A convex hull is not used,
// as anchors in one plane or on one line have none.
class Anchors {
  public:
    explicit Anchors(const TrussMesh& mesh) : mesh_(mesh) {}

    // Distance of the furthest one along a unit vector, body axes (m).
    double furthest(const Vec3& direction) {
        double furthest = in_block(last_, direction);  // most likely the same as before
        const Vec3 size = direction.cwiseAbs();
        for (std::size_t b = 0; b < mesh_.skin_blocks; ++b) {
            const Box& box = mesh_.anchor_box[b];
            if (b == last_ || direction.dot(box.center) + size.dot(box.half) <= furthest) continue;
            const double here = in_block(b, direction);
            if (here > furthest) furthest = here, last_ = b;
        }
        return furthest;
    }
    double reach() const { return mesh_.reach; }

  private:
    double in_block(std::size_t b, const Vec3& direction) const {
        const TrussBlock& block = mesh_.block[b];
        BlockColumn along;
        for (std::size_t i = 0; i < block_size; ++i)  // padding has an anchor of the skin
            along[i] = block.anchor_x[i] * direction.x() + block.anchor_y[i] * direction.y() +
                       block.anchor_z[i] * direction.z();
        return *std::max_element(along.begin(), along.end());
    }

    const TrussMesh& mesh_;
    std::size_t last_ = 0;
};

// Greatest distance of an anchor past the line over the rows, if it is above `least` (m).
double penetration_of(const UnitHistory& unit, const TrussMesh& mesh, const Vec3& past, const Vec3& origin,
                      double least) {
    Anchors anchors(mesh);
    double greatest = least;
    // The last answer, and the orientation it is of. From one orientation to another the direction changes by no more
    // than twice the distance of the two quaternions. The answer changes by no more than the reach times that, and by
    // rounding.
    std::optional<Eigen::Vector4d> known;
    double furthest = 0.0;
    const double twice_reach = 2.0 * anchors.reach(), rounding = 1e-13 * anchors.reach();
    const auto compare = [&](std::size_t k) {
        const double center = past.dot(unit.position[k] - origin);
        const double missing = greatest - center;
        if (anchors.reach() + rounding <= missing) return;
        const Eigen::Vector4d& orientation = unit.orientation[k].coeffs();
        if (const double slack = missing - furthest - rounding; known && slack >= 0.0)
            if (twice_reach * twice_reach * (orientation - *known).squaredNorm() <= slack * slack) return;
        known = orientation, furthest = anchors.furthest(unit.orientation[k].conjugate() * past);
        greatest = std::max(greatest, center + furthest);
    };
    // Starting with the row where the mass centre is furthest excludes most other rows.
    std::size_t deepest = 0;
    double furthest_along = -infinity;
    for (std::size_t k = 0; k < unit.position.size(); ++k)
        if (const double at = past.dot(unit.position[k]); at > furthest_along)
            furthest_along = at, deepest = k;
    compare(deepest);
    for (std::size_t k = 0; k < unit.position.size(); ++k)
        compare(k);
    return greatest;
}

}  // namespace

double greatest_penetration(const History& history, const Vehicle& vehicle, const Barrier& barrier) {
    double greatest = 0.0;
    for (std::size_t u = 0; u < vehicle.units.size(); ++u)
        greatest = penetration_of(history.units[u], vehicle.units[u].trusses, -barrier.normal(),
                                  barrier.origin, greatest);
    return greatest;
}

double greatest_wheel_climb(const History& history, const Vehicle& vehicle) {
    double greatest = 0.0;
    for (std::size_t u = 0; u < vehicle.units.size(); ++u) {
        const std::vector<Wheel>& wheels = vehicle.units[u].wheels;
        const UnitHistory& unit = history.units[u];
        if (wheels.empty()) continue;
        for (std::size_t k = 0; k < unit.position.size(); ++k) {
            const Vec3 up = unit.orientation[k].conjugate() * Vec3::UnitZ();         // body axes
            const double upright = std::sqrt(std::max(0.0, 1.0 - up.y() * up.y()));  // of the radius
            for (const Wheel& wheel : wheels) {
                // A sprung wheel that leaves the ground is fully extended.
                const double center = wheel.center.dot(up) - wheel.suspension.at_rest * up.z();
                greatest = std::max(greatest, unit.position[k].z() + center -
                                                  (wheel.radius - wheel.tread_radius) * upright -
                                                  wheel.tread_radius);
            }
        }
    }
    return greatest;
}

}  // namespace birm3d
