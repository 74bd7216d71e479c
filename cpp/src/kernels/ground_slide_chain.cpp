#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "birm3d/kernels/ground_slide.hpp"

namespace birm3d {

namespace {

using Vec2 = Eigen::Vector2d;
using Jacobian = Eigen::Matrix<double, 2, 3>;
using Motions = std::vector<Vec3>;

// One slab in q = (v_x, v_y, k w), k its radius of gyration.
struct Part {
    double mass = 0.0, gyration = 0.0, limit = 0.0;  // limit of one corner (N s)
    Vec3 start = Vec3::Zero();
    std::array<Jacobian, 4> corner;

    double reach() const { return 4.0 * limit / mass; }  // speed that friction can take (m/s)
};

struct Row {
    std::size_t a, b;
    Vec3 of_a, of_b;
    double target;

    double velocity(const Motions& q) const { return of_a.dot(q[a]) + of_b.dot(q[b]); }
};

double rounded(const Vec2& u, double soft) {
    return std::sqrt(u.squaredNorm() + soft * soft);
}

// The convex function of ground_slide.hpp for all slabs, |u| rounded off by `soft` times what friction can take; with
// `rubs` false without friction.
class Chain {
  public:
    Chain(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins) {
        for (const PinnedSlab& slab : slabs) {
            const RigidBody& body = *slab.body;
            const double k = std::sqrt(body.inertia(2, 2) * body.inverse_mass);
            const Vec3& v = slab.motion.velocity;
            Part& part = parts_.emplace_back();
            part.mass = body.mass, part.gyration = k, part.limit = 0.25 * slab.limit;
            part.start = {v.x(), v.y(), k * slab.motion.angular_velocity.z()};
            for (std::size_t c = 0; c < slab.arm.size(); ++c)
                part.corner[c] << 1.0, 0.0, -slab.arm[c].y() / k, 0.0, 1.0, slab.arm[c].x() / k;
        }
        for (const SlabPin& pin : pins) {
            const auto scaled_to = [&](const Vec3& unit, std::size_t part) {
                return Vec3(unit.x(), unit.y(), unit.z() / parts_[part].gyration);
            };
            rows_.push_back({pin.body, pin.other, scaled_to(pin.on_body, pin.body),
                             scaled_to(pin.on_other, pin.other), pin.target});
        }
        inverse_.resize(parts_.size());
        way_.resize(parts_.size());
    }

    // Nearest motion to the start that the pins allow.
    Motions pinned() {
        Motions q;
        for (const Part& part : parts_)
            q.push_back(part.start);
        find_way(q, 0.0, false);
        for (std::size_t i = 0; i < q.size(); ++i)
            q[i] += way_[i];
        return q;
    }

    // Newton's method with halved steps where they overshoot; the first goes all the way, so that the pins hold. Did
    // it arrive?
    bool minimise(double soft, int most_steps, Motions& q) {
        constexpr int most_halvings = 30;
        constexpr double rounding = 1e-13;
        double size = 0.0;
        for (const Part& part : parts_)
            size = std::max(size, part.start.norm());
        Motions next(q.size());
        for (int i = 0; i < most_steps; ++i) {
            find_way(q, soft, true);
            const double now = value(q, soft);
            double share = 1.0, longest = 0.0;
            for (int k = 0; k < most_halvings; ++k, share *= 0.5) {
                longest = 0.0;
                for (std::size_t p = 0; p < q.size(); ++p) {
                    next[p] = q[p] + share * way_[p];
                    longest = std::max(longest, share * way_[p].norm());
                }
                if (i == 0 || value(next, soft) <= now) break;
            }
            q = next;
            if (longest <= rounding * size) return true;
        }
        return false;
    }

    Motions guess(std::span<const PinnedSlab> slabs) const {
        Motions q;
        for (std::size_t i = 0; i < slabs.size(); ++i) {
            const Twist& motion = slabs[i].guess;
            q.emplace_back(motion.velocity.x(), motion.velocity.y(),
                           parts_[i].gyration * motion.angular_velocity.z());
        }
        return q;
    }

    // Do all corners slide so fast that the rounding off does not matter?
    bool slides_fast(const Motions& q) const {
        constexpr double far = 10.0;
        for (std::size_t i = 0; i < q.size(); ++i)
            for (const Jacobian& J : parts_[i].corner)
                if (parts_[i].limit > 0.0 && (J * q[i]).norm() < far * parts_[i].reach()) return false;
        return true;
    }

