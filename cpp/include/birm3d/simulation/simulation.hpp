// A run: the scene, its state, the step control and the record.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "birm3d/record/event.hpp"
#include "birm3d/record/recorder.hpp"
#include "birm3d/scene/scene.hpp"

namespace birm3d {

enum class EndReason {
    running,
    duration,   // the time asked for is over
    separated,  // the vehicle has left the barrier and can not come back
    stopped,    // it stands still at the barrier
    sliding,    // it slides along a straight barrier, where nothing can change any more
    longest,    // tolerance::longest_event
};

// One thread at a time: nothing in here is locked.
class Simulation {
  public:
    explicit Simulation(Scene scene);
    Simulation(const Simulation& other);
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    // One accepted step; false when the run is over and nothing was done. Throws UnstableError where a fixed
    // step is beyond the critical one; the state then stands as it was before the step.
    bool step();

    // Did the last step fail half way, such as for want of memory? Then only reset, start and restore are of use.
    bool failed() const { return failed_; }

    // From the present state to the end. `poll` is called now and then; what it throws ends the run.
    void run(const std::function<void()>& poll);

    void reset();

    // Goes to the start of another scene, or of this one with another approach. Memory is reused if the vehicle is
    // the same. Refuses what Scene refuses; after that only another start is of use.
    void start(const Scene& scene);
    void start(const Approach& approach);

    const Scene& scene() const { return scene_; }
    const State& state() const { return state_; }
    const Recorder& recorder() const { return recorder_; }
    const Event& event() const { return event_; }
    EndReason end_reason() const;

    // How deep the deepest shell node and the deepest anchor are inside the barrier now (m); zero where none is.
    double deepest_node() const;
    double deepest_anchor() const;

    struct Snapshot {
        std::uint64_t scene;  // fingerprint of the vehicle and the barrier
        Approach approach;
        Settings settings;
        std::optional<double> duration;
        bool replays;
        State state;
        Recorder recorder;
        Event event;
    };
    Snapshot snapshot() const;

    // Refuses a checkpoint of another vehicle, barrier, approach or settings, and one beyond the duration of this run.
    void restore(const Snapshot& snapshot);

    // Does the same number of steps from the start lead to this state? Not if it was restored from a run of another
    // duration, whose last step was cut short.
    bool replays() const { return replays_; }

  private:
    bool finished() const { return end_reason() != EndReason::running; }
    double remaining() const;  // s
    void accept_trial();
    void adaptive_step();
    void fixed_step();
    // `limit`: of steps (s); `meaning`: what the limit is.
    [[noreturn]] void refuse_step(double dt, double limit, const std::string& meaning) const;

    Scene scene_;
    State state_;
    struct Work;  // memory of the step that is tried: no value in it outlives the step
    std::unique_ptr<Work> work_;
    Recorder recorder_;
    Event event_;
    bool failed_ = false;
    bool replays_ = true;
};

}  // namespace birm3d
