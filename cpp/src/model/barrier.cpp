#include "birm3d/model/barrier.hpp"

#include <cmath>

#include "birm3d/base/error.hpp"

namespace birm3d {

Barrier::Barrier(double friction_, const Vec3& origin_, double heading_)
    : friction(require_not_negative("friction", friction_)),
      origin(origin_),
      heading(require_finite("heading", heading_)) {
    if (!origin.allFinite()) refuse("origin", "finite", "a coordinate that is not");
    face.normal = Vec3(-std::cos(heading), -std::sin(heading), 0.0);
    face.offset = face.normal.dot(origin);
}

}  // namespace birm3d
