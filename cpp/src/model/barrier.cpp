#include "birm3d/model/barrier.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "birm3d/base/error.hpp"

namespace birm3d {

Barrier::Barrier(std::vector<Element> elements_, double friction_, const Vec3& origin_, double heading_)
    : elements(std::move(elements_)),
      friction(require_not_negative("friction", friction_)),
      origin(origin_),
      heading(require_finite("heading", heading_)) {
    if (!origin.allFinite()) refuse("origin", "finite", "a coordinate that is not");
    if (elements.empty()) refuse("elements", "at least 1", 0.0);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string name = "elements[" + std::to_string(i) + "] ";
        if (!elements[i].position.allFinite())
            refuse(name + "position", "finite", "a coordinate that is not");
        require_finite((name + "heading").c_str(), elements[i].heading);
    }
}

Barrier Barrier::wall(double friction, const Vec3& origin, double heading) {
    return {{{HalfSpace{}, origin, heading}}, friction, origin, heading};
}

Barrier Barrier::pole(double friction, const Vec3& origin, double heading, double radius) {
    require_positive("radius", radius);
    const Post post{radius, std::numeric_limits<double>::infinity()};
    return {{{post, origin, heading}}, friction, origin, heading};
}

Vec3 Barrier::normal() const {
    return {-std::cos(heading), -std::sin(heading), 0.0};
}

}  // namespace birm3d