    // Force and torque of the corners' impulses.
    std::vector<Wrench> frictions(const Motions& q, double soft) const {
        std::vector<Wrench> result;
        for (std::size_t i = 0; i < q.size(); ++i) {
            const Part& part = parts_[i];
            Vec3 push = Vec3::Zero();
            if (part.limit > 0.0)
                for (const Jacobian& J : part.corner)
                    push -=
                        part.limit * (J.transpose() * (J * q[i] / rounded(J * q[i], soft * part.reach())));
            result.push_back({Vec3(push.x(), push.y(), 0.0), Vec3(0.0, 0.0, part.gyration * push.z())});
        }
        return result;
    }

  private:
    double value(const Motions& q, double soft) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < q.size(); ++i) {
            const Part& part = parts_[i];
            sum += 0.5 * part.mass * (q[i] - part.start).squaredNorm();
            if (part.limit > 0.0)
                for (const Jacobian& J : part.corner)
                    sum += part.limit * rounded(J * q[i], soft * part.reach());
        }
        return sum;
    }

    // Newton's step: H way + J^T l = -gradient, J way = target - J q, through the multipliers l.
    void find_way(const Motions& q, double soft, bool rubs) {
        for (std::size_t i = 0; i < q.size(); ++i) {
            const Part& part = parts_[i];
            Vec3 gradient = part.mass * (q[i] - part.start);
            Mat3 curvature = part.mass * Mat3::Identity();
            if (rubs && part.limit > 0.0)
                for (const Jacobian& J : part.corner) {
                    const Vec2 u = J * q[i];
                    const double size = rounded(u, soft * part.reach());
                    const Vec2 n = u / size;
                    gradient += part.limit * (J.transpose() * n);
                    curvature += part.limit / size *
                                 (J.transpose() * (Eigen::Matrix2d::Identity() - n * n.transpose()) * J);
                }
            inverse_[i] = curvature.llt().solve(Mat3::Identity());
            way_[i] = -inverse_[i] * gradient;
        }
        const auto rows = static_cast<Eigen::Index>(rows_.size());
        Eigen::MatrixXd system = Eigen::MatrixXd::Zero(rows, rows);
        Eigen::VectorXd lack(rows);
        for (Eigen::Index r = 0; r < rows; ++r) {
            const Row& row = rows_[static_cast<std::size_t>(r)];
            lack[r] = row.target - row.velocity(q) - row.velocity(way_);
            const Vec3 a = inverse_[row.a] * row.of_a, b = inverse_[row.b] * row.of_b;
            for (Eigen::Index c = 0; c <= r; ++c) {
                const Row& other = rows_[static_cast<std::size_t>(c)];
                if (other.a == row.a) system(r, c) += a.dot(other.of_a);
                if (other.b == row.a) system(r, c) += a.dot(other.of_b);
                if (other.a == row.b) system(r, c) += b.dot(other.of_a);
                if (other.b == row.b) system(r, c) += b.dot(other.of_b);
            }
        }
        const Eigen::VectorXd pulls = system.llt().solve(lack);
        for (Eigen::Index r = 0; r < rows; ++r) {
            const Row& row = rows_[static_cast<std::size_t>(r)];
            way_[row.a] += pulls[r] * (inverse_[row.a] * row.of_a);
            way_[row.b] += pulls[r] * (inverse_[row.b] * row.of_b);
        }
    }

    std::vector<Part> parts_;
    std::vector<Row> rows_;
    std::vector<Mat3> inverse_;
    Motions way_;
};

}  // namespace

std::vector<Wrench> slide_friction(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins,
                                   bool guessed) {
    // Where corners nearly stop, the rounding is taken away step by step, unless a good guess does without.
    constexpr double softest = 0.1, hardest = 1e-6;
    constexpr int most_from_guess = 12, most_steps = 50;
    Chain chain(slabs, pins);
    Motions q = chain.guess(slabs);
    if (!guessed || !chain.minimise(hardest, most_from_guess, q)) {
        q = chain.pinned();
        for (double soft = chain.slides_fast(q) ? hardest : softest; soft > 0.5 * hardest; soft *= 0.1)
            chain.minimise(soft, most_steps, q);
    }
    return chain.frictions(q, hardest);
}

}  // namespace birm3d
