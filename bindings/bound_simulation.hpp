// A simulation as Python has it: one user at a time. Runs leave the interpreter's lock, so that another thread could
// come in the midst of a step; it is refused instead.
#pragma once

#include <atomic>
#include <stdexcept>
#include <utility>

#include "birm3d/simulation/simulation.hpp"

namespace birm3d::bindings {

class BusyError : public std::runtime_error {
  public:
    BusyError()
        : std::runtime_error(
              "simulation is in use: another thread, or the call that a signal handler interrupts, has it; "
              "give "
              "each thread its own (copy.deepcopy(simulation)), or run many with birm3d.ensemble") {}
};

// Taken by at most one user.
class UseFlag {
  public:
    void take() {
        if (taken_.exchange(true, std::memory_order_acquire)) throw BusyError();
    }
    void release() { taken_.store(false, std::memory_order_release); }

  private:
    std::atomic<bool> taken_ = false;
};

// Takes a flag for its own lifetime.
class Use {
  public:
    explicit Use(UseFlag& flag) : flag_(flag) { flag_.take(); }
    ~Use() { flag_.release(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

  private:
    UseFlag& flag_;
};

class BoundSimulation : public Simulation {
  public:
    using Simulation::Simulation;

    UseFlag in_call;   // by a function of the core
    UseFlag in_block;  // by a `with` block of Python, which makes several calls
};

// The same function of a simulation that nobody else uses meanwhile.
template <class Result, class... Arguments>
auto alone(Result (*function)(Simulation&, Arguments...)) {
    return [function](BoundSimulation& simulation, Arguments... arguments) -> Result {
        const Use use(simulation.in_call);
        return function(simulation, std::forward<Arguments>(arguments)...);
    };
}

}  // namespace birm3d::bindings
