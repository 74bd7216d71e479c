#include "birm3d/simulation/simulation.hpp"

#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

double greatest_force(const Simulation& simulation) {
    const History history = simulation.recorder().resample(simulation.scene());
    double most = 0.0;
    for (const double f : history.units[0].barrier_normal_force)
        most = std::max(most, f);
    return most;
}

// Block of W2 with wheels on a road: everything at once.
Scene busy_scene(double heading, double time_step = 0.0) {
    Settings settings;
    if (time_step > 0.0) settings.time_step = time_step;
    const Vec3 origin(7.0, -3.0, 0.0);
    const double station = origin.dot(Vec3(-std::sin(heading), std::cos(heading), 0.0));
    return {laboratory::block(laboratory::w2_curve(), 10, 10, laboratory::four_wheels(), 1.0),
            laboratory::wall(0.2, heading, origin),
            Approach{15.0, 40.0 * pi / 180.0, station + 0.3, 0.05},
            settings,
            {}};
}

}  // namespace

TEST("W1: an elastic impact has its exact answer, better with every tolerance") {
    const double m = 6804.0, k = 3e6, v = 22.352;
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
        Simulation simulation(laboratory::scene(laboratory::block(laboratory::elastic_curve(k)),
                                                laboratory::wall(), laboratory::weightless(tolerance)));
        laboratory::run(simulation);
        CHECK(simulation.end_reason() == EndReason::separated);
        CHECK_CLOSE(laboratory::deepest(simulation) / (v * std::sqrt(m / k)), 1.0, tolerance,
                    "the tolerance asked for");
        CHECK_CLOSE(greatest_force(simulation) / (v * std::sqrt(m * k)), 1.0, tolerance,
                    "the tolerance asked for");
        CHECK_CLOSE(simulation.state().units[0].body.velocity.x() / v, -1.0, tolerance,
                    "the tolerance asked for");
    }
}

TEST("W2: crush, peak force and rebound are exact within the tolerance, for any number of nodes") {
    // E = k1 d1^2/2 + (F1 + F) x/2 with F = F1 + k2 x; rebound with F^2 / (2 ku).
    const double m = 6804.0, v = 22.352, F1 = 3e6 * 0.4;
    const double rest = 0.5 * m * v * v - 0.5 * 3e6 * 0.4 * 0.4;
    const double x = (-F1 + std::sqrt(F1 * F1 + 2.0 * 6e6 * rest)) / 6e6, F = F1 + 6e6 * x;
    for (const auto& [columns, rows] : {std::pair{1, 1}, {7, 3}, {10, 10}, {40, 25}}) {
        Simulation simulation(laboratory::scene(laboratory::block(laboratory::w2_curve(), columns, rows),
                                                laboratory::wall(), laboratory::weightless()));
        laboratory::run(simulation);
        CHECK_CLOSE(laboratory::deepest(simulation) / (0.4 + x), 1.0, 1e-3, "default tolerance");
        CHECK_CLOSE(greatest_force(simulation) / F, 1.0, 1e-3, "default tolerance");
        CHECK_CLOSE(-simulation.state().units[0].body.velocity.x() / (F / std::sqrt(60e6 * m)), 1.0, 1e-3,
                    "default tolerance");
        const BodyState& body = simulation.state().units[0].body;
        CHECK_CLOSE(body.velocity.tail<2>().norm() + body.angular_momentum.norm() / m, 0.0, 1e-9,
                    "head-on; rounding");
    }
}

TEST("restitution falls with speed where a constant length is given back") {
    // A linear spring of 2 m gives back F r (1 - d/2 m)/6 of F d/2.
    const double m = 6804.0, k = 3e6, recovery = 0.05;
    for (const auto& [columns, rows] : {std::pair{1, 1}, {10, 10}})
        for (const double v : {3.0, 10.0, 22.352}) {
            TrussCurve curve = laboratory::elastic_curve(k);
            curve.recovery = recovery;
            Simulation simulation({laboratory::block(curve, columns, rows),
                                   laboratory::wall(),
                                   Approach{v, 0.5 * laboratory::pi, 0.0, 0.0},
                                   laboratory::weightless(),
                                   {}});
            laboratory::run(simulation);
            const double deep = v * std::sqrt(m / k);
            CHECK(deep > recovery);
            CHECK_CLOSE(laboratory::deepest(simulation) / deep, 1.0, 1e-3, "default tolerance");
            CHECK_CLOSE(-simulation.state().units[0].body.velocity.x() / v,
                        std::sqrt(recovery / (3.0 * deep) * (1.0 - 0.5 * deep)), 1e-3, "default tolerance");
            const Energies& e = simulation.state().energies;
            CHECK_CLOSE(e.total() / (0.5 * m * v * v), 1.0, 1e-3, "default tolerance");
        }
}

