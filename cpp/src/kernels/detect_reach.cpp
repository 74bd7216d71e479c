#include <algorithm>
#include <cmath>

#include "kernels/detect.hpp"

namespace birm3d {

namespace {

// Least distance between two boxes of the same axes (m); 0 if they overlap. Halves may be infinite.
double distance(const Box& a, const Box& b) {
    return ((a.center - b.center).cwiseAbs() - a.half - b.half).cwiseMax(0.0).norm();
}

// Is a distance above the margin? A distance of zero means overlap (m).
bool too_far(double least_distance, double margin) {
    return least_distance > 0.0 && least_distance >= margin;
}

// The box around a turned box.
Box rotated(const Placement& now, const Box& box) {
    return {now.to_own(box.center), now.rotation.cwiseAbs() * box.half};
}

bool reaches(const HalfSpace& plane, const Placement& now, const Box& box, double margin) {
    // The turned box itself is narrower than the box around it.
    return now.plane_from_own(plane).within_reach(box, margin);
}

bool reaches(const Post& post, const Placement& now, const Box& box, double margin) {
    // Most are out of reach of the ball around the box.
    const double far = post.radius + margin + box.half.norm();
    const Vec3 center = now.to_own(box.center);
    if (center.head<2>().squaredNorm() > far * far) return false;
    const Vec3 half = now.rotation.cwiseAbs() * box.half;
    const double dx = std::max(std::abs(center.x()) - half.x(), 0.0);
    const double dy = std::max(std::abs(center.y()) - half.y(), 0.0);
    const double side = std::max(std::sqrt(dx * dx + dy * dy) - post.radius, 0.0);
    const double top = std::max(center.z() - half.z() - post.height, 0.0);
    return !too_far(std::sqrt(side * side + top * top), margin);
}

bool reaches(const Prism& prism, const Placement& now, const Box& box, double margin) {
    const Box own = rotated(now, box);
    return !too_far(distance(prism.bounds(), own), margin) && !too_far(prism.no_nearer(own), margin);
}

bool reaches(const TriangleMesh& mesh, const Placement& now, const Box& box, double margin) {
    // The inside of an open mesh has no bounds: it is wherever the nearest point is not on the rim.
    if (!mesh.closed()) return true;
    const Box own = rotated(now, box);
    return !too_far(distance(mesh.bounds(), own), margin) &&
           !too_far(mesh.nearest(own.center).gap - box.half.norm(), margin);
}

}  // namespace

bool within_reach(const Shape& shape, const Placement& now, const Box& box, double margin) {
    return std::visit([&](const auto& of_kind) { return reaches(of_kind, now, box, margin); }, shape);
}

}  // namespace birm3d
