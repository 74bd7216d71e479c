#include "birm3d/model/truss_law.hpp"

#include <stdexcept>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

namespace {

// 100 N/m to 0.2 m, 300 N/m to 50 N (0.3 m), plateau; unloading 1000 N/m.
const TrussCurve curve = knee_curve(100.0, 0.2, 300.0, 50.0, 1000.0);

// A truss led through deflections; force at the last, work done on it by straight lines between them.
struct Path {
    TrussMemory memory;
    double deflection = 0.0, force = 0.0, work = 0.0;

    void to(double d) {
        const double next = truss_force(curve, memory, d);
        work += 0.5 * (force + next) * (d - deflection);
        deflection = d;
        force = next;
    }
};

}  // namespace

TEST("the three segments of Fig. 3") {
    CHECK_CLOSE(envelope_force(curve, -0.1), 0.0, 0.0, "exact");
    CHECK_CLOSE(envelope_force(curve, 0.1), 10.0, 1e-14, "rounding");
    CHECK_CLOSE(envelope_force(curve, 0.2), 20.0, 1e-14, "rounding");
    CHECK_CLOSE(envelope_force(curve, 0.25), 35.0, 1e-13, "rounding");
    CHECK_CLOSE(envelope_force(curve, 0.3), 50.0, 1e-13, "rounding");
    CHECK_CLOSE(envelope_force(curve, 5.0), 50.0, 1e-12, "rounding: the sum of hinges cancels");
}

TEST("unloading and reloading run on one line") {
    Path truss;
    truss.to(0.25);
    CHECK_CLOSE(truss.force, 35.0, 1e-13, "rounding");
    truss.to(0.235);
    CHECK_CLOSE(truss.force, 20.0, 1e-12, "k_unloading times 15 mm below the peak");
    truss.to(0.245);
    CHECK_CLOSE(truss.force, 30.0, 1e-12, "back on the same line");
    truss.to(0.26);
    CHECK_CLOSE(truss.force, 38.0, 1e-12, "on the envelope again");
    truss.to(0.1);
    CHECK_CLOSE(truss.force, 0.0, 0.0, "exact: a truss pulls at nothing");
    truss.to(0.222);
    CHECK_CLOSE(truss.force, 0.0, 1e-12, "residual deflection 0.26 - 38/1000");
}

TEST("with a recovery the same length is given back from any force") {
    TrussCurve giving = curve;
    giving.recovery = 0.02;
    for (const double turn : {0.25, 0.29, 1.0}) {
        TrussMemory memory;
        const double peak = truss_force(giving, memory, turn);
        CHECK(5.0 * peak / giving.recovery > giving.k_unloading);
        CHECK_CLOSE(truss_force(giving, memory, turn - 0.01), peak / 32.0, 1e-12, "half way");
        CHECK_CLOSE(truss_force(giving, memory, turn - 0.02), 0.0, 1e-12, "all of it");
        CHECK_CLOSE(truss_force(giving, memory, turn), peak, 1e-12, "back on the same curve");
    }
    TrussMemory gentle;
    giving.recovery = 0.08;
    CHECK_CLOSE(truss_force(giving, gentle, 0.1), 10.0, 1e-14, "rounding");
    CHECK_CLOSE(truss_force(giving, gentle, 0.075), 10.0 / 32.0, 1e-12,
                "k_unloading is the least slope: 5 cm");
    TrussMemory shallow;
    CHECK_CLOSE(truss_force(giving, shallow, 0.01), 1.0, 1e-14, "rounding");
    CHECK_CLOSE(truss_force(giving, shallow, 0.005), 0.0, 1e-12,
                "a least slope lets half of the crush come back");
    giving.k_unloading = 400.0;
    TrussMemory soft;
    CHECK_CLOSE(truss_force(giving, soft, 0.01), 1.0, 1e-14, "rounding");
    CHECK_CLOSE(truss_force(giving, soft, 0.005), 1.0 / 32.0, 1e-12, "no more than the crush comes back");
}

