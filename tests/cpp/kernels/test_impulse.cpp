#include "kernels/impulse.hpp"

#include <cmath>
#include <vector>

#include "check.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;

namespace {

ContactBody body(double mass, const Vec3& inertia, const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
    return {1.0 / mass, Mat3(inertia.cwiseInverse().asDiagonal()), {velocity, spin}};
}

RigidContact contact(const Vec3& arm, const Vec3& normal, double target = 0.0) {
    RigidContact c;
    c.arm = arm;
    c.normal = normal.normalized();
    c.target = target;
    c.compliance = 1e-9;
    return c;
}

double kinetic_energy(const ContactBody& b) {
    const Vec3& v = b.motion.velocity;
    const Vec3& w = b.motion.angular_velocity;
    return 0.5 * v.squaredNorm() / b.inverse_mass + 0.5 * w.dot(b.inverse_inertia.inverse() * w);
}

}  // namespace

TEST("one contact off the mass centre: the impulse of Eq. 1") {
    const double mass = 1200.0, restitution = 0.3;
    const Vec3 inertia(500.0, 1800.0, 2000.0), arm(1.1, -0.4, -0.6);
    std::vector<ContactBody> bodies = {body(mass, inertia, {3.0, 0.5, -4.0}, {0.2, -0.7, 0.1})};
    std::vector<RigidContact> contacts = {contact(arm, {0.1, 0.2, 1.0})};
    const Vec3 n = contacts[0].normal;
    const double before = separation_velocity(contacts[0], bodies);
    CHECK(before < 0.0);
    contacts[0].target = -restitution * before;

    const Vec3 lever = arm.cross(n);
    const double denominator = 1.0 / mass + lever.dot(lever.cwiseQuotient(inertia));
    CHECK_CLOSE(inverse_effective_mass(contacts[0], bodies), denominator, 1e-18, "rounding");
    solve_impulses(contacts, bodies, 5.0);
    CHECK_CLOSE(contacts[0].impulse, -(1.0 + restitution) * before / denominator, 1e-9, "rounding, 1e3 N s");
    CHECK_CLOSE(separation_velocity(contacts[0], bodies), -restitution * before, 1e-12, "rounding");
}

TEST("a contact that separates is left alone") {
    std::vector<ContactBody> bodies = {body(1000.0, Vec3::Ones(), {0.0, 0.0, 2.0})};
    std::vector<RigidContact> contacts = {contact({0.0, 0.0, -1.0}, Vec3::UnitZ())};
    solve_impulses(contacts, bodies, 2.0);
    CHECK_CLOSE(contacts[0].impulse, 0.0, 0.0, "exact");
    CHECK_CLOSE(bodies[0].motion.velocity.z(), 2.0, 0.0, "exact");
}

TEST("two bodies that meet keep their momenta") {
    std::vector<ContactBody> bodies = {
        body(1500.0, {600.0, 2200.0, 2400.0}, {15.0, 0.0, 0.0}),
        body(900.0, {300.0, 1200.0, 1300.0}, {-8.0, 1.0, 0.0}, {0.0, 0.0, 0.5})};
    const std::vector<ContactBody> start = bodies;
    const Vec3 place(2.0, 0.3, 0.4), first(0.0, 0.0, 0.0), second(4.1, -0.2, 0.1);
    RigidContact meeting = contact(place - first, {-1.0, 0.2, 0.0});
    meeting.other = 1;
    meeting.other_arm = place - second;
    std::vector<RigidContact> contacts = {meeting};
    const double approach = separation_velocity(contacts[0], bodies);
    contacts[0].target = -approach;  // elastic: the kinetic energy stays as well
    solve_impulses(contacts, bodies, 20.0);

    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
    double energy = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 at = i == 0 ? first : second;
        for (const double sign : {-1.0, 1.0}) {
            const ContactBody& b = sign < 0.0 ? start[i] : bodies[i];
            const Vec3 p = b.motion.velocity / b.inverse_mass;
            momentum += sign * p;
            angular += sign * (at.cross(p) + b.inverse_inertia.inverse() * b.motion.angular_velocity);
            energy += sign * kinetic_energy(b);
        }
    }
    CHECK_CLOSE(momentum.norm(), 0.0, 1e-10, "rounding of 2e4 N s");
    CHECK_CLOSE(angular.norm(), 0.0, 1e-10, "rounding of 2e4 N m s");
    CHECK_CLOSE(energy, 0.0, 1e-8, "rounding of 2e5 J");
    CHECK_CLOSE(separation_velocity(contacts[0], bodies), -approach, 1e-12, "rounding");
}

