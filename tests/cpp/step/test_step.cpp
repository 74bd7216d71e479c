#include "step/step.hpp"

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;

TEST("a step that is tried and not accepted leaves no trace") {
    const Scene scene = laboratory::scene(laboratory::block(laboratory::w2_curve()), laboratory::wall(0.2),
                                          laboratory::weightless(), 1.0);
    State state = scene.initial_state();
    State untouched = state;
    Trial trial(*scene.vehicle), clean(*scene.vehicle);
    for (int i = 0; i < 60; ++i) {
        const std::uint64_t before = state.hash();
        try_step(scene, state, 3e-3, {}, trial);  // too long a step, thrown away
        CHECK(state.hash() == before);
        try_step(scene, state, 1e-3, {}, trial);
        accept(scene, trial, state);
        try_step(scene, untouched, 1e-3, {}, clean);
        accept(scene, clean, untouched);
        CHECK(state.hash() == untouched.hash());
    }
    CHECK(state.touched);
    CHECK(state.statistics.steps == 60);
    CHECK(state.statistics.skin_nodes == 100);
    CHECK(state.statistics.skin_nodes == untouched.statistics.skin_nodes);
    CHECK(state.statistics.near_elements == 1);
    CHECK(state.statistics.near_elements == untouched.statistics.near_elements);
    CHECK(state.statistics.free_steps == untouched.statistics.free_steps);
    CHECK(state.statistics.node_evaluations == untouched.statistics.node_evaluations);
}

TEST("the critical step is that of a mass on all unloading springs") {
    const Scene scene = laboratory::scene(laboratory::block(laboratory::w2_curve(), 1, 1), laboratory::wall(),
                                          laboratory::weightless());
    const State state = scene.initial_state();
    Trial trial(*scene.vehicle);
    try_step(scene, state, 1e-3, {}, trial);
    // One node on the line through the mass centre: nothing but the mass stands against it.
    const double exact = std::sqrt(3.0) * std::sqrt(6804.0 / 60e6);
    CHECK(trial.critical_step <= exact);
    CHECK(trial.critical_step >= 0.999 * exact);
}

TEST("the error estimate of a smooth force is of third order, and zero in free flight") {
    const Scene scene = laboratory::scene(laboratory::block(laboratory::elastic_curve(3e6)),
                                          laboratory::wall(), laboratory::weightless());
    const auto estimate = [&](double dt) {
        State state = scene.initial_state();
        Trial trial(*scene.vehicle);
        for (double t = 0.0; t < 0.03; t += dt) {
            try_step(scene, state, dt, {}, trial);
            accept(scene, trial, state);
        }
        return trial.error;
    };
    // dt/8 times the third difference of the acceleration.
    CHECK_CLOSE(estimate(1e-3) / estimate(0.5e-3), 16.0, 1.0,
                "fourth power of the step; the instants differ by a step");
    const Scene flight(scene.vehicle, nullptr, scene.approach, scene.settings, 1.0);
    const State state = flight.initial_state();
    Trial trial(*flight.vehicle);
    try_step(flight, state, 0.1, {.locate_impacts = true}, trial);
    CHECK_CLOSE(trial.error, 0.0, 0.0, "exact");
}
