// Pinned slabs against a dense solution, Coulomb's law corner by corner, and the size of the problem.
#include "kernels/slab_chain.hpp"

#include <Eigen/Cholesky>
#include <random>

#include "check.hpp"

using namespace birm3d;

namespace {

constexpr double pi = 3.14159265358979323846;

// Slabs end to end on a crooked line.
struct Chain {
    std::vector<PinnedSlab> slabs;
    std::vector<SlabPin> pins;
    std::vector<Vec2> along;  // from the mass centre to the far end

    void add(double mass, double half_length, double heading, double limit) {
        const double half_base = 0.3;
        const Vec2 y(-std::sin(heading), std::cos(heading)), x(y.y(), -y.x());
        const double inertia = mass / 3.0 * (half_length * half_length + half_base * half_base);
        PinnedSlab slab{mass, inertia, {}, limit};
        for (std::size_t c = 0; c < 4; ++c)
            slab.arm[c] = (c % 2 ? half_base : -half_base) * x + (c < 2 ? -half_length : half_length) * y;
        slabs.push_back(slab);
        along.push_back(half_length * y);
        if (along.size() > 1) pins.push_back({along[along.size() - 2], -along.back()});
    }
};

Chain straight(std::size_t count, double limit, double mass = 2000.0) {
    Chain row;
    for (std::size_t i = 0; i < count; ++i)
        row.add(mass, 1.5, 0.0, limit);
    return row;
}

struct Any {
    std::mt19937 source;
    double operator()(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(source);
    }
};

Chain random_row(std::size_t count, Any& any) {
    Chain row;
    double heading = any(-pi, pi);
    const double mass = std::pow(10.0, any(1.0, 4.0)), half = any(0.3, 5.0);
    for (std::size_t i = 0; i < count; ++i) {
        heading += any(-0.3, 0.3);
        row.add(mass * any(0.5, 2.0), half * any(0.7, 1.4), heading, mass * any(0.0, 0.05));
        row.slabs.back().motion = {any(-3.0, 3.0), any(-3.0, 3.0), any(-2.0, 2.0)};
    }
    return row;
}

Vec2 at(const Vec3& motion, const Vec2& arm) {
    return {motion.x() - arm.y() * motion.z(), motion.y() + arm.x() * motion.z()};
}

Vec2 pin_speed(const Chain& row, std::span<const Vec3> motions, std::size_t pin) {
    return at(motions[pin], row.pins[pin].on_first) - at(motions[pin + 1], row.pins[pin].on_next);
}

double value(const Chain& row, std::span<const Vec3> motions) {
    double sum = 0.0;
    for (std::size_t i = 0; i < row.slabs.size(); ++i) {
        const PinnedSlab& slab = row.slabs[i];
        const Vec3 away = motions[i] - slab.motion;
        sum += 0.5 * (slab.mass * away.head<2>().squaredNorm() + slab.inertia * away.z() * away.z());
        for (const Vec2& arm : slab.arm)
            sum += 0.25 * slab.limit * at(motions[i], arm).norm();
    }
    return sum;
}

// J^T of all pins, one column a direction, and the masses.
Eigen::MatrixXd pin_columns(const Chain& row) {
    const auto rows = static_cast<Eigen::Index>(3 * row.slabs.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(2 * row.pins.size()));
    for (std::size_t p = 0; p < row.pins.size(); ++p)
        for (Eigen::Index axis = 0; axis < 2; ++axis) {
            const Vec2 n = axis == 0 ? Vec2::UnitX() : Vec2::UnitY();
            const auto put = [&](std::size_t slab, const Vec2& arm, double sign) {
                columns.block<3, 1>(static_cast<Eigen::Index>(3 * slab),
                                    static_cast<Eigen::Index>(2 * p) + axis) =
                    sign * Vec3(n.x(), n.y(), arm.x() * n.y() - arm.y() * n.x());
            };
            put(p, row.pins[p].on_first, 1.0);
            put(p + 1, row.pins[p].on_next, -1.0);
        }
    return columns;
}

Eigen::VectorXd inverse_masses(const Chain& row) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(3 * row.slabs.size()));
    for (std::size_t i = 0; i < row.slabs.size(); ++i)
        result.segment<3>(static_cast<Eigen::Index>(3 * i)) =
            Vec3(1.0 / row.slabs[i].mass, 1.0 / row.slabs[i].mass, 1.0 / row.slabs[i].inertia);
    return result;
}

