#include "kernels/impulse.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

using Eigen::Index;

// R with R R^T = inverse inertia; zero for a body that can not be turned.
Mat3 root_of(const ContactBody& body) {
    if (body.inverse_inertia.isZero(0.0)) return Mat3::Zero();
    if (body.freedom == Freedom::planar)
        return Vec3(0.0, 0.0, std::sqrt(body.inverse_inertia(2, 2))).asDiagonal();
    // A projection to a plane, P, over the inertia I: its root is P/sqrt(I), and its trace 2/I.
    if (body.freedom == Freedom::tilt)
        return std::sqrt(2.0 / body.inverse_inertia.trace()) * body.inverse_inertia;
    return body.inverse_inertia.llt().matrixL();
}

// The part of a force that moves a body that slides on the ground.
Vec3 along_ground(const Vec3& force) {
    return {force.x(), force.y(), 0.0};
}

}  // namespace

double separation_velocity(const RigidContact& contact, std::span<const ContactBody> bodies) {
    const auto velocity = [&contact](const ContactBody& body, const Vec3& arm) -> Vec3 {
        const Twist& motion = body.motion;
        if (contact.about_axis) return motion.angular_velocity;
        return motion.velocity + motion.angular_velocity.cross(arm);
    };
    Vec3 relative = velocity(bodies[contact.body], contact.arm);
    if (contact.other >= 0)
        relative -= velocity(bodies[static_cast<std::size_t>(contact.other)], contact.other_arm);
    return relative.dot(contact.normal);
}

double inverse_effective_mass(const RigidContact& contact, std::span<const ContactBody> bodies) {
    const auto of_body = [&contact](const ContactBody& body, const Vec3& arm) {
        const Wrench wrench = unit_wrench(contact, arm);
        if (body.freedom == Freedom::planar)
            return body.inverse_mass * along_ground(wrench.force).squaredNorm() +
                   body.inverse_inertia(2, 2) * wrench.torque.z() * wrench.torque.z();
        return body.inverse_mass * wrench.force.squaredNorm() +
               wrench.torque.dot(body.inverse_inertia * wrench.torque);
    };
    double sum = of_body(bodies[contact.body], contact.arm);
    if (contact.other >= 0)
        sum += of_body(bodies[static_cast<std::size_t>(contact.other)], contact.other_arm);
    return sum;
}

void ImpulseSolver::prepare(std::span<const RigidContact> contacts, std::span<const ContactBody> bodies,
                            double speed_scale) {
    tolerance_ = tolerance::contact_velocity * speed_scale;
    motion_.setZero(6 * static_cast<Index>(bodies.size()));
    factorised_ = false;
    active_.clear();
    roots_.clear();
    rows_.clear();
    for (const ContactBody& body : bodies)
        roots_.push_back({std::sqrt(body.inverse_mass), root_of(body), body.freedom == Freedom::planar});
    for (const RigidContact& contact : contacts) {
        ConstraintRow row{contact.body, contact.other, {}, Vec6::Zero()};
        row.bilateral = contact.bilateral;
        row.slides = contact.slides;
        row.g = in_unit_mass(unit_wrench(contact, contact.arm), row.body);
        if (row.other >= 0) {
            row.g_other =
                -in_unit_mass(unit_wrench(contact, contact.other_arm), static_cast<std::size_t>(row.other));
        }
        row.diagonal = influence(row, row);
        row.compliance = std::max(contact.compliance * bodies[row.body].inverse_mass,
                                  tolerance::body_compliance * row.diagonal);
        rows_.push_back(row);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].bilateral && !rows_[i].slides && rows_[i].diagonal > 0.0) activate(i);
}

void ImpulseSolver::solve(std::span<RigidContact> contacts, std::span<ContactBody> bodies) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        rows_[i].rhs = contacts[i].target - separation_velocity(contacts[i], bodies);
        rows_[i].before = 0.0;
    }
    constexpr int most_passes = 10;
    double given = infinity;
    for (int pass = 0; pass < most_passes && given > 0.1 * tolerance_; ++pass) {
        for (ConstraintRow& row : rows_)
            row.shifted_rhs = row.rhs + row.compliance * row.before;
        find_impulses();
        given = 0.0;
        for (ConstraintRow& row : rows_) {
            given = std::max(given, row.compliance * std::abs(row.impulse - row.before));
            row.before = row.impulse;
        }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (!rows_[i].slides) contacts[i].impulse = rows_[i].impulse;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const auto u = motion_.segment<6>(6 * static_cast<Index>(b));
        bodies[b].motion.velocity += roots_[b].mass * u.head<3>();
        bodies[b].motion.angular_velocity += roots_[b].inertia * u.tail<3>();
    }
}

ImpulseSolver::Vec6 ImpulseSolver::in_unit_mass(const Wrench& wrench, std::size_t body) const {
    Vec6 g;
    g.head<3>() = roots_[body].mass * (roots_[body].planar ? along_ground(wrench.force) : wrench.force);
    g.tail<3>() = roots_[body].inertia.transpose() * wrench.torque;
    return g;
}

double ImpulseSolver::along(const ConstraintRow& row, const Eigen::VectorXd& motion) {
    double sum = row.g.dot(motion.segment<6>(6 * static_cast<Index>(row.body)));
    if (row.other >= 0) sum += row.g_other.dot(motion.segment<6>(6 * row.other));
    return sum;
}