TEST("no path of a truss with a recovery gains energy, and a loop returns a sixth of force times length") {
    TrussCurve giving = curve;
    giving.recovery = 0.08;
    TrussMemory memory;
    double before = 0.0, force = 0.0, work = 0.0, least = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const double d = 0.4 * std::abs(std::sin(0.037 * i) * std::sin(0.0011 * i));
        const double next = truss_force(giving, memory, d);
        work += 0.5 * (force + next) * (d - before);
        before = d, force = next;
        least = std::min(least, work);
    }
    CHECK(least >= -1e-6);
    TrussMemory loop;
    const double peak = truss_force(giving, loop, 0.6);
    double returned = 0.0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i)
        returned += truss_force(giving, loop, 0.6 - 0.08 * (i + 0.5) / steps) * 0.08 / steps;
    CHECK_CLOSE(returned / (peak * 0.08 / 6.0), 1.0, 1e-6, "midpoint rule");
}

TEST("loading undoes no crush, however steep the envelope gets") {
    TrussCurve tailed = with_tail(knee_curve(500.0, 0.02, 0.0, infinity, 10000.0), 0.3, 8500.0);
    tailed.recovery = 0.09;
    const auto lead = [&](int steps) {
        TrussMemory memory;
        double force = 0.0, work = 0.0, crushed = 0.0;
        for (int i = 1; i <= steps; ++i) {
            const double next = truss_force(tailed, memory, 0.33 * i / steps);
            work += 0.5 * (force + next) * 0.33 / steps;
            force = next;
            const double now = work - memory.peak_force * memory.length / 6.0;
            CHECK(now >= crushed - 10.0 * 0.33 / steps * 0.33 / steps * tailed.slope.back());
            crushed = now;
        }
        return memory.length;
    };
    const double length = lead(4000);
    CHECK(length < 0.9 * 5.0 * envelope_force(tailed, 0.33) / tailed.k_unloading);
    CHECK_CLOSE(lead(400) / length, 1.0, 2e-3, "of second order in the step");
    CHECK_CLOSE(lead(1600) / length, 1.0, 2e-4, "the same");
}

TEST("a recovery above the longest stands for none") {
    TrussCurve giving = curve;
    giving.recovery = 10.0 * longest_recovery;
    TrussMemory memory, memory_of_line;
    for (const double d : {0.3, 0.28, 0.26, 0.5, 0.45})
        CHECK(truss_force(giving, memory, d) == truss_force(curve, memory_of_line, d));
    CHECK(has_recovery(longest_recovery) && !has_recovery(giving.recovery));
    CHECK(!TrussMesh(laboratory::front_face(giving, 2, 2)).recovers);
}

TEST("powers in both orders are exact for whole numbers") {
    static_assert(power_by_squares<7>(3.0) == 2187.0 && power_in_turn<7>(3.0) == 2187.0);
    CHECK(power_by_squares<recovery_degree>(2.0) == 32.0 && power_in_turn<recovery_degree>(2.0) == 32.0);
    CHECK(power_by_squares<line_degree>(0.1) == 0.1 && power_in_turn<line_degree>(0.1) == 0.1);
}

TEST("a tail makes the envelope steeper from its depth on") {
    const TrussCurve tailed = with_tail(curve, 0.5, 400.0);
    CHECK_CLOSE(envelope_force(tailed, 0.5), 50.0, 1e-12, "rounding");
    CHECK_CLOSE(envelope_force(tailed, 0.7), 130.0, 1e-12, "the plateau, and 0.2 m of the tail");
    const TrussCurve early = with_tail(curve, 0.25, 400.0);
    CHECK_CLOSE(envelope_force(early, 0.2), 20.0, 1e-12, "before it");
    CHECK_CLOSE(envelope_force(early, 0.3), 70.0, 1e-12, "within a slope");
    require_valid(early, "");
    CHECK_THROWS(with_tail(curve, 0.0, 1.0), std::invalid_argument);
    CHECK_THROWS(with_tail(curve, 0.5, -1.0), std::invalid_argument);
    CHECK_THROWS(require_valid(with_tail(curve, 0.5, 2000.0), ""), std::invalid_argument);
    TrussCurve steep = with_tail(curve, 0.5, 2000.0);
    steep.recovery = 0.02;  // from 50 N it unloads with 2500 N/m
    require_valid(steep, "");
}