TEST("many contacts on a plane share the load as equal springs would") {
    // Twelve points on a rectangle whose middle lies off the mass centre: the load falls along the lever.
    const double mass = 2000.0;
    std::vector<ContactBody> bodies = {body(mass, {800.0, 3000.0, 3200.0}, {0.0, 0.0, -1.0})};
    std::vector<RigidContact> contacts;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j) {
            contacts.push_back(contact({-1.2 + 1.0 * i, -0.8 + 0.8 * j, -0.6}, Vec3::UnitZ()));
            contacts.back().compliance = 1e-3;
        }
    solve_impulses(contacts, bodies, 1.0);
    CHECK_CLOSE(bodies[0].motion.velocity.norm() + bodies[0].motion.angular_velocity.norm(), 0.0, 1e-11,
                "all twelve at rest, so the body is");
    double sum = 0.0, moment = 0.0;
    for (const RigidContact& c : contacts) {
        CHECK(c.impulse > 0.0);
        sum += c.impulse;
        moment += c.impulse * c.arm.x();
        // Points at the same lever carry the same: the scene is symmetric in y.
        for (const RigidContact& d : contacts)
            if (c.arm.x() == d.arm.x() && c.arm.y() == -d.arm.y())
                CHECK_CLOSE(c.impulse, d.impulse, 1e-8 * mass,
                            "redundant shares: solved with a compliance of 1e-3");
    }
    CHECK_CLOSE(sum, mass, 1e-8, "rounding");
    CHECK_CLOSE(moment, 0.0, 1e-8, "the load's resultant passes through the mass centre");
}

TEST("impulses and separation velocities are complementary in random scenes") {
    std::uint64_t seed = 12345;
    const auto random = [&seed] {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(seed >> 11) / 9007199254740992.0 * 2.0 - 1.0;
    };
    const auto random_vector = [&random] {
        const double x = random(), y = random(), z = random();
        return Vec3(x, y, z);
    };
    int pushed = 0, free = 0;
    for (int scene = 0; scene < 200; ++scene) {
        std::vector<ContactBody> bodies = {
            body(1000.0, {600.0, 900.0, 1100.0}, 5.0 * random_vector(), random_vector())};
        std::vector<RigidContact> contacts;
        for (int i = 0; i < 10; ++i) {
            const Vec3 arm = random_vector();
            const Vec3 normal = Vec3(0.0, 0.0, 1.5) + random_vector();
            contacts.push_back(contact(arm, normal, 0.2 * random()));
        }
        solve_impulses(contacts, bodies, 5.0);
        for (const RigidContact& c : contacts) {
            const double w = separation_velocity(c, bodies) - c.target;
            CHECK(c.impulse >= 0.0);
            CHECK(w >= -1e-8);
            if (c.impulse > 0.0) CHECK_CLOSE(w, 0.0, 1e-8, "compliance 1e-9 of velocities near 5 m/s");
            (c.impulse > 0.0 ? pushed : free) += 1;
        }
    }
    CHECK(pushed > 200);
    CHECK(free > 200);
}

namespace {

// Deterministic numbers in [-1, 1).
struct Random {
    std::uint64_t seed = 12345;
    double operator()() {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(seed >> 11) / 9007199254740992.0 * 2.0 - 1.0;
    }
    Vec3 vector() {
        const double x = (*this)(), y = (*this)(), z = (*this)();
        return {x, y, z};
    }
};

// Rows that push only: w >= target, j >= 0, and one of both is equal. Rows that are held: w = target.
void check_answer(std::span<const RigidContact> rows, std::span<const ContactBody> bodies, double tolerance) {
    for (const RigidContact& row : rows) {
        const double w = separation_velocity(row, bodies) - row.target;
        CHECK(std::isfinite(row.impulse));
        if (!row.bilateral) {
            CHECK(row.impulse >= 0.0);
            CHECK(w >= -tolerance);
        }
        if (row.bilateral || row.impulse > 0.0) CHECK_CLOSE(w, 0.0, tolerance, "the tolerance of the solver");
    }
}

}  // namespace

