#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "kernels/integrate.hpp"
#include "kernels/joints.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::infinity;
using laboratory::pi;
using laboratory::speck;

namespace {

const Vec3 place_a(-2.0, 0.2, 0.3), place_b(4.0, 0.2, -0.6);

Unit leading() {
    return {RigidBody(8000.0, Vec3(6000.0, 30000.0, 32000.0).asDiagonal()), speck(), {}, 1.0};
}
Unit trailing() {
    return {RigidBody(24000.0, Vec3(30000.0, 200000.0, 210000.0).asDiagonal()),
            speck(),
            {},
            1.9,
            Vec3(-6.0, 0.0, 0.0)};
}

std::shared_ptr<const Vehicle> pair(JointKind kind, double roll_limit = 2.0 * pi / 180.0) {
    return std::make_shared<const Vehicle>(
        joined({leading(), trailing()}, {{kind, 0, 1, place_a, place_b, roll_limit}}));
}

Scene floating(JointKind kind, double tolerance, double duration = 1.0) {
    return {pair(kind, 1.4), nullptr, Approach{10.0, 0.5 * pi, 0.0, 0.0}, laboratory::weightless(tolerance),
            duration};
}

// Total momentum, angular momentum about the world's origin, kinetic energy.
struct Totals {
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
    double energy = 0.0;
};
Totals totals(const Vehicle& vehicle, const State& state) {
    Totals sum;
    for (std::size_t u = 0; u < vehicle.units.size(); ++u) {
        const BodyState& body = state.units[u].body;
        const Vec3 p = vehicle.units[u].body.mass * body.velocity;
        sum.momentum += p;
        sum.angular += body.position.cross(p) + body.angular_momentum;
        sum.energy += kinetic_energy(vehicle.units[u].body, body);
    }
    return sum;
}

double widest_gap(const Vehicle& vehicle, const State& state) {
    double widest = 0.0;
    for (const Joint& joint : vehicle.joints) {
        const BodyState &a = state.units[joint.leading].body, &b = state.units[joint.trailing].body;
        widest = std::max(widest, (a.position + a.orientation * joint.place_on_leading - b.position -
                                   b.orientation * joint.place_on_trailing)
                                      .norm());
    }
    return widest;
}

// Spins the pair: unit 0 by `spin`, unit 1 so that their joint keeps together.
Simulation spinning(const Scene& scene, const Vec3& spin_a, const Vec3& spin_b) {
    Simulation simulation(scene);
    Simulation::Snapshot start = simulation.snapshot();
    const Joint& joint = scene.vehicle->joints[0];
    const Vec3 spins[] = {spin_a, spin_b};
    for (std::size_t u = 0; u < 2; ++u) {
        BodyState& body = start.state.units[u].body;
        const Vec3& place = u == 0 ? joint.place_on_leading : joint.place_on_trailing;
        body.velocity -= spins[u].cross(body.orientation * place);
        const Mat3 R = body.orientation.toRotationMatrix();
        body.angular_momentum = R * scene.vehicle->units[u].body.inertia * R.transpose() * spins[u];
    }
    Totals sum = totals(*scene.vehicle, start.state);
    start.state.energies.kinetic = sum.energy;
    start.recorder = Recorder(scene, start.state);
    simulation.restore(start);
    return simulation;
}

}  // namespace

TEST("two free bodies joined keep their momenta; their energy the better the smaller the tolerance") {
    std::vector<double> drifts;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        Simulation simulation =
            spinning(floating(JointKind::fifth_wheel, tolerance, 0.2), {0.0, 0.3, 20.0}, {0.0, -0.2, -15.0});
        const Vehicle& vehicle = *simulation.scene().vehicle;
        const Totals start = totals(vehicle, simulation.state());
        const double balances = simulation.state().energies.total();
        double drift = 0.0;
        while (simulation.step()) {
            const Totals now = totals(vehicle, simulation.state());
            CHECK_CLOSE(widest_gap(vehicle, simulation.state()), 0.0, 1e-11, "closed but for rounding");
            CHECK_CLOSE((now.momentum - start.momentum).norm() / start.momentum.norm(), 0.0, 1e-12,
                        "rounding");
            CHECK_CLOSE((now.angular - start.angular).norm() / start.angular.norm(), 0.0, 1e-12, "rounding");
            CHECK_CLOSE(simulation.state().energies.total() / balances, 1.0, 1e-12,
                        "every impulse is booked");
            drift = std::max(drift, std::abs(now.energy / start.energy - 1.0));
        }
        CHECK_CLOSE(simulation.state().energies.impacts, 0.0, 0.0, "no stop is met");
        CHECK(drift < tolerance);
        drifts.push_back(drift);
    }
    // A local error of third order in the step, held in proportion to the tolerance: energy goes with the step
    // squared, so with the tolerance to the power 2/3, 4.6 times for each tenth.
    CHECK(drifts[0] > 3.0 * drifts[1]);
    CHECK(drifts[1] > 3.0 * drifts[2]);
}

