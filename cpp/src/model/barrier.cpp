#include "birm3d/model/barrier.hpp"

#include <cmath>

#include "birm3d/base/error.hpp"

namespace birm3d {

namespace {

double positive(const char* name, double value) {
    if (!(value > 0.0)) refuse(name, "> 0", value);
    return value;
}

}  // namespace

Barrier::Barrier(double friction_, const Vec3& origin_, double heading_, double width_, double height_)
    : friction(require_not_negative("friction", friction_)),
      origin(origin_),
      heading(require_finite("heading", heading_)),
      width(positive("width", width_)),
      height(positive("height", height_)) {
    if (!origin.allFinite()) refuse("origin", "finite", "a coordinate that is not");
    face = HalfSpace{normal(), normal().dot(origin)};
}

Barrier Barrier::pole(double friction, const Vec3& origin, double heading, double radius) {
    require_positive("radius", radius);
    Barrier pole(friction, origin, heading);
    pole.face = Cylinder{origin, Vec3::UnitZ(), radius};
    return pole;
}

Vec3 Barrier::normal() const {
    return {-std::cos(heading), -std::sin(heading), 0.0};
}

bool Barrier::finite() const {
    return std::isfinite(width) || std::isfinite(height);
}

}  // namespace birm3d