TEST("a chain of pinned bodies that are pushed keeps together, and its momentum but for the pushes") {
    Random random;
    for (int scene = 0; scene < 100; ++scene) {
        constexpr std::size_t links = 5;
        std::vector<ContactBody> bodies;
        std::vector<Vec3> place;
        for (std::size_t b = 0; b < links; ++b) {
            const Vec3 spin = random.vector(), velocity = 5.0 * random.vector();
            bodies.push_back(
                body(1000.0 * (1.0 + static_cast<double>(b)), {600.0, 900.0, 1100.0}, velocity, spin));
            place.emplace_back(4.0 * static_cast<double>(b), 0.0, 0.0);
        }
        std::vector<RigidContact> rows;
        for (std::size_t b = 0; b + 1 < links; ++b) {
            const Vec3 pin = 0.5 * (place[b] + place[b + 1]) + 0.3 * random.vector();
            for (const Vec3& along : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
                RigidContact row = contact(pin - place[b], along, 0.05 * random());
                row.body = b;
                row.other = static_cast<int>(b + 1);
                row.other_arm = pin - place[b + 1];
                row.bilateral = true;
                rows.push_back(row);
            }
            RigidContact lock = contact(Vec3::Zero(), Vec3::UnitX());
            lock.body = b;
            lock.other = static_cast<int>(b + 1);
            lock.about_axis = true;
            lock.bilateral = scene % 2 == 0;
            rows.push_back(lock);
        }
        const std::size_t pins = rows.size();
        if (scene % 4 < 2)
            for (std::size_t b = 0; b < links; ++b) {
                const Vec3 normal = Vec3(0.0, 0.0, 1.0) + 0.3 * random.vector();
                rows.push_back(contact(random.vector(), normal));
                rows.back().body = b;
            }
        const std::vector<ContactBody> start = bodies;
        solve_impulses(rows, bodies, 5.0);
        check_answer(rows, bodies, 1e-9);

        Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
        for (std::size_t b = 0; b < links; ++b) {
            const Vec3 change =
                (bodies[b].motion.velocity - start[b].motion.velocity) / bodies[b].inverse_mass;
            linear += change;
            angular += place[b].cross(change) +
                       bodies[b].inverse_inertia.inverse() *
                           (bodies[b].motion.angular_velocity - start[b].motion.angular_velocity);
        }
        for (std::size_t i = pins; i < rows.size(); ++i) {
            const Vec3 push = rows[i].impulse * rows[i].normal;
            linear -= push;
            angular -= (place[rows[i].body] + rows[i].arm).cross(push);
        }
        CHECK_CLOSE(linear.norm(), 0.0, 1e-8, "rounding of 1e4 N s");
        CHECK_CLOSE(angular.norm(), 0.0, 1e-7, "rounding of 1e5 N m s");
    }
}

TEST("a stop turns a body back and lets it go; a lock holds it both ways") {
    for (const double spin : {2.0, -2.0}) {
        RigidContact stop = contact({0.4, 0.1, 0.0}, Vec3::UnitX());
        stop.about_axis = true;
        std::vector<ContactBody> bodies = {
            body(1000.0, {500.0, 800.0, 900.0}, {1.0, 2.0, 3.0}, {spin, 0.5, 0.0})};
        std::vector<RigidContact> rows = {stop};
        solve_impulses(rows, bodies, 2.0);
        CHECK_CLOSE(rows[0].impulse, spin < 0.0 ? -500.0 * spin : 0.0, 1e-9, "rounding; N m s");
        CHECK_CLOSE(bodies[0].motion.angular_velocity.x(), std::max(0.0, spin), 1e-12, "rounding");
        CHECK(bodies[0].motion.velocity == Vec3(1.0, 2.0, 3.0));

        rows[0].bilateral = true;
        bodies[0].motion.angular_velocity.x() = spin;
        solve_impulses(rows, bodies, 2.0);
        CHECK_CLOSE(rows[0].impulse, -500.0 * spin, 1e-9, "rounding");
        CHECK_CLOSE(bodies[0].motion.angular_velocity.x(), 0.0, 1e-12, "rounding");
    }
}