// With the frictions given, dense: v = v0 + W (f + J^T p), J v = 0.
std::vector<Vec3> dense(const Chain& row, std::span<const Vec3> frictions) {
    const Eigen::MatrixXd J = pin_columns(row);
    const Eigen::VectorXd W = inverse_masses(row);
    Eigen::VectorXd v(W.size());
    for (std::size_t i = 0; i < row.slabs.size(); ++i)
        v.segment<3>(static_cast<Eigen::Index>(3 * i)) = row.slabs[i].motion;
    for (std::size_t i = 0; i < row.slabs.size(); ++i) {
        const auto place = static_cast<Eigen::Index>(3 * i);
        v.segment<3>(place) += W.segment<3>(place).cwiseProduct(frictions[i]);
    }
    const Eigen::MatrixXd A = J.transpose() * W.asDiagonal() * J;
    const Eigen::VectorXd p = A.ldlt().solve(-(J.transpose() * v));
    v += W.asDiagonal() * (J * p);
    std::vector<Vec3> motions;
    for (Eigen::Index i = 0; i < v.size(); i += 3)
        motions.emplace_back(v.segment<3>(i));
    return motions;
}

// Force and moment of the corners that slide in a motion.
Vec3 law(const PinnedSlab& slab, const Vec3& motion) {
    Vec3 sum = Vec3::Zero();
    for (const Vec2& arm : slab.arm) {
        const Vec2 push = -0.25 * slab.limit * at(motion, arm).normalized();
        sum += Vec3(push.x(), push.y(), arm.x() * push.y() - arm.y() * push.x());
    }
    return sum;
}

double slowest(const PinnedSlab& slab, const Vec3& motion) {
    double least = 1e9;
    for (const Vec2& arm : slab.arm)
        least = std::min(least, at(motion, arm).norm());
    return least;
}

}  // namespace

TEST("elimination from pin to pin is the dense solution, for random chains") {
    Any any{std::mt19937(3)};
    SlabChain chain;
    for (int i = 0; i < 100; ++i) {
        const double most = i % 20 == 0 ? 180.0 : 30.0;  // blocks of slabs are crossed
        const Chain row = random_row(2 + static_cast<std::size_t>(any(0.0, most)), any);
        chain.solve(row.slabs, row.pins, 0.0);
        const std::vector<Vec3> expected = dense(row, chain.frictions());
        for (std::size_t k = 0; k < expected.size(); ++k)
            CHECK_CLOSE((chain.motions()[k] - expected[k]).norm(), 0.0, 1e-10, "rounding, of some m/s");
        for (std::size_t p = 0; p < row.pins.size(); ++p)
            CHECK_CLOSE(pin_speed(row, chain.motions(), p).norm(), 0.0, 1e-11, "rounding");
    }
}

TEST("friction is the limit against the sliding, and the motion the least of the convex function") {
    Any any{std::mt19937(5)};
    SlabChain chain;
    int sliding = 0;
    for (int i = 0; i < 100; ++i) {
        const Chain row = random_row(2 + static_cast<std::size_t>(any(0.0, 12.0)), any);
        chain.solve(row.slabs, row.pins, 0.0);
        std::vector<Vec3> found(chain.motions().begin(), chain.motions().end());
        const double least = value(row, found);
        for (std::size_t k = 0; k < found.size(); ++k) {
            const PinnedSlab& slab = row.slabs[k];
            if (slowest(slab, found[k]) < 0.01) continue;
            ++sliding;
            CHECK_CLOSE((chain.frictions()[k] - law(slab, found[k])).norm(), 0.0, 1e-6 * slab.limit,
                        "the rounding off: 1e-6 of what friction can take, over 0.01 m/s");
        }
        // Along all that the pins allow it grows.
        for (int j = 0; j < 20; ++j) {
            Chain other = row;
            const double size = std::pow(10.0, any(-6.0, -1.0));
            std::vector<Vec3> none(row.slabs.size(), Vec3::Zero());
            for (std::size_t k = 0; k < found.size(); ++k)
                other.slabs[k].motion =
                    found[k] + size * Vec3(any(-1.0, 1.0), any(-1.0, 1.0), any(-1.0, 1.0));
            double full = 0.0;
            for (const PinnedSlab& slab : row.slabs)
                full += slab.limit * slab.limit / slab.mass;
            CHECK(value(row, dense(other, none)) >= least - 1e-5 * full);
        }
    }
    CHECK(sliding > 300);
}

TEST("a guess changes nothing but the cost") {
    Any any{std::mt19937(6)};
    SlabChain chain, again;
    for (int i = 0; i < 50; ++i) {
        Chain row = random_row(12, any);
        chain.solve(row.slabs, row.pins, 0.0);
        for (std::size_t k = 0; k < row.slabs.size(); ++k)
            row.slabs[k].guess = chain.motions()[k];
        again.solve(row.slabs, row.pins, 0.0);
        for (std::size_t k = 0; k < row.slabs.size(); ++k)
            CHECK_CLOSE((chain.motions()[k] - again.motions()[k]).norm(), 0.0, 1e-9, "of some m/s");
        CHECK(again.work() <= chain.work());
    }
}

