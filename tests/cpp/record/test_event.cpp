#include "birm3d/record/event.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

// Upright posts 0.4 m thick along the line x = 0.
std::shared_ptr<const Barrier> posts(const std::vector<double>& at, double height) {
    std::vector<Element> elements;
    for (const double y : at)
        elements.push_back({Post{0.2, height}, Vec3(0.0, y, 0.0), 0.0});
    return std::make_shared<const Barrier>(elements, 0.0, Vec3::Zero(), 0.0);
}

// A body of 4 m by 2 m by 1 m, its mass centre in the middle.
std::shared_ptr<const Vehicle> box() {
    TrussInput input;
    for (const double x : {-2.0, 2.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-0.5, 0.5}) {
                input.node.emplace_back(1.1 * x, y, z);
                input.anchor.emplace_back(x, y, z);
            }
    input.curve = {laboratory::w2_curve()};
    input.curve_of.assign(input.node.size(), 0);
    input.scale.assign(input.node.size(), 0.125);
    Vehicle vehicle;
    vehicle.units.emplace_back(laboratory::body(), input, std::vector<Wheel>{}, 0.0);
    return std::make_shared<const Vehicle>(std::move(vehicle));
}

Scene scene_at(std::shared_ptr<const Barrier> barrier, double offset = 0.0, double angle = 0.5 * pi) {
    return {laboratory::block(laboratory::w2_curve()), std::move(barrier), Approach{20.0, angle, offset, 0.0},
            laboratory::weightless(), 0.5};
}

// Of a whole run without a given end.
Event event_of(const TrussCurve& curve, std::shared_ptr<const Barrier> barrier, double angle,
               double offset = 0.0) {
    Simulation simulation(Scene(laboratory::block(curve), std::move(barrier), Approach{20.0, angle, offset},
                                laboratory::weightless(), {}));
    laboratory::run(simulation);
    CHECK(simulation.event().decided());
    return simulation.event();
}

const StepContact nothing{};
StepContact held() {
    StepContact contact;
    contact.held_by_barrier = true;
    return contact;
}

void put(State& state, const Vec3& position, const Vec3& velocity) {
    state.units[0].body.position = position;
    state.units[0].body.velocity = velocity;
}

}  // namespace

TEST("a rebound straight from a wall is a stop, with the velocity at the loss of contact") {
    const Event event = event_of(laboratory::elastic_curve(3e6), laboratory::wall(), 0.5 * pi);
    CHECK(event.outcome() == Verdict::stopped && event.manner == Manner::rebounds);
    CHECK(event.left && event.separated && !event.crossed && event.later_contacts == 0);
    const double half_period = pi * std::sqrt(6804.0 / 3e6);
    CHECK_CLOSE(event.released_at / half_period, 1.0, 1e-3, "the tolerance");
    CHECK_CLOSE(event.released_velocity.x() / -20.0, 1.0, 1e-3, "the tolerance");
}

TEST("a smooth wall redirects, and takes nothing of the motion along it") {
    const double angle = 25.0 * pi / 180.0;
    const Event event = event_of(laboratory::w2_curve(), laboratory::wall(), angle);
    CHECK(event.outcome() == Verdict::redirected && event.manner == Manner::leaves);
    CHECK_CLOSE(event.released_velocity.y(), 20.0 * std::cos(angle), 1e-9, "rounding");
    CHECK(event.released_velocity.x() <= 0.0);
    CHECK(event.deflection > 0.0);
}

TEST("past one post it goes beside, past two between them") {
    const Event beside = event_of(laboratory::w2_curve(), posts({4.0}, 1.0), 0.5 * pi);
    CHECK(beside.outcome() == Verdict::passed && beside.manner == Manner::beside);
    CHECK(beside.left && !beside.separated && beside.deflection == 0.0);
    const Event between = event_of(laboratory::w2_curve(), posts({-4.0, 4.0}, 1.0), 0.5 * pi);
    CHECK(between.outcome() == Verdict::passed && between.manner == Manner::between);
    const Event end = event_of(laboratory::w2_curve(), posts({-4.0, 4.0}, 1.0), 0.5 * pi, 9.0);
    CHECK(end.manner == Manner::beside);
}

TEST("without a barrier only the up axis is followed") {
    Settings settings = laboratory::weightless();
    const Scene scene(laboratory::block(laboratory::w2_curve()), nullptr, Approach{20.0}, settings, 0.5);
    State state = scene.initial_state();
    Event event = begin_event(scene, state);
    CHECK(event.manner == Manner::no_barrier && event.upright && event.least_upright == 1.0);
    for (const double roll : {1.0, 2.5, 0.3}) {
        state.units[0].body.orientation = Eigen::AngleAxisd(roll, Vec3::UnitX());
        follow_event(scene, state, nothing, event);
    }
    CHECK_CLOSE(event.least_upright, std::cos(2.5), 1e-15, "rounding");
    CHECK(event.rolled_over() && event.outcome() == Verdict::rolled_over && !event.left);
}