namespace {

// Turn angles and rates of two plane bodies joined at levers a, b behind and before their mass centres, free
// otherwise: Lagrange's equations of T = I1 w1^2/2 + I2 w2^2/2 + mu |r'|^2/2 with r = a (cos p, sin p) + b (cos q,
// sin q) the way between the mass centres, mu the reduced mass.
struct Plane {
    double p, q, w1, w2;
};
Plane slope(const Plane& s, double mu, double a, double b, double i1, double i2) {
    const double c = std::cos(s.p - s.q), d = std::sin(s.p - s.q);
    const double m11 = i1 + mu * a * a, m22 = i2 + mu * b * b, m12 = mu * a * b * c;
    const double f1 = -mu * a * b * d * s.w2 * s.w2, f2 = mu * a * b * d * s.w1 * s.w1;
    const double det = m11 * m22 - m12 * m12;
    return {s.w1, s.w2, (f1 * m22 - f2 * m12) / det, (f2 * m11 - f1 * m12) / det};
}
Plane runge_kutta(Plane s, double time, int steps, double mu, double a, double b, double i1, double i2) {
    const double h = time / steps;
    const auto plus = [](const Plane& x, const Plane& k, double f) {
        return Plane{x.p + f * k.p, x.q + f * k.q, x.w1 + f * k.w1, x.w2 + f * k.w2};
    };
    for (int i = 0; i < steps; ++i) {
        const Plane k1 = slope(s, mu, a, b, i1, i2), k2 = slope(plus(s, k1, 0.5 * h), mu, a, b, i1, i2);
        const Plane k3 = slope(plus(s, k2, 0.5 * h), mu, a, b, i1, i2);
        const Plane k4 = slope(plus(s, k3, h), mu, a, b, i1, i2);
        s = plus(plus(plus(plus(s, k1, h / 6.0), k2, h / 3.0), k3, h / 3.0), k4, h / 6.0);
    }
    return s;
}

}  // namespace

TEST("a free double pendulum moves as Lagrange's equations say, to second order in the step") {
    const double a = 2.0, b = 4.0, time = 1.0;
    const Vec3 back(-a, 0.0, 0.0), front(b, 0.0, 0.0);
    std::vector<Unit> units = {leading(), trailing()};
    units[1].mass_center_height = 1.0;
    Scene scene = floating(JointKind::fifth_wheel, 1e-3, time);
    scene.vehicle =
        std::make_shared<const Vehicle>(joined(units, {{JointKind::fifth_wheel, 0, 1, back, front, 0.1}}));
    scene.joints = scene.vehicle->joints;
    const double mu = 8000.0 * 24000.0 / 32000.0;
    const Plane exact = runge_kutta({0.0, 0.0, 4.0, -2.5}, time, 100000, mu, a, b, 32000.0, 210000.0);

    std::vector<double> errors;
    for (const double dt : {4e-3, 2e-3, 1e-3}) {
        scene.settings.time_step = dt;
        Simulation simulation = spinning(scene, {0.0, 0.0, 4.0}, {0.0, 0.0, -2.5});
        laboratory::run(simulation);
        const State& state = simulation.state();
        const double p = roll_pitch_yaw(state.units[0].body.orientation).yaw;
        const double q = roll_pitch_yaw(state.units[1].body.orientation).yaw;
        errors.push_back(std::abs(std::remainder(p - exact.p, 2.0 * pi)) +
                         std::abs(std::remainder(q - exact.q, 2.0 * pi)));
    }
    CHECK_CLOSE(errors[2], 0.0, 1e-4, "(4 rad/s * 1 ms)^2 of some radians");
    CHECK_CLOSE(errors[0] / errors[1], 4.0, 0.4, "second order");
    CHECK_CLOSE(errors[1] / errors[2], 4.0, 0.4, "second order");
    CHECK_CLOSE(roll_pitch_yaw(Quat(Eigen::AngleAxisd(exact.p, Vec3::UnitZ()))).yaw,
                std::remainder(exact.p, 2.0 * pi), 1e-9, "rounding");
}

