// Laws of a signed distance, checked at random points.
#pragma once

#include "check.hpp"
#include "geometry/random_points.hpp"

namespace laboratory {

// Largest difference between the normal and the gradient of the gap (central differences over `h`), at points
// whose neighbours at +-h share the point's nearest smooth part: elsewhere the gap has a bend. Counts the rest.
struct GradientCheck {
    double worst = 0.0;
    int checked = 0, skipped = 0;
};

template <class Gap>
void check_distance_laws(const Gap& nearest, const birm3d::Vec3& low, const birm3d::Vec3& high, double size,
                         int count, unsigned seed) {
    using birm3d::Nearest;
    using birm3d::Vec3;
    Random random(seed);
    GradientCheck gradient;
    double steepest = 0.0, off_surface = 0.0, not_unit = 0.0;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = random.point(low, high), direction = random.direction();
        const Vec3 q = p + random.within(0.0, 0.2) * direction;
        const Nearest at_p = nearest(p), at_q = nearest(q);
        not_unit = std::max(not_unit, std::abs(at_p.normal.norm() - 1.0));
        steepest = std::max(steepest, std::abs(at_p.gap - at_q.gap) - (p - q).norm());
        off_surface = std::max(off_surface, std::abs(nearest(p - at_p.gap * at_p.normal).gap));
        const double h = 1e-5;
        // Third derivatives of a distance are below 3 / |gap|^2.
        const double scale = std::min(std::abs(at_p.gap), 0.01), third_order = h * h / (scale * scale);
        Vec3 slope;
        bool bent = std::abs(at_p.gap) < 3.0 * h;
        for (int k = 0; k < 3; ++k) {
            const Nearest up = nearest(p + h * Vec3::Unit(k)), down = nearest(p - h * Vec3::Unit(k));
            slope[k] = (up.gap - down.gap) / (2.0 * h);
            // Around a rim of radius r > 0.01 m, and r >= |gap|, normals turn by less than 2 h / |gap|.
            const double turn = 2.0 * h / scale;
            bent =
                bent || (up.normal - at_p.normal).norm() > turn || (down.normal - at_p.normal).norm() > turn;
            // Between a face and its edge normals have no jump, but begin to turn.
            const Vec3 second_difference = up.normal - 2.0 * at_p.normal + down.normal;
            bent = bent || second_difference.norm() > 1e-9 + 3.0 * third_order;
        }
        if (bent) {
            ++gradient.skipped;
            continue;
        }
        ++gradient.checked;
        gradient.worst = std::max(gradient.worst, (slope - at_p.normal).norm() / (1e-9 + third_order));
    }
    CHECK_CLOSE(not_unit, 0.0, 1e-14, "rounding");
    CHECK(steepest <= 1e-13 * size);
    CHECK_CLOSE(off_surface, 0.0, 1e-12 * size, "rounding; the foot of the normal lies on the surface");
    CHECK(gradient.worst < 3.0);
    CHECK(gradient.checked > 9 * gradient.skipped);
}

}  // namespace laboratory
