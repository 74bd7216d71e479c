// Adaptive step control: whether a tried step is accepted, and how long the next one is.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "contact/trial.hpp"

namespace birm3d {

// The search for one step.
struct StepSearch {
    double first = 0.0;          // the first to be tried (s)
    double approach = 0.0;       // separation speed of the nodes that push at the start (m/s)
    double error = 0.0;          // estimate of the step tried last, reversals of single nodes included (m/s)
    bool lands = false;          // is the landing on the barrier known?
    double pressing = infinity;  // first step that can be taken when contact begins (s)
    double energy_error = infinity;  // see has_reducible_energy_error()
    double cut = 0.0;  // length that an impact cut off the step (s); the next step is not shortened for it
};

// For a step of at most `longest` (s).
StepSearch begin_search(const Scene& scene, const State& state, double longest);

// Length of a shorter step to try in place of one whose error is too large; infinite where that one is accepted (s).
double shorter_step(const Scene& scene, const State& from, const Trial& tried, StepSearch& search);

// The one after a step that is accepted (s).
double step_after(const Scene& scene, const Trial& accepted, const StepSearch& search);

// When the last load will be zero, extrapolated (s); infinite where that is not known.
double time_to_release(const Scene& scene, const State& state);

}  // namespace birm3d