TEST("thousands of points of one face press as its corners do") {
    // A body that comes in turning: part of its face presses. What counts is the wrench.
    const ContactBody start = body(6804.0, {5000.0, 40000.0, 42000.0}, {10.0, 0.3, -0.01}, {0.0, 0.3, 1.5});
    const auto solve = [&](int across) {
        std::vector<ContactBody> bodies = {start};
        std::vector<RigidContact> contacts;
        for (int i = 0; i < across; ++i)
            for (int j = 0; j < across; ++j)
                contacts.push_back(
                    contact({1.0, -1.2 + 2.4 * i / (across - 1), -0.8 + 1.6 * j / (across - 1)},
                            -Vec3::UnitX(), -0.5));
        solve_impulses(contacts, bodies, 10.0);
        check_answer(contacts, bodies, 1e-9);
        return bodies[0].motion;
    };
    const Twist corners = solve(2);
    for (const int across : {3, 10, 50}) {
        const Twist motion = solve(across);
        CHECK_CLOSE((motion.velocity - corners.velocity).norm(), 0.0, 1e-9, "the tolerance of the solver");
        CHECK_CLOSE((motion.angular_velocity - corners.angular_velocity).norm(), 0.0, 1e-9, "the same");
    }
}

TEST("points whose targets can not all be met exactly are met as inequalities") {
    // Three axles land with targets that no rigid body has at once: the middle one shall leave fastest or slowest.
    for (const double middle : {-1.0, 0.4}) {
        std::vector<ContactBody> bodies = {
            body(8633.0, {8000.0, 33000.0, 34000.0}, {0.0, 0.0, -3.0}, {0.1, 0.4, 0.0})};
        std::vector<RigidContact> contacts;
        for (const auto& [x, target] : {std::pair{1.8, 0.0}, {-1.8, middle}, {-3.1, 0.0}})
            for (const double y : {1.0, -1.0}) {
                contacts.push_back(contact({x, y, -1.0}, Vec3::UnitZ(), target));
                contacts.back().compliance = 1e-3;
            }
        solve_impulses(contacts, bodies, 5.0);
        check_answer(contacts, bodies, 1e-9);
    }
}

TEST("a solver used again for other motions gives what a new one gives") {
    Random random;
    const ContactBody still = body(1500.0, {600.0, 2200.0, 2400.0}, Vec3::Zero());
    std::vector<RigidContact> contacts;
    for (int i = 0; i < 12; ++i) {
        const Vec3 normal = Vec3(0.0, 0.0, 1.5) + random.vector();
        contacts.push_back(contact(random.vector(), normal));
        contacts.back().compliance = 1e-3;
    }
    std::vector<RigidContact> again = contacts;
    ImpulseSolver solver;
    solver.prepare(again, std::vector{still}, 5.0);
    for (int i = 0; i < 50; ++i) {
        std::vector<ContactBody> a = {still}, b;
        a[0].motion = {5.0 * random.vector(), random.vector()};
        b = a;
        solver.solve(again, a);
        solve_impulses(contacts, b, 5.0);
        CHECK_CLOSE((a[0].motion.velocity - b[0].motion.velocity).norm(), 0.0, 1e-9,
                    "the solver's tolerance");
        CHECK_CLOSE((a[0].motion.angular_velocity - b[0].motion.angular_velocity).norm(), 0.0, 1e-9,
                    "the same");
        check_answer(again, a, 1e-9);
    }
}

TEST("a body between two walls that both ask for way stays finite, and amid them") {
    std::vector<ContactBody> bodies = {body(1000.0, {500.0, 800.0, 900.0}, {3.0, 0.0, 0.0})};
    std::vector<RigidContact> contacts = {contact({1.0, 0.0, 0.0}, -Vec3::UnitX(), 0.5),
                                          contact({-1.0, 0.0, 0.0}, Vec3::UnitX(), 0.5)};
    solve_impulses(contacts, bodies, 3.0);
    CHECK_CLOSE(bodies[0].motion.velocity.x(), 0.0, 1e-6, "both are alike; impulses of 1e9 times the body's");
}

// A vehicle on a crushed side: thousands of points of one plane, of which most push by no more than rounding. They were tried one
// by one, which took a second.
TEST("a body lies on thousands of points") {
    Random random;
    std::vector<ContactBody> bodies = {
        body(13000.0, {2e4, 1.5e5, 1.5e5}, {1.0, 0.2, -0.3}, {0.4, 0.1, 0.05})};
    std::vector<RigidContact> rows;
    constexpr int points = 3000;
    for (int i = 0; i < points; ++i)
        rows.push_back(contact({6.0 * random(), 1.2 * random(), -1.0}, Vec3::UnitZ(), 1e-4 * random()));
    solve_impulses(rows, bodies, 20.0);
    check_answer(rows, bodies, 1e-8);
}