TEST("a wall that ploughs along a panel meets the second trusses alone, as a spring") {
    // Sides 1.2 m from the middle, whose own trusses hardly resist; second ones run to the rear.
    const double m = 6804.0, k = 3e6, v = 22.352;
    TrussInput input;
    for (const double side : {-1.2, 1.2})
        for (const double z : {-0.3, 0.0, 0.3}) {
            input.node.emplace_back(3.0, side, z);
            input.anchor.emplace_back(0.5, 0.25 * side, z);
        }
    const std::size_t n = input.node.size();
    input.along_of.assign(n, -1);
    for (std::size_t i = 0; i < n; ++i) {
        input.node.push_back(input.node[i]);
        input.anchor.push_back(input.node[i] - Vec3(3.0, 0.0, 0.0));
        input.along_of.push_back(static_cast<int>(i));
    }
    input.curve = {laboratory::elastic_curve(1e-6 * k), laboratory::elastic_curve(k)};
    input.curve_of.assign(n, 0);
    input.curve_of.resize(2 * n, 1);
    input.scale.assign(2 * n, 1.0 / static_cast<double>(n));
    auto vehicle = std::make_shared<Vehicle>();
    vehicle->units.emplace_back(laboratory::body(), input, std::vector<Wheel>{}, 0.0);
    Simulation simulation(laboratory::scene(vehicle, laboratory::wall(), laboratory::weightless(1e-4)));
    laboratory::run(simulation);
    CHECK_CLOSE(greatest_force(simulation) / (v * std::sqrt(m * k)), 1.0, 1e-4, "the tolerance asked for");
    CHECK_CLOSE(simulation.state().units[0].body.velocity.x() / v, -1.0, 1e-4, "the tolerance asked for");
    CHECK(simulation.state().energies.impacts == 0.0);
}

TEST("energy is kept, and the balance's terms only grow") {
    Simulation simulation(busy_scene(0.0));
    const double start = simulation.state().energies.total();
    Energies last = simulation.state().energies;
    double worst = 0.0;
    while (simulation.step()) {
        const Energies& e = simulation.state().energies;
        worst = std::max(worst, std::abs(e.total() - start));
        // Where nodes stick, friction is found for the motion predicted at the end of the step.
        CHECK(e.barrier_friction >= last.barrier_friction - 1e-11 * start);
        CHECK(e.tire_friction >= last.tire_friction - 1e-11 * start);
        last = e;
    }
    CHECK_CLOSE(worst / start, 0.0, 1e-3, "the tolerance asked for");
    CHECK(last.crushed > 0.1 * start);
    CHECK(last.barrier_friction > 0.0);
    CHECK(last.tire_friction > 0.0);
}

TEST("a scene turned about the vertical gives the same answer, turned") {
    // Until a fixed instant: when a run has ended is decided step by step.
    const auto run_on = [](Simulation& simulation) {
        while (simulation.state().time < 1.0 && simulation.step()) {
        }
    };
    Simulation straight(busy_scene(0.0, 1e-4));
    run_on(straight);
    for (const double heading : {0.7, 0.5 * pi, -2.3}) {
        Simulation turned(busy_scene(heading, 1e-4));
        run_on(turned);
        const Quat back(Eigen::AngleAxisd(-heading, Vec3::UnitZ()));
        const BodyState& a = straight.state().units[0].body;
        const BodyState& b = turned.state().units[0].body;
        const Vec3 origin(7.0, -3.0, 0.0);
        CHECK_CLOSE(straight.state().time, turned.state().time, 2e-4,
                    "a step more or less where rounding decides the end");
        CHECK_CLOSE((back * b.velocity - a.velocity).norm(), 0.0, 1e-6,
                    "rounding, enlarged by contacts that open and close");
        CHECK_CLOSE((back * b.angular_momentum - a.angular_momentum).norm() / 42000.0, 0.0, 1e-6, "the same");
        const Vec3 way = back * (turned.scene().base + b.position - origin) -
                         (straight.scene().base + a.position - origin);
        CHECK_CLOSE(way.norm(), 0.0, 20.0 * 2e-4 + 1e-6, "the way of that step");
        CHECK_CLOSE(laboratory::deepest(turned), laboratory::deepest(straight), 1e-8, "the same");
    }
}

