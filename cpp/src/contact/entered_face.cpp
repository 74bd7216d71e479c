#include "contact/entered_face.hpp"

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Cosine above which two normals are of one smooth surface.
constexpr double same_surface = 0.5;

// Cosine above which two normals differ by rounding alone.
constexpr double same_normal = 1.0 - 1e-12;

// Nodes on a surface may be this far inside it, as their paths are chords that cut curves and inner corners (m).
constexpr double shallow = 2e-3;

struct At {
    std::size_t reachable_index = 0;
    Nearest nearest{infinity, Vec3::UnitX()};  // own axes
};

// The nearest surface of all to a place. `point` gives the place in each obstacle's own axes.
template <class Point>
At nearest_of_all(const Scene& scene, std::span<const NearObstacle> near,
                  std::span<const std::size_t> reachable, const Point& point) {
    At best;
    for (std::size_t k = 0; k < reachable.size(); ++k) {
        const NearObstacle& obstacle = near[reachable[k]];
        const Nearest there = nearest(scene.obstacles[obstacle.index].shape, point(obstacle));
        if (there.gap < best.nearest.gap) best = {k, there};
    }
    return best;
}

}  // namespace

std::optional<EnteredFace> entered_face(const Scene& scene, std::span<const NearObstacle> near,
                                        std::span<const std::size_t> reachable, const Vec3& place,
                                        std::size_t nearest_now, const Vec3& normal_now, bool pushes) {
    const auto at_fraction = [&](double fraction) {
        return [&place, fraction](const NearObstacle& obstacle) -> Vec3 {
            return (1.0 - fraction) * obstacle.before.to_own(place) + fraction * obstacle.now.to_own(place);
        };
    };
    double outside = 0.0;
    At entry = nearest_of_all(scene, near, reachable, at_fraction(outside));
    if (entry.nearest.gap < -shallow) return std::nullopt;
    const NearObstacle& present = near[reachable[nearest_now]];
    // The node has crossed the face that is nearest now: no other face is needed.
    if (entry.reachable_index == nearest_now &&
        std::holds_alternative<Prism>(scene.obstacles[present.index].shape) &&
        entry.nearest.normal.dot(present.now.direction_to_own(normal_now)) > same_normal)
        return std::nullopt;
    // It may have stood on another surface, which it leaves before it enters this one.
    if (entry.nearest.gap >= -tolerance::touching_gap) {
        double inside = 1.0;
        constexpr int halvings = 20;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (outside + inside);
            const At there = nearest_of_all(scene, near, reachable, at_fraction(middle));
            if (there.nearest.gap >= -tolerance::touching_gap)
                outside = middle, entry = there;
            else
                inside = middle;
        }
    }
    const NearObstacle& at = near[reachable[entry.reachable_index]];
    const Vec3 n = entry.nearest.normal;
    const Vec3 entered = at_fraction(outside)(at) - entry.nearest.gap * n;
    const double depth = n.dot(at.now.to_own(place) - entered);
    if (!(depth < 0.0)) return std::nullopt;

    // Project the node back onto the plane of the face. The plane reaches beyond the face: does the face reach that
    // far?
    const Vec3 back = place - depth * at.now.direction_from_own(n);
    const At face = nearest_of_all(
        scene, near, reachable, [&back](const NearObstacle& obstacle) { return obstacle.now.to_own(back); });
    const NearObstacle& obstacle = near[reachable[face.reachable_index]];
    const Vec3 normal = obstacle.now.direction_from_own(face.nearest.normal);
    if (face.nearest.gap < -shallow) return std::nullopt;
    const bool flat = std::abs(face.nearest.gap) <= tolerance::touching_gap;
    if (flat)
        return EnteredFace{
            entry.reachable_index, {depth, at.now.direction_from_own(n)}, at.before.direction_from_own(n)};
    if (!(normal.dot(at.now.direction_from_own(n)) > same_surface)) return std::nullopt;
    const Vec3 surface = back - face.nearest.gap * normal;
    // The node has slid over an inner corner, where the plane of each face lies inside the other one. Use the
    // straight way out.
    if (!pushes && face.nearest.gap < -tolerance::touching_gap) {
        const Vec3 out = (surface - place).normalized();
        return EnteredFace{face.reachable_index, {-(surface - place).norm(), out}, out};
    }
    return EnteredFace{face.reachable_index,
                       {normal.dot(place - surface), normal},
                       obstacle.before.direction_from_own(face.nearest.normal)};
}

}  // namespace birm3d