TEST("rolling over goes before being held, not before getting past") {
    Event event;
    event.least_upright = -0.2;
    const auto outcome_of = [&](Verdict verdict) {
        event.verdict = verdict;
        return event.outcome();
    };
    CHECK(outcome_of(Verdict::stopped) == Verdict::rolled_over);
    CHECK(outcome_of(Verdict::redirected) == Verdict::rolled_over);
    CHECK(outcome_of(Verdict::undecided) == Verdict::rolled_over);
    CHECK(outcome_of(Verdict::passed) == Verdict::passed);
    CHECK(outcome_of(Verdict::overridden) == Verdict::overridden);
    event.upright = false;  // it lay there from the start
    CHECK(outcome_of(Verdict::stopped) == Verdict::stopped);
}

TEST("over the top: an element stands under the body as it crosses the line") {
    const Scene scene(box(), posts({0.0}, 0.3), Approach{20.0, 0.5 * pi}, laboratory::weightless(), 0.5);
    State state = scene.initial_state();
    Event event = begin_event(scene, state);
    CHECK(event.line == 0.0 && event.towards == Vec3(1.0, 0.0, 0.0));
    put(state, Vec3(-0.1, 0.2, 2.0), Vec3(20.0, 0.0, 0.0));
    follow_event(scene, state, nothing, event);
    CHECK(!event.crossed && !event.over_top);
    put(state, Vec3(0.1, 0.2, 2.0), Vec3(20.0, 0.0, 0.0));
    follow_event(scene, state, nothing, event);
    CHECK(event.crossed && event.over_top && event.crossing == Vec3(0.1, 0.2, 2.0));
    CHECK(!event.left);
    put(state, Vec3(60.0, 0.2, 2.0), Vec3(20.0, 0.0, 0.0));
    follow_event(scene, state, nothing, event);
    CHECK(event.left && !event.separated);
    CHECK(event.outcome() == Verdict::overridden && event.manner == Manner::over);
    CHECK(event.crossing == Vec3(0.1, 0.2, 2.0));  // the first
}

TEST("what has left for good has its verdict; contacts after that are counted as they begin") {
    const Scene scene = scene_at(laboratory::wall());
    State state = scene.initial_state();
    Event event = begin_event(scene, state);
    state.touched = true;
    follow_event(scene, state, held(), event);
    CHECK(event.touching && event.later_contacts == 0);
    put(state, Vec3(-3.5, 0.0, 0.0), Vec3(-5.0, 0.0, 0.0));
    StepContact contact;
    contact.begin = 0.1, contact.released = 0.002;
    state.time = 0.11;
    follow_event(scene, state, contact, event);
    CHECK_CLOSE(event.released_at, 0.102, 1e-15, "rounding");
    CHECK(event.released_velocity == Vec3(-5.0, 0.0, 0.0));
    CHECK(event.left && event.separated && event.verdict == Verdict::stopped);
    for (const bool touches : {true, true, false, true, false})
        follow_event(scene, state, touches ? held() : nothing, event);
    CHECK(event.later_contacts == 2);
    CHECK_CLOSE(event.released_at, 0.102, 1e-15, "of the separation, not of later contacts");
    CHECK(event.verdict == Verdict::stopped && event.manner == Manner::rebounds);
}

TEST("what comes to rest is stopped, at the barrier or before it") {
    for (const bool touched : {false, true}) {
        const Scene scene = scene_at(laboratory::wall());
        State state = scene.initial_state();
        Event event = begin_event(scene, state);
        CHECK(!is_decided(scene, state, event) && event.manner == Manner::moving);
        put(state, Vec3(-4.0, 0.0, 0.0), Vec3::Zero());
        state.energies.kinetic = 0.0;
        state.touched = touched;
        CHECK(is_decided(scene, state, event));
        CHECK(event.outcome() == Verdict::stopped);
        CHECK(event.manner == (touched ? Manner::rests : Manner::rests_untouched));
    }
}

TEST("the event depends neither on the duration nor on the place of the scene") {
    const auto run_for = [](std::optional<double> duration, const Vec3& origin) {
        Settings settings;
        Simulation simulation(
            Scene(laboratory::block(laboratory::w2_curve(), 10, 10, laboratory::four_wheels(), 1.0),
                  laboratory::wall(0.2, 0.0, origin), Approach{15.0, 1.2, origin.y() + 0.3, 0.05}, settings,
                  duration));
        laboratory::run(simulation);
        return simulation.event();
    };
    const Event usual = run_for({}, Vec3::Zero());
    CHECK(usual.separated);
    for (const auto& [duration, origin] :
         {std::pair<std::optional<double>, Vec3>{2.5, Vec3::Zero()}, {{}, Vec3(1000.0, -1000.0, 0.0)}}) {
        const Event other = run_for(duration, origin);
        CHECK(other.verdict == usual.verdict && other.manner == usual.manner);
        CHECK(other.released_at == usual.released_at);
        CHECK(other.released_velocity == usual.released_velocity);
    }
}