TEST("the same run twice gives the same bits, also after a reset and from a snapshot") {
    Simulation first(busy_scene(0.3)), second(busy_scene(0.3));
    laboratory::run(first);
    laboratory::run(second);
    const std::uint64_t hash = first.state().hash();
    CHECK(second.state().hash() == hash);
    first.reset();
    CHECK(first.state().hash() != hash);
    std::optional<Simulation::Snapshot> snapshot;
    for (int i = 0; first.step(); ++i)
        if (i == 40) snapshot = first.snapshot();
    CHECK(first.state().hash() == hash);
    CHECK(snapshot.has_value());
    if (!snapshot) return;
    second.restore(*snapshot);
    laboratory::run(second);
    CHECK(second.state().hash() == hash);
    CHECK(second.recorder().rows() == first.recorder().rows());
}

TEST("a fixed step beyond the critical one is refused with one that would do") {
    Settings settings = laboratory::weightless();
    settings.time_step = 0.05;
    const Scene scene =
        laboratory::scene(laboratory::block(laboratory::w2_curve()), laboratory::wall(), settings);
    Simulation simulation(scene);
    try {
        laboratory::run(simulation);
        CHECK(false);
    } catch (const UnstableError& error) {
        CHECK(error.time_step == 0.05);
        CHECK(error.limit < 0.05);
        CHECK(std::string(error.what()).find("would do") != std::string::npos);
        CHECK(std::isfinite(simulation.state().energies.total()));
        settings.time_step = 0.5 * error.limit;
        Simulation shorter(laboratory::scene(scene.vehicle, scene.barrier, settings));
        laboratory::run(shorter);
        CHECK(shorter.end_reason() == EndReason::separated);
    }
}

TEST("a run ends for the reason it says") {
    Settings settings;
    const auto vehicle = laboratory::block(laboratory::w2_curve(), 4, 4, laboratory::four_wheels(), 1.0);
    Simulation rolling(Scene(vehicle, nullptr, Approach{10.0, 0.5 * pi, 0.0, 0.0}, settings, 0.5));
    CHECK(rolling.end_reason() == EndReason::running);
    laboratory::run(rolling);
    CHECK(rolling.end_reason() == EndReason::duration);
    CHECK_CLOSE(rolling.state().time, 0.5, 1e-9, "shortest step worth taking");
    CHECK_CLOSE(rolling.state().units[0].body.velocity.x(), 10.0, 1e-9, "a rolling car keeps its speed");
    CHECK_CLOSE(rolling.state().units[0].body.position.z(), 1.0, 1e-9, "and its height");
    CHECK(!rolling.step());
}

TEST("what the poll throws ends the run, which can be taken up again") {
    struct Interrupt {};
    Settings settings;
    settings.time_step = 1e-5;
    const Scene scene = laboratory::scene(laboratory::block(laboratory::w2_curve(), 2, 2), laboratory::wall(),
                                          settings, 0.5 * pi, 0.01);
    Simulation interrupted(scene), whole(scene);
    CHECK_THROWS(interrupted.run([] { throw Interrupt{}; }), Interrupt);
    CHECK(interrupted.end_reason() == EndReason::running);
    laboratory::run(interrupted);
    laboratory::run(whole);
    CHECK(interrupted.state().hash() == whole.state().hash());
}

TEST("where the trusses are closed the rigid body meets the wall, and rebounds as Eq. 1 says") {
    // Trusses far too soft: they take 2 m * 10 kN * 2 of 1.7 MJ, then the anchors are at the wall.
    for (const double degrees : {90.0, 70.0}) {
        for (const double restitution : {0.0, 0.1, 0.5}) {
            Settings settings = laboratory::weightless();
            settings.restitution = restitution;
            Simulation simulation(laboratory::scene(laboratory::block(laboratory::elastic_curve(1e4)),
                                                    laboratory::wall(), settings, degrees * pi / 180.0));
            const double start = simulation.state().energies.total();
            laboratory::run(simulation);
            const State& state = simulation.state();
            const BodyState& body = state.units[0].body;
            CHECK(state.statistics.deepest_point < 1e-4);
            CHECK_CLOSE(state.energies.total() / start, 1.0, 1e-3, "the tolerance asked for");
            CHECK(state.energies.impacts > 0.0);
            CHECK(body.velocity.x() <= 0.0);
            if (degrees == 90.0) {
                // After the impact the springs give back what they hold: v^2 = (xi v1)^2 + k s^2/m.
                const double spring = 1e4 * 2.0 * 2.0 / 6804.0;
                const double before = std::sqrt(22.352 * 22.352 - spring);
                const double exact = std::sqrt(restitution * restitution * before * before + spring);
                CHECK_CLOSE(-body.velocity.x() / exact, 1.0, 1e-3, "the tolerance asked for");
            }
        }
    }
}
