#include <algorithm>
#include <cmath>

#include "birm3d/kernels/detect.hpp"

namespace birm3d {

namespace {

// Least distance between two boxes of the same axes (m); 0 if they overlap. Halves may be infinite.
double distance(const Box& a, const Box& b) {
    return ((a.center - b.center).cwiseAbs() - a.half - b.half).cwiseMax(0.0).norm();
}

struct Reach {
    Box box;        // own axes, around the turned box of the body's axes
    double radius;  // half its diagonal (m)
    double margin;

    bool too_far(double least_distance) const { return least_distance > 0.0 && least_distance >= margin; }

    bool operator()(const HalfSpace& plane) const { return plane.within_reach(box, margin); }
    bool operator()(const Post& post) const {
        // Most are out of reach of the ball around the box.
        const double far = post.radius + margin + radius;
        if (box.center.head<2>().squaredNorm() > far * far) return false;
        const double dx = std::max(std::abs(box.center.x()) - box.half.x(), 0.0);
        const double dy = std::max(std::abs(box.center.y()) - box.half.y(), 0.0);
        const double side = std::max(std::sqrt(dx * dx + dy * dy) - post.radius, 0.0);
        const double top = std::max(box.center.z() - box.half.z() - post.height, 0.0);
        return !too_far(std::sqrt(side * side + top * top));
    }
    bool operator()(const Prism& prism) const {
        return !too_far(distance(prism.bounds(), box)) && !too_far(prism.no_nearer(box));
    }
    bool operator()(const TriangleMesh& mesh) const {
        // Behind an open mesh a point is inside wherever its nearest point is not on the rim: no bounds.
        return !mesh.closed() ||
               (!too_far(distance(mesh.bounds(), box)) && !too_far(mesh.nearest(box.center).gap - radius));
    }
};

}  // namespace

bool within_reach(const Shape& shape, const Placement& now, const Box& box, double margin) {
    // The turned box itself is narrower than the box around it.
    if (const auto* plane = std::get_if<HalfSpace>(&shape))
        return now.plane_from_own(*plane).within_reach(box, margin);
    const Vec3 center = now.to_own(box.center);
    const double radius = box.half.norm();
    return std::visit(Reach{{center, now.rotation.cwiseAbs() * box.half}, radius, margin}, shape);
}

}  // namespace birm3d
