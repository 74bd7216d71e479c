#include "birm3d/geometry/post.hpp"

#include <cmath>
#include <numbers>

#include "birm3d/base/error.hpp"
#include "geometry/post_nearest.hpp"

namespace birm3d {

Post::Post(double radius_, double height_, std::optional<double> opens_)
    : radius(require_positive("radius", radius_)), height(height_), opens(opens_) {
    if (!(height > 0.0)) refuse("height", "> 0", height);
    if (opens && !std::isfinite(*opens)) refuse("opens", "finite", *opens);
}

Vec3 Post::along_face(int k) const {
    const double angle = *opens + (k == 0 ? 0.75 : -0.75) * std::numbers::pi;
    return {std::cos(angle), std::sin(angle), 0.0};
}

Nearest nearest(const Post& post, const Vec3& p) {
    Nearest out;
    nearest_of_post(post.radius, post.height, p.x(), p.y(), p.z(), out.gap, out.normal.x(), out.normal.y(),
                    out.normal.z());
    return out;
}

}  // namespace birm3d
