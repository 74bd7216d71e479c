#include "kernels/ground_slide.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace birm3d {

namespace {

using Vec2 = Eigen::Vector2d;
using Jacobian = Eigen::Matrix<double, 2, 3>;

// The minimum problem in q = (v_x, v_y, k w) with k the radius of gyration, per mass; |u| is rounded off to
// sqrt(|u|^2 + soft^2).
struct Slide {
    Vec3 start;
    std::array<Jacobian, 4> corner;
    double limit;  // of one corner (m/s)

    static double rounded(const Vec2& u, double soft) { return std::sqrt(u.squaredNorm() + soft * soft); }
    double fastest(const Vec3& q) const {
        double most = 0.0;
        for (const Jacobian& J : corner)
            most = std::max(most, (J * q).norm());
        return most;
    }
    double slowest(const Vec3& q) const {
        double least = (corner[0] * q).norm();
        for (const Jacobian& J : corner)
            least = std::min(least, (J * q).norm());
        return least;
    }
    double value(const Vec3& q, double soft) const {
        double sum = 0.5 * (q - start).squaredNorm();
        for (const Jacobian& J : corner)
            sum += limit * rounded(J * q, soft);
        return sum;
    }
    // Newton's step from q.
    Vec3 step(const Vec3& q, double soft) const {
        Vec3 gradient = q - start;
        Mat3 curvature = Mat3::Identity();
        for (const Jacobian& J : corner) {
            const Vec2 u = J * q;
            const double size = rounded(u, soft);
            const Vec2 n = u / size;
            gradient += limit * (J.transpose() * n);
            curvature +=
                limit / size * (J.transpose() * (Eigen::Matrix2d::Identity() - n * n.transpose()) * J);
        }
        return -curvature.llt().solve(gradient);
    }
};

// Newton's method with halved steps where they overshoot.
Vec3 minimum(const Slide& slide, double soft, Vec3 q) {
    constexpr int most_steps = 50, most_halvings = 30;
    const double rounding = 1e-15 * slide.start.norm();
    for (int i = 0; i < most_steps; ++i) {
        Vec3 step = slide.step(q, soft);
        const double now = slide.value(q, soft);
        for (int k = 0; k < most_halvings && slide.value(q + step, soft) > now; ++k)
            step *= 0.5;
        q += step;
        if (step.norm() <= rounding) break;
    }
    return q;
}

// Can the corners hold the slab at rest if each takes an equal part of force and moment? If not, another distribution
// may hold it, which the minimum finds.
bool can_be_at_rest(const RigidBody& body, const std::array<Vec3, 4>& arm, double limit, const Vec3& v,
                    double spin) {
    double square = 0.0;
    for (const Vec3& r : arm)
        square += r.x() * r.x() + r.y() * r.y();
    const double per_radius = body.inertia(2, 2) * spin / square;
    return std::all_of(arm.begin(), arm.end(), [&](const Vec3& r) {
        const Vec3 impulse = 0.25 * body.mass * v + per_radius * Vec3(-r.y(), r.x(), 0.0);
        return impulse.squaredNorm() <= limit * limit;
    });
}

}  // namespace

Wrench slide_friction(const RigidBody& body, const std::array<Vec3, 4>& arm, double limit,
                      const Twist& motion) {
    const Vec3 v(motion.velocity.x(), motion.velocity.y(), 0.0);
    const double spin = motion.angular_velocity.z(), inertia = body.inertia(2, 2);
    const double reach = limit * body.inverse_mass;  // speed that it can take (m/s)
    if (!(reach > 0.0) || (v.isZero(0.0) && spin == 0.0)) return {};
    if (spin == 0.0) {
        // If all corners slide with the same velocity, friction causes no rotation.
        const double fraction = std::min(1.0, reach / v.norm());
        return {-fraction * body.mass * v, Vec3::Zero()};
    }
    if (can_be_at_rest(body, arm, 0.25 * limit, v, spin))
        return {-body.mass * v, Vec3(0.0, 0.0, -inertia * spin)};
    const double gyration = std::sqrt(inertia * body.inverse_mass);
    Slide slide{{v.x(), v.y(), gyration * spin}, {}, 0.25 * reach};
    for (std::size_t i = 0; i < arm.size(); ++i)
        slide.corner[i] << 1.0, 0.0, -arm[i].y() / gyration, 0.0, 1.0, arm[i].x() / gyration;
    // If corners nearly stop, the regularisation is reduced step by step.
    constexpr double softest = 0.1, hardest = 1e-6, far = 10.0, at_rest = 1e-4;
    Vec3 q = slide.start;
    const bool far_from_rest = slide.slowest(q) > far * reach;
    for (double soft = far_from_rest ? hardest : softest; soft > 0.5 * hardest; soft *= 0.1)
        q = minimum(slide, soft * reach, q);
    if (slide.fastest(q) <= at_rest * reach) q.setZero();
    return {body.mass * Vec3(q.x() - v.x(), q.y() - v.y(), 0.0),
            Vec3(0.0, 0.0, inertia * (q.z() / gyration - spin))};
}

}  // namespace birm3d
