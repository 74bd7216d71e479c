// The surfaces that a barrier can have; each has gap, normal_at, within_reach and seen_from.
#pragma once

#include <variant>

#include "birm3d/geometry/cylinder.hpp"
#include "birm3d/geometry/half_space.hpp"

namespace birm3d {

using Surface = std::variant<HalfSpace, Cylinder>;

inline double gap(const Surface& surface, const Vec3& p) {
    return std::visit([&](const auto& shape) { return shape.gap(p); }, surface);
}

inline Vec3 normal_at(const Surface& surface, const Vec3& p) {
    return std::visit([&](const auto& shape) -> Vec3 { return shape.normal_at(p); }, surface);
}

inline bool within_reach(const Surface& surface, const Box& box, double margin) {
    return std::visit([&](const auto& shape) { return shape.within_reach(box, margin); }, surface);
}

inline Surface seen_from(const Surface& surface, const Vec3& position, const Mat3& rotation) {
    return std::visit([&](const auto& shape) -> Surface { return shape.seen_from(position, rotation); },
                      surface);
}

}  // namespace birm3d