TEST("a row that slides as one loses the limit of each") {
    Chain row = straight(4, 300.0);
    for (PinnedSlab& slab : row.slabs)
        slab.motion = {3.0, -4.0, 0.0};
    SlabChain chain;
    chain.solve(row.slabs, row.pins, 0.0);
    for (const Vec3& friction : chain.frictions())
        CHECK_CLOSE((friction - 300.0 * Vec3(-0.6, 0.8, 0.0)).norm(), 0.0, 1e-9 * 300.0, "rounding");
}

TEST("what friction can hold rests: one slab alone where it can, as many as it takes where it can not") {
    SlabChain chain;
    for (const double push : {80.0, 250.0}) {
        Chain row = straight(7, 100.0);
        row.slabs[2].motion = {0.0, push / 2000.0, 0.0};
        chain.solve(row.slabs, row.pins, 0.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < 7; ++i) {
            const Vec3& friction = chain.frictions()[i];
            CHECK(std::abs(friction.y()) <= 100.0 * (1.0 + 1e-6));
            CHECK_CLOSE(friction.x(), 0.0, 1e-6, "it pulls along the row");
            CHECK_CLOSE(friction.z(), 0.0, 1e-6, "the same");
            CHECK_CLOSE(chain.motions()[i].norm(), 0.0, 1e-4 * 100.0 / 2000.0, "as bring_to_rest() has it");
            sum += friction.y();
        }
        CHECK_CLOSE(sum, -push, 1e-5 * push, "all of the push is held, to the rounding off");
    }
}

TEST("a row that is pushed aside bends at its pins: the slab that is pushed slides, its ends drag the next") {
    Chain row = straight(7, 100.0);
    row.slabs[3].motion = {1.0, 0.0, 0.0};
    SlabChain chain;
    chain.solve(row.slabs, row.pins, 0.0);
    const std::span<const Vec3> friction = chain.frictions();
    CHECK_CLOSE(friction[3].x(), -100.0, 1e-6 * 100.0, "full, against the push");
    CHECK(friction[2].head<2>().norm() <= 100.0 * (1.0 + 1e-9));
    CHECK(friction[2].z() * friction[4].z() < 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK_CLOSE(friction[i].x(), friction[6 - i].x(), 1e-6 * 100.0, "left and right");
        CHECK_CLOSE(friction[i].y(), -friction[6 - i].y(), 1e-6 * 100.0, "left and right");
        CHECK_CLOSE(friction[i].z(), -friction[6 - i].z(), 1e-6 * 100.0, "left and right");
    }
}

TEST("without friction a row has none, and momentum stays") {
    Chain row = straight(5, 0.0);
    row.slabs[1].motion = {1.0, 2.0, 0.3};
    SlabChain chain;
    chain.solve(row.slabs, row.pins, 0.0);
    Vec2 momentum = Vec2::Zero();
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(chain.frictions()[i].isZero(0.0));
        momentum += 2000.0 * chain.motions()[i].head<2>();
    }
    CHECK_CLOSE((momentum - Vec2(2000.0, 4000.0)).norm(), 0.0, 1e-9, "rounding");
}

TEST("pins are closed after the drift, gaps that were there too") {
    Any any{std::mt19937(9)};
    SlabChain chain;
    for (int i = 0; i < 50; ++i) {
        Chain row = random_row(8, any);
        for (SlabPin& pin : row.pins)
            pin.gap = 1e-5 * Vec2(any(-1.0, 1.0), any(-1.0, 1.0));
        const double dt = any(1e-4, 5e-3);
        chain.solve(row.slabs, row.pins, dt);
        for (std::size_t p = 0; p < row.pins.size(); ++p) {
            const auto moved = [&](std::size_t slab, const Vec2& arm) {
                const Vec3& motion = chain.motions()[slab];
                const double angle = 2.0 * std::atan(0.5 * dt * motion.z());  // of the Cayley map
                return Vec2(dt * motion.head<2>() + Eigen::Rotation2Dd(angle) * arm - arm);
            };
            const Vec2 gap =
                row.pins[p].gap + moved(p, row.pins[p].on_first) - moved(p + 1, row.pins[p].on_next);
            CHECK_CLOSE(gap.norm(), 0.0, 1e-11, "m");
        }
    }
}

TEST("the cost grows with the slabs that move, not with those that rest") {
    SlabChain chain;
    std::vector<std::size_t> work;
    for (const std::size_t count : {20, 40, 80, 1000}) {
        Chain row = straight(count, 100.0);
        row.slabs[count / 2].motion = {0.5, 0.1, 0.0};
        chain.solve(row.slabs, row.pins, 0.0);
        work.push_back(chain.work());
        CHECK(chain.work() < 20 * 60);
    }
    CHECK(work[1] == work[2]);
    CHECK(work[2] == work[3]);
    Chain still = straight(50, 100.0);
    chain.solve(still.slabs, still.pins, 1e-3);
    CHECK(chain.work() == 0);
}