TEST("a welded pair is one rigid body of the summed mass properties") {
    // Oblique crash of the leading unit's front into a wall with friction.
    const RigidBody ahead = laboratory::body(), behind(20000.0, Vec3(2e4, 1.5e5, 1.6e5).asDiagonal());
    const TrussInput front = laboratory::front_face(laboratory::w2_curve(), 8, 6);
    const Vec3 offset(-6.0, 0.3, 0.0);
    const double lift = 0.4;
    const Unit a(ahead, front, {}, 1.0), b(behind, speck(), {}, 1.0 + lift, offset);
    const Vec3 place(-3.0, 0.0, 0.2);
    const auto pair = std::make_shared<const Vehicle>(
        joined({a, b}, {{JointKind::welded, 0, 1, place, place - offset - lift * Vec3::UnitZ(), 0.0}}));

    const Vec3 way = offset + lift * Vec3::UnitZ();
    const double mass = ahead.mass + behind.mass;
    const Vec3 center = behind.mass / mass * way;  // from the leading mass centre
    Mat3 inertia = ahead.inertia + behind.inertia;
    const auto add = [&inertia](double m, const Vec3& r) {
        inertia += m * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    };
    add(ahead.mass, center);
    add(behind.mass, way - center);
    TrussInput moved = front;
    for (Vec3& node : moved.node)
        node -= center;
    for (Vec3& anchor : moved.anchor)
        anchor -= center;
    const auto one = std::make_shared<const Vehicle>(joined(
        {Unit(RigidBody(mass, inertia), moved, {}, 1.0 + center.z(), Vec3(center.x(), center.y(), 0.0))},
        {}));

    const double speed = 6.0;
    const auto crash = [speed](const std::shared_ptr<const Vehicle>& vehicle, double tolerance) {
        Simulation simulation(Scene(vehicle, laboratory::wall(0.2),
                                    Approach{speed, 50.0 * pi / 180.0, 0.0, 0.0},
                                    laboratory::weightless(tolerance), 0.25));
        laboratory::run(simulation);
        return simulation.state();
    };
    const State exact = crash(one, 1e-6);
    const BodyState& whole = exact.units[0].body;
    double last = infinity;
    for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
        const State state = crash(pair, tolerance);
        const BodyState& body = state.units[0].body;
        const double error =
            (body.position - (whole.position - whole.orientation * center)).norm() / (speed * 0.25) +
            body.orientation.angularDistance(whole.orientation);
        CHECK_CLOSE(error, 0.0, tolerance, "the tolerance asked for");
        CHECK(error < last);
        last = error;
        CHECK_CLOSE(state.energies.impacts, 0.0, 0.0, "no truss is closed");
        CHECK_CLOSE(state.units[1].body.orientation.angularDistance(body.orientation), 0.0, 1e-7,
                    "an angle from a cosine");
        CHECK_CLOSE(widest_gap(*pair, state), 0.0, 1e-11, "closed but for rounding");
    }
}

TEST("a fifth wheel carries a roll moment only where its plates touch") {
    const double limit = 2.0 * pi / 180.0;
    Scene scene = floating(JointKind::fifth_wheel, 1e-3, 0.5);
    scene.vehicle = pair(JointKind::fifth_wheel, limit);
    scene.joints = scene.vehicle->joints;
    scene.settings.output_interval = 1e-3;
    // The trailer rolls about the line from its mass centre to the joint, so that the joint has nothing else to do.
    const double rate = 0.3;
    Simulation simulation = spinning(scene, Vec3::Zero(), {rate, 0.0, 0.0});
    const Totals start = totals(*scene.vehicle, simulation.state());
    laboratory::run(simulation);
    const Totals end = totals(*scene.vehicle, simulation.state());
    CHECK_CLOSE((end.angular - start.angular).norm() / start.angular.norm(), 0.0, 1e-12, "rounding");
    const JointHistory joint = simulation.recorder().resample(simulation.scene()).joints[0];
    int touched = 0;
    double most = 0.0;
    bool before = true;
    for (std::size_t k = 1; k < joint.angles.size(); ++k) {
        const double roll = joint.angles[k].roll, moment = joint.moment[k].norm();
        most = std::max(most, std::abs(roll));
        touched += moment > 0.0;
        before = before && moment == 0.0;
        if (before) CHECK(std::abs(roll) < limit);
        if (moment > 0.0 && before) before = false;
        // Away from the stops there is none.
        if (std::abs(roll) < 0.9 * limit && std::abs(joint.angles[k - 1].roll) < 0.9 * limit)
            CHECK_CLOSE(moment, 0.0, 0.0, "exact");
    }
    CHECK(touched > 0);
    CHECK_CLOSE(most / limit, 1.0, 1e-3, "gap of 1e-6 rad at which plates touch, and a step's curvature");
    CHECK(simulation.state().energies.impacts > 0.0);

    // Pitch and yaw are released.
    scene.vehicle = pair(JointKind::fifth_wheel, limit);
    scene.joints = scene.vehicle->joints;
    Simulation free = spinning(scene, {0.0, 0.2, 0.0}, {0.0, -0.3, 0.0});
    laboratory::run(free);
    const History history = free.recorder().resample(free.scene());
    for (const Vec3& moment : history.joints[0].moment)
        CHECK_CLOSE(moment.norm(), 0.0, 0.0, "exact");
}

