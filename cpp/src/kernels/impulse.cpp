#include "birm3d/kernels/impulse.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Velocity change of `body` at `arm` for a unit impulse along `normal` at `at`.
Vec3 velocity_change(const ContactBody& body, const Vec3& arm, const Vec3& at, const Vec3& normal) {
    const Vec3 spin = body.inverse_inertia * at.cross(normal);
    return body.inverse_mass * normal + spin.cross(arm);
}

// A_ij: separation velocity at contact i per unit impulse at contact j.
double influence(const RigidContact& i, const RigidContact& j, std::span<const ContactBody> bodies) {
    double sum = 0.0;
    const auto add = [&](int body_i, const Vec3& arm_i, double sign_i, int body_j, const Vec3& arm_j,
                         double sign_j) {
        if (body_i < 0 || body_i != body_j) return;
        sum +=
            sign_i * sign_j *
            i.normal.dot(velocity_change(bodies[static_cast<std::size_t>(body_i)], arm_i, arm_j, j.normal));
    };
    const int bi = static_cast<int>(i.body), bj = static_cast<int>(j.body);
    add(bi, i.arm, 1.0, bj, j.arm, 1.0);
    add(bi, i.arm, 1.0, j.other, j.other_arm, -1.0);
    add(i.other, i.other_arm, -1.0, bj, j.arm, 1.0);
    add(i.other, i.other_arm, -1.0, j.other, j.other_arm, -1.0);
    return sum;
}

void apply(const RigidContact& contact, double impulse, std::span<ContactBody> bodies) {
    const auto push = [&](ContactBody& body, const Vec3& arm, const Vec3& j) {
        body.motion.velocity += body.inverse_mass * j;
        body.motion.angular_velocity += body.inverse_inertia * arm.cross(j);
    };
    push(bodies[contact.body], contact.arm, impulse * contact.normal);
    if (contact.other >= 0)
        push(bodies[static_cast<std::size_t>(contact.other)], contact.other_arm, -impulse * contact.normal);
}

}  // namespace

double separation_velocity(const RigidContact& contact, std::span<const ContactBody> bodies) {
    const auto point_velocity = [](const ContactBody& body, const Vec3& arm) -> Vec3 {
        return body.motion.velocity + body.motion.angular_velocity.cross(arm);
    };
    Vec3 velocity = point_velocity(bodies[contact.body], contact.arm);
    if (contact.other >= 0)
        velocity -= point_velocity(bodies[static_cast<std::size_t>(contact.other)], contact.other_arm);
    return velocity.dot(contact.normal);
}

double inverse_effective_mass(const RigidContact& contact, std::span<const ContactBody> bodies) {
    return influence(contact, contact, bodies);
}

void solve_impulses(std::span<RigidContact> contacts, std::span<ContactBody> bodies, double speed_scale) {
    const double tolerance = tolerance::contact_velocity * speed_scale;
    const std::vector<ContactBody> free(bodies.begin(), bodies.end());
    std::vector<std::size_t> active;
    std::vector<char> is_active(contacts.size(), 0);
    std::vector<char> settled(contacts.size(), 0);  // joined and left at once: at its target but for rounding
    Eigen::MatrixXd A;
    Eigen::VectorXd wanted, impulse;
    for (RigidContact& contact : contacts)
        contact.impulse = 0.0;

    // Brings the bodies' motions up to date with the impulses of the active contacts.
    const auto move_bodies = [&] {
        std::copy(free.begin(), free.end(), bodies.begin());
        for (const std::size_t i : active)
            apply(contacts[i], contacts[i].impulse, bodies);
    };
    // How far a contact is from its target in that motion; positive = still short of it.
    const auto shortfall = [&](std::size_t i) {
        return contacts[i].target - separation_velocity(contacts[i], bodies);
    };
    const auto solve_active = [&] {
        const auto m = static_cast<Eigen::Index>(active.size());
        A.resize(m, m);
        wanted.resize(m);
        for (Eigen::Index r = 0; r < m; ++r) {
            const RigidContact& row = contacts[active[static_cast<std::size_t>(r)]];
            for (Eigen::Index c = 0; c <= r; ++c)
                A(r, c) = A(c, r) = influence(row, contacts[active[static_cast<std::size_t>(c)]], free);
            A(r, r) *= 1.0 + row.compliance;
            wanted[r] = row.target - separation_velocity(row, free);
        }
        impulse = A.ldlt().solve(wanted);
    };

    constexpr int most_rounds = 1000;
    for (int round = 0;; ++round) {
        std::size_t worst = contacts.size();
        double largest = tolerance;
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            if (settled[i] || is_active[i]) continue;
            const double lack = shortfall(i);
            if (lack > largest) largest = lack, worst = i;
        }
        if (worst == contacts.size()) break;
        if (round == most_rounds)
            throw std::runtime_error("rigid contacts: no set of impulses found in 1000 rounds");
        active.push_back(worst);
        is_active[worst] = 1;

        // Move from the present impulses towards the solution of the active set; contacts that would pull
        // leave it where their impulse reaches zero.
        for (bool done = false; !done;) {
            solve_active();
            double step = 1.0;
            for (std::size_t k = 0; k < active.size(); ++k) {
                const double now = contacts[active[k]].impulse, next = impulse[static_cast<Eigen::Index>(k)];
                if (next <= 0.0) step = std::min(step, now / (now - next));
            }
            done = step >= 1.0;
            std::vector<std::size_t> kept;
            for (std::size_t k = 0; k < active.size(); ++k) {
                RigidContact& contact = contacts[active[k]];
                const double next = impulse[static_cast<Eigen::Index>(k)];
                const bool leaves =
                    !done && next <= 0.0 && contact.impulse / (contact.impulse - next) <= step;
                contact.impulse = leaves ? 0.0 : contact.impulse + step * (next - contact.impulse);
                if (leaves)
                    is_active[active[k]] = 0;
                else
                    kept.push_back(active[k]);
            }
            active = std::move(kept);
        }
        if (!is_active[worst]) settled[worst] = 1;
        move_bodies();
    }
    if (active.empty()) return;

    // The compliance has done its work, which is to share the load: take its give out again.
    const Eigen::LDLT<Eigen::MatrixXd> factors = A.ldlt();
    for (int pass = 0; pass < 3; ++pass) {
        Eigen::VectorXd lack(static_cast<Eigen::Index>(active.size()));
        for (std::size_t k = 0; k < active.size(); ++k)
            lack[static_cast<Eigen::Index>(k)] = shortfall(active[k]);
        const Eigen::VectorXd more = factors.solve(lack);
        for (std::size_t k = 0; k < active.size(); ++k)
            contacts[active[k]].impulse =
                std::max(0.0, contacts[active[k]].impulse + more[static_cast<Eigen::Index>(k)]);
        move_bodies();
    }
}

}  // namespace birm3d
