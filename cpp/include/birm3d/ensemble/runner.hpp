// Many runs, one after the other in the same memory, of which no histories are kept.
#pragma once

#include <functional>
#include <optional>

#include "birm3d/record/extremes.hpp"
#include "birm3d/simulation/simulation.hpp"

namespace birm3d {

// The end of a run.
struct RunSummary {
    EndReason end_reason = EndReason::running;
    std::uint64_t state_hash = 0;
    StepStatistics statistics;
    Balances balances;
    double run_time = 0.0;               // wall time of the stepping (s)
    Vec3 final_velocity = Vec3::Zero();  // of unit 0, world (m/s)
    double deflection = 0.0;             // greatest of all trusses of all units, at the end (m)
    double peak_deflection = 0.0;        // and during the run (m)
    Event event;
    Extremes extremes;
};

class Runner {
  public:
    // What is run from now on.
    void set_scene(const Scene& scene);

    // From the start of the scene, with an approach of its own, to the end. What comes out follows on nothing that was
    // run before. Throws what Simulation throws, and what `poll` throws, which is called now and then.
    RunSummary run(const Approach& approach, const ExtremeGroups& wanted, const std::function<void()>& poll);

  private:
    std::optional<Simulation> simulation_;
    bool at_start_ = false;
    History history_;
};

}  // namespace birm3d