TEST("m a is the sum of the forces for each unit, the joint's among them") {
    std::vector<Unit> units;
    units.emplace_back(laboratory::body(), laboratory::front_face(laboratory::w2_curve(), 8, 6),
                       laboratory::four_wheels(), 1.0);
    units.emplace_back(RigidBody(20000.0, Vec3(2e4, 1.5e5, 1.6e5).asDiagonal()), speck(),
                       std::vector<Wheel>{{{-3.0, 1.0, -1.0}, 0.5}, {{-3.0, -1.0, -1.0}, 0.5}}, 1.5,
                       Vec3(-6.0, 0.0, 0.0));
    const auto vehicle = std::make_shared<const Vehicle>(joined(
        units,
        {{JointKind::fifth_wheel, 0, 1, Vec3(-1.4, 0.0, 0.2), Vec3(4.6, 0.0, -0.3), 2.0 * pi / 180.0}}));
    Settings settings;
    Simulation simulation(
        Scene(vehicle, laboratory::wall(0.2), Approach{20.0, 50.0 * pi / 180.0, 0.0, 0.1}, settings, 0.4));
    const double start = simulation.state().energies.total();
    double widest = 0.0, residual = 0.0;
    while (simulation.step()) {
        widest = std::max(widest, widest_gap(*vehicle, simulation.state()));
        residual = std::max(residual, std::abs(simulation.state().energies.total() / start - 1.0));
    }
    CHECK_CLOSE(widest, 0.0, 1e-11, "closed but for rounding");
    CHECK_CLOSE(residual, 0.0, 1e-3, "the tolerance asked for");
    const Energies& energies = simulation.state().energies;
    CHECK_CLOSE(energies.joints / start, 0.0, 1e-4, "the joint's work: the error of its steps only");

    const History history = simulation.recorder().resample(simulation.scene());
    CHECK_CLOSE(history.momentum_residual, 0.0, 1e-9, "rounding of velocities, over the interval");
    double largest = 0.0;
    for (std::size_t k = 0; k < history.time.size(); ++k) {
        CHECK(history.units[0].joint_force[k] == Vec3(-history.units[1].joint_force[k]));
        CHECK_CLOSE((history.units[0].joint_force[k] - history.joints[0].force[k]).norm(), 0.0, 1e-2,
                    "rounding of impulses since the start, over 0.1 ms");
        largest = std::max(largest, history.joints[0].force[k].norm());
    }
    CHECK(largest > 1e5);
    CHECK_CLOSE(history.energy(&Energies::joints).back(), energies.joints, 1e-6 * start, "the last row");
}

TEST("joints that can not be are refused") {
    const auto joining = [](std::size_t a, std::size_t b, const Vec3& on_a, const Vec3& on_b, double limit) {
        return joined({leading(), trailing()}, {{JointKind::fifth_wheel, a, b, on_a, on_b, limit}});
    };
    CHECK_THROWS(joining(0, 2, place_a, place_b, 0.1), InvalidArgument);
    CHECK_THROWS(joining(1, 1, place_a, place_b, 0.1), InvalidArgument);
    CHECK_THROWS(joining(0, 1, place_a, place_b, -0.1), InvalidArgument);
    CHECK_THROWS(joining(0, 1, place_a, place_b, 1.6), InvalidArgument);
    CHECK_THROWS(joining(0, 1, place_a + Vec3(0.0, 0.0, 0.002), place_b, 0.1), InvalidArgument);
    CHECK_THROWS(joining(0, 1, Vec3(infinity, 0.0, 0.0), place_b, 0.1), InvalidArgument);
    CHECK_THROWS(Unit(laboratory::body(), speck(), {}, 1.0, Vec3(0.0, 0.0, 1.0)), InvalidArgument);
    // Up to a millimetre is made good.
    const Vehicle near = joining(0, 1, place_a + Vec3(0.0009, 0.0, 0.0), place_b, 0.1);
    CHECK_CLOSE((near.units[0].place() + near.joints[0].place_on_leading - near.units[1].place() -
                 near.joints[0].place_on_trailing)
                    .norm(),
                0.0, 1e-15, "rounding");
}
