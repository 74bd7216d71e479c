#include "birm3d/geometry/shape.hpp"

namespace birm3d {

namespace {

Nearest nearest_in(const HalfSpace& plane, const Vec3& p) {
    return {plane.gap(p), plane.normal};
}
Nearest nearest_in(const Post& post, const Vec3& p) {
    return nearest(post, p);
}
Nearest nearest_in(const Prism& prism, const Vec3& p) {
    return prism.nearest(p);
}
Nearest nearest_in(const TriangleMesh& mesh, const Vec3& p) {
    return mesh.nearest(p);
}

Box bounds_of(const HalfSpace& plane) {
    return {plane.offset * plane.normal, Vec3::Constant(infinity)};
}
Box bounds_of(const Post& post) {
    // Endless downwards.
    return {Vec3::Zero(), {post.radius, post.radius, infinity}};
}
Box bounds_of(const Prism& prism) {
    return prism.bounds();
}
Box bounds_of(const TriangleMesh& mesh) {
    return mesh.bounds();
}

double thickness_of(const HalfSpace&) {
    return infinity;
}
double thickness_of(const Post& post) {
    return post.opens ? infinity : 2.0 * post.radius;
}
double thickness_of(const Prism& prism) {
    return prism.thickness();
}
double thickness_of(const TriangleMesh& mesh) {
    return mesh.thickness();
}

}  // namespace

Nearest nearest(const Shape& shape, const Vec3& p) {
    return std::visit([&](const auto& s) { return nearest_in(s, p); }, shape);
}

Box bounds(const Shape& shape) {
    return std::visit([](const auto& s) { return bounds_of(s); }, shape);
}

double thickness(const Shape& shape) {
    return std::visit([](const auto& s) { return thickness_of(s); }, shape);
}

}  // namespace birm3d