TEST("a closed loop costs the area of the envelope less what unloading returns") {
    Path truss;
    // Straight pieces end at the knees, so that the trapezoid rule is exact.
    for (const double d : {0.2, 0.3, 0.4, 0.35})
        truss.to(d);
    const double area = 0.5 * 0.2 * 20.0 + 0.1 * 35.0 + 0.1 * 50.0;
    CHECK_CLOSE(truss.work, area - 0.5 * 50.0 * 0.05, 1e-13, "rounding");
}

TEST("no deflection path gains energy") {
    Path truss;
    double least = 0.0;
    for (int i = 0; i < 10000; ++i) {
        const double d = 0.4 * std::abs(std::sin(0.37 * i) * std::sin(0.0011 * i));
        truss.to(d);
        least = std::min(least, truss.work - 0.5 * truss.force * truss.force / curve.k_unloading);
    }
    // The trapezoid rule across a kink may err in favour of the truss by this much: k_unloading * step^2.
    CHECK(least >= -1e-9);
}

TEST("knee and plateau may lie at infinity") {
    const TrussCurve elastic = knee_curve(100.0, infinity, 0.0, infinity, 100.0);
    CHECK_CLOSE(envelope_force(elastic, 7.0), 700.0, 1e-12, "rounding");
    const TrussCurve plastic = knee_curve(100.0, infinity, 0.0, 50.0, 100.0);
    CHECK_CLOSE(envelope_force(plastic, 7.0), 50.0, 1e-12, "rounding");
    const TrussCurve early = knee_curve(100.0, 2.0, 300.0, 50.0, 300.0);
    CHECK_CLOSE(envelope_force(early, 1.9), 50.0, 1e-12, "the plateau begins before the knee");
}

TEST("a curve through points passes through them and stays at its last force") {
    const TrussCurve points = point_curve({0.0, 0.1, 0.3, 0.4}, {0.0, 20.0, 10.0, 30.0}, 500.0);
    for (const auto& [d, f] : {std::pair{0.1, 20.0}, {0.2, 15.0}, {0.3, 10.0}, {0.4, 30.0}, {2.0, 30.0}})
        CHECK_CLOSE(envelope_force(points, d), f, 1e-12, "rounding");
    require_valid(points, "");
}

TEST("a curve that is no law is refused") {
    CHECK_THROWS(require_valid(knee_curve(100.0, 0.2, 300.0, 50.0, 200.0), ""), std::invalid_argument);
    CHECK_THROWS(require_valid(knee_curve(100.0, 0.2, 300.0, 50.0, 0.0), ""), std::invalid_argument);
    CHECK_THROWS(knee_curve(-1.0, 0.2, 300.0, 50.0, 1000.0), std::invalid_argument);
    CHECK_THROWS(knee_curve(100.0, 0.0, 300.0, 50.0, 1000.0), std::invalid_argument);
    CHECK_THROWS(knee_curve(100.0, 0.2, infinity, 50.0, 1000.0), std::invalid_argument);
    CHECK_THROWS(point_curve({0.0, 0.1}, {1.0, 2.0}, 100.0), std::invalid_argument);
    CHECK_THROWS(point_curve({0.0, 0.1, 0.1}, {0.0, 2.0, 3.0}, 100.0), std::invalid_argument);
    CHECK_THROWS(point_curve({0.0, 0.1}, {0.0, -2.0}, 100.0), std::invalid_argument);
}
