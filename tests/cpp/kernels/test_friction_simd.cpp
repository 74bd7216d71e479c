#include "birm3d/state/contacts.hpp"
#include "check.hpp"
#include "kernels/random_columns.hpp"
#include "kernels/simd_table.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;

namespace {

struct Found {
    FrictionSums friction{};
    ResistanceSums resistance{};
    Moments moments{};
    BlockColumn q{};
};

}  // namespace

TEST("every instruction set finds the same friction, and rows without normal force add nothing") {
    laboratory::Random random(1);
    const std::vector<SimdPath> functions = simd_paths();
    for (int round = 0; round < 50; ++round) {
        alignas(64) BlockColumn x, y, z, normal_force;
        BlockContact contact;
        fill(random, x, 2.5, 0.5), fill(random, y, 0.0, 1.0), fill(random, z, 0.0, 0.7);
        fill(random, normal_force, 0.0, 1e4);
        for (std::size_t i = 0; i < block_size; ++i) {
            normal_force[i] = i / 8 % 3 == 0 ? 0.0 : std::max(normal_force[i], 0.0);
            const double nz = 0.4 * random.within(-1.0, 1.0), ny = 0.4 * random.within(-1.0, 1.0);
            const Vec3 n = Vec3(-1.0, ny, nz).normalized();
            contact.nx[i] = n.x(), contact.ny[i] = n.y(), contact.nz[i] = n.z();
        }
        // Some nodes slide slowly, others fast.
        const Vec3 v(0.0, 0.05, 0.02), w(0.3 * random.within(-1.0, 1.0), 0.05, 0.1);
        const double mu = 0.3, full_speed = 0.01;
        const SlidingNodes nodes{x.data(),          y.data(),          z.data(),           contact.nx.data(),
                                 contact.ny.data(), contact.nz.data(), normal_force.data()};
        Found first;
        for (std::size_t k = 0; k < functions.size(); ++k) {
            Found found;
            found.friction = functions[k].find_friction(
                {mu, full_speed, v.x(), v.y(), v.z(), w.x(), w.y(), w.z()}, nodes, found.q.data());
            found.resistance = functions[k].find_resistance(found.q.data(), nodes);
            found.moments = functions[k].find_moments(found.q.data(), nodes);
            if (k == 0) first = found;
            CHECK(same_bits(found.q, first.q));
            CHECK(found.friction.fx == first.friction.fx && found.friction.fy == first.friction.fy);
            CHECK(found.friction.tx == first.friction.tx && found.friction.tz == first.friction.tz);
            CHECK(found.friction.slow == first.friction.slow);
            CHECK(same_bits(found.resistance, first.resistance));
            CHECK(same_bits(found.moments, first.moments));
        }
        // Node by node.
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        double q = 0.0;
        Mat3 sum = Mat3::Zero();
        for (std::size_t i = 0; i < block_size; ++i) {
            const Vec3 r(x[i], y[i], z[i]), n = contact.normal(i), u = v + w.cross(r);
            const Vec3 sliding = u - u.dot(n) * n;
            const double per_speed = mu * normal_force[i] / std::max(sliding.norm(), full_speed);
            force -= per_speed * sliding;
            torque -= r.cross(per_speed * sliding);
            const double slow = first.q[i];
            CHECK_CLOSE(slow, slow > 0.0 ? per_speed : 0.0, 1e-12 * per_speed, "rounding");
            q += slow;
            sum += slow * (Mat3::Identity() - n * n.transpose());
        }
        const FrictionSums& by = first.friction;
        CHECK_CLOSE((Vec3(by.fx, by.fy, by.fz) - force).norm(), 0.0, 1e-12 * force.norm(), "of 64 terms");
        CHECK_CLOSE((Vec3(by.tx, by.ty, by.tz) - torque).norm(), 0.0, 1e-12 * torque.norm() + 1e-9,
                    "the same");
        CHECK_CLOSE(first.moments.q, q, 1e-12 * q, "the same");
        CHECK_CLOSE(first.resistance.xx, sum(0, 0), 1e-12 * q, "the same");
        CHECK_CLOSE(first.resistance.yz, sum(1, 2), 1e-12 * q, "the same");
        CHECK(by.slow == (q > 0.0));
    }
}
