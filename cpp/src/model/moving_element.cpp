#include "birm3d/model/moving_element.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/base/error.hpp"
#include "geometry/prism_nearest.hpp"

namespace birm3d {

namespace {

// Integrals over the part of a profile above z = 0 of 1, x, z, x^2, z^2.
struct Section {
    double area = 0.0, x = 0.0, z = 0.0, xx = 0.0, zz = 0.0;
    double toe_low = infinity,
           toe_high = -toe_low;  // of its base, along x (m)
};

// By Green's theorem the integral of f(z) x^n over an area is that of f(z) x^(n+1)/(n+1) dz around it; the chord along
// z = 0 adds nothing. Simpson's rule is exact for the cubics that come of straight edges.
void add_edge(const PrismEdge& edge, Section& sum) {
    double low = edge.low, high = edge.high;
    if (edge.tz != 0.0) {
        const double at_ground = -edge.z / edge.tz;
        if (edge.tz > 0.0)
            low = std::max(low, at_ground);
        else
            high = std::min(high, at_ground);
    } else if (edge.z < 0.0) {
        return;
    }
    if (!(low < high)) return;
    const auto x = [&](double u) { return edge.x + u * edge.tx; };
    const auto z = [&](double u) { return edge.z + u * edge.tz; };
    const auto integral = [&](auto f) {
        const double middle = 0.5 * (low + high);
        return (high - low) * edge.tz / 6.0 *
               (f(x(low), z(low)) + 4.0 * f(x(middle), z(middle)) + f(x(high), z(high)));
    };
    sum.area += integral([](double a, double) { return a; });
    sum.x += integral([](double a, double) { return a * a / 2.0; });
    sum.z += integral([](double a, double b) { return a * b; });
    sum.xx += integral([](double a, double) { return a * a * a / 3.0; });
    sum.zz += integral([](double a, double b) { return a * b * b; });
    constexpr double rounding = 1e-12;  // m
    for (const double u : {low, high})
        if (std::abs(z(u)) < rounding)
            sum.toe_low = std::min(sum.toe_low, x(u)), sum.toe_high = std::max(sum.toe_high, x(u));
}

}  // namespace

MovingElement segment_of(const Prism& prism, double density) {
    require_positive("density", density);
    const double length = prism.y_high() - prism.y_low();
    if (!std::isfinite(length)) refuse("length of a free-standing segment", "finite", length);
    Section section;
    for (const auto* edges : {&prism.edges(), &prism.covered_edges()})
        for (const PrismEdge& edge : *edges)
            add_edge(edge, section);
    if (!std::isfinite(section.area)) refuse("height of a free-standing segment", "finite", section.area);
    if (!(section.area > 0.0 && section.toe_low < 0.0 && section.toe_high > 0.0))
        refuse("base of a free-standing segment", "on the ground, with a section above it of > 0 m^2",
               section.area);
    const double x = section.x / section.area, z = section.z / section.area;
    const double aside = std::hypot(x, 0.5 * (prism.y_low() + prism.y_high()));
    constexpr double centred = 1e-9;  // m
    if (!(aside <= centred))
        refuse("distance of a free-standing segment's mass centre from the line above its origin",
               "<= 1e-9 m", aside);

    const double mass = density * section.area * length, along = length * length / 12.0;
    const double across = section.xx / section.area - x * x, up = section.zz / section.area - z * z;
    const double y = 0.5 * length, base = std::min(-section.toe_low, section.toe_high);
    return {
        RigidBody(mass, mass * Vec3(along + up, across + up, along + across).asDiagonal().toDenseMatrix()),
        z,
        Vec3(base, y, 0.0).norm(),
        y,
        base,
        {Vec3(-base, -y, -z), Vec3(base, -y, -z), Vec3(-base, y, -z), Vec3(base, y, -z)}};
}

MovingElement tilting_post(const Post& post, const YieldingPosts& posts, double depth) {
    require_positive("mass of a post that yields", posts.mass);
    require_positive("inertia of a post that yields", posts.inertia);
    require_positive("plastic_moment of a post that yields", posts.plastic_moment);
    require_finite("height of a post that yields", post.height);
    // Equal about all axes. That about its own is never used.
    RigidBody body(posts.mass, posts.inertia * Mat3::Identity());
    body.inverse_mass = 0.0;
    // Further down the vehicle would meet the post's endless lower end, which rises from the ground.
    constexpr double lying = 1.4;
    const double lying_tilt = depth > 0.0 ? std::min(lying, std::acos(depth / post.height)) : lying;
    return {body, 0.0, post.height, post.radius, post.radius, {}, posts.plastic_moment, lying_tilt};
}

}  // namespace birm3d