void ImpulseSolver::push(const ConstraintRow& row, double impulse, Eigen::VectorXd& motion) {
    motion.segment<6>(6 * static_cast<Index>(row.body)) += impulse * row.g;
    if (row.other >= 0) motion.segment<6>(6 * row.other) += impulse * row.g_other;
}

// A_ij.
double ImpulseSolver::influence(const ConstraintRow& i, const ConstraintRow& j) {
    const int bi = static_cast<int>(i.body), bj = static_cast<int>(j.body);
    double sum = 0.0;
    if (bi == bj) sum += i.g.dot(j.g);
    if (bi == j.other) sum += i.g.dot(j.g_other);
    if (i.other == bj) sum += i.g_other.dot(j.g);
    if (i.other >= 0 && i.other == j.other) sum += i.g_other.dot(j.g_other);
    return sum;
}

void ImpulseSolver::activate(std::size_t row) {
    rows_[row].active = true;
    active_.push_back(row);
    factorised_ = false;
}

// Starts from the present impulses, which may be those of the last solution.
void ImpulseSolver::find_impulses() {
    for (ConstraintRow& row : rows_) {
        row.settled = row.slides || row.diagonal == 0.0;  // left out: it slides, or nothing can be moved
        row.joined = 0;
    }
    if (active_.empty())
        motion_.setZero();
    else
        settle_active();

    // Activating all violated rows at once is fast but may cycle: it is given up after some rounds in which they did not get
    // fewer. Activating one by one can cycle only by rounding, when some rows become active and inactive again and again.
    constexpr std::size_t first_alone = 1;
    constexpr int most_joins = 10;
    int rounds_together = 5;
    const std::size_t most_rounds = 1000 + rows_.size();
    std::size_t fewest = rows_.size();
    for (std::size_t round = 0;; ++round) {
        const bool together = round >= first_alone && rounds_together > 0;
        std::size_t worst = rows_.size(), violated = 0;
        double largest = tolerance_;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (rows_[i].settled || rows_[i].active) continue;
            const double missing = shortfall(rows_[i]);
            if (!(missing > tolerance_)) continue;
            ++violated;
            if (missing > largest) largest = missing, worst = i;
            if (together) activate(i);
        }
        if (worst == rows_.size()) break;
        if (round == most_rounds)
            throw std::runtime_error("rigid contacts: no set of impulses found in " +
                                     std::to_string(most_rounds) + " rounds");
        if (together) {
            if (violated < fewest)
                fewest = violated;
            else
                --rounds_together;
            joined_.assign(active_.end() - static_cast<std::ptrdiff_t>(violated), active_.end());
            settle_together();
            // Of rows that are violated, some would push. If none does, they are violated by rounding only.
            const bool none_pushes = std::none_of(joined_.begin(), joined_.end(),
                                                  [this](std::size_t i) { return rows_[i].active; });
            for (const std::size_t i : joined_)
                rows_[i].settled = none_pushes;
            continue;
        }
        activate(worst);
        settle_active();
        ConstraintRow& row = rows_[worst];
        row.settled = !row.active || ++row.joined == most_joins;
    }
}

// Moves from the present impulses towards the solution of the active rows. A row that would pull becomes inactive
// where its impulse reaches zero.
void ImpulseSolver::settle_active() {
    for (bool done = false; !done;) {
        solve_active();
        double step = 1.0;
        for (const std::size_t i : active_) {
            const ConstraintRow& row = rows_[i];
            if (!row.bilateral && row.next <= 0.0)
                step = std::min(step, row.impulse / (row.impulse - row.next));
        }
        done = !(step < 1.0);
        kept_.clear();
        for (const std::size_t i : active_) {
            ConstraintRow& row = rows_[i];
            row.active =
                done || row.bilateral || row.next > 0.0 || row.impulse / (row.impulse - row.next) > step;
            if (row.active) kept_.push_back(i);
            row.impulse = !row.active ? 0.0 : done ? row.next : row.impulse + step * (row.next - row.impulse);
        }
        if (kept_.size() < active_.size()) factorised_ = false;
        std::swap(active_, kept_);
    }
    move_by(&ConstraintRow::impulse, motion_);
}

// The same, but all rows that would pull become inactive at once. Some of them may have to be activated again. A vehicle that lies
// on a crushed side has thousands of rows, which would become inactive one by one.
void ImpulseSolver::settle_together() {
    for (bool done = false; !done;) {
        solve_active();
        kept_.clear();
        for (const std::size_t i : active_) {
            ConstraintRow& row = rows_[i];
            row.active = row.bilateral || row.next > 0.0;
            row.impulse = row.active ? row.next : 0.0;
            if (row.active) kept_.push_back(i);
        }
        done = kept_.size() == active_.size();
        if (!done) factorised_ = false;
        std::swap(active_, kept_);
    }
    move_by(&ConstraintRow::impulse, motion_);
}

void solve_impulses(std::span<RigidContact> contacts, std::span<ContactBody> bodies, double speed_scale) {
    if (contacts.empty()) return;
    ImpulseSolver solver;
    solver.prepare(contacts, bodies, speed_scale);
    solver.solve(contacts, bodies);
}

}  // namespace birm3d
