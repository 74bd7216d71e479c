#include "contact/trial.hpp"

#include <algorithm>

#include "scene/bodies.hpp"

namespace birm3d {

namespace {

void clear(ContactImpulses& impulses) {
    std::fill(impulses.tire.begin(), impulses.tire.end(), 0.0);
    std::fill(impulses.sprung.begin(), impulses.sprung.end(), 0.0);
    impulses.tire_friction = Vec3::Zero();
    impulses.obstacles.clear();
    impulses.barrier_normal = 0.0;
    impulses.core_contacts = 0;
    impulses.joints = Vec3::Zero();
}

// Does `is` hold for the impulses on any unit, of lasting contacts or of an impact?
template <class Is>
bool any_impulses(const Trial& trial, const Is& is) {
    return std::any_of(trial.impulses.begin(), trial.impulses.end(), is) ||
           std::any_of(trial.at_start.impulses.begin(), trial.at_start.impulses.end(), is) ||
           std::any_of(trial.at_end.impulses.begin(), trial.at_end.impulses.end(), is);
}

}  // namespace

Trial::Trial(const Vehicle& vehicle) : state(vehicle) {
    for (const Unit& unit : vehicle.units) {
        impulses.emplace_back(unit.wheels.size());
        active.emplace_back(unit.trusses.blocks);
        stale.emplace_back(unit.trusses.blocks);
    }
    at_start.impulses = at_end.impulses = impulses;
    memory.sprung.resize(vehicle.units.size());
    joint_impulses.resize(vehicle.joints.size());
    at_start.joint_impulses = at_end.joint_impulses = joint_impulses;
}

void Trial::restart(const Vehicle& vehicle, const State& from) {
    for (std::size_t u = 0; u < stale.size(); ++u) {
        state.units[u].trusses.reset(vehicle.units[u].trusses);
        stale[u].clear();
        for (const std::size_t block : from.units[u].trusses.met())
            stale[u].add(block);
    }
}

void Trial::begin(const State& from, double step) {
    static_cast<Progress&>(state) = from;
    state.moving_elements = from.moving_elements;
    state.time += step;
    dt = step;
    error = 0.0;
    critical_step = impact_after = infinity;
    at_start.happened = at_end.happened = false;
    by_contacts.assign(body_count(from), Twist{});
    reached.clear();
    for (std::size_t u = 0; u < from.units.size(); ++u) {
        static_cast<UnitMotion&>(state.units[u]) = from.units[u];
        active[u].clear();
        clear(impulses[u]);
        clear(at_start.impulses[u]);
        clear(at_end.impulses[u]);
    }
    for (auto* sums : {&joint_impulses, &at_start.joint_impulses, &at_end.joint_impulses})
        std::fill(sums->begin(), sums->end(), Wrench{});
}

void Trial::exchange_trusses(std::size_t u, TrussState& with) {
    TrussState& trial = state.units[u].trusses;
    for (const std::size_t block : stale[u].blocks())
        if (!active[u].contains(block)) trial.block[block] = with.block[block];
    std::swap(with.block, trial.block);
    stale[u] = active[u];
}

bool Trial::body_rests() const {
    return body_held() || any_impulses(*this, [](const ContactImpulses& sum) {
               return std::any_of(sum.tire.begin(), sum.tire.end(),
                                  [](double impulse) { return impulse > 0.0; });
           });
}

bool Trial::body_held() const {
    return any_impulses(*this, [](const ContactImpulses& sum) { return sum.core_contacts > 0; });
}

bool Trial::body_held_by_barrier() const {
    return any_impulses(*this, [](const ContactImpulses& sum) { return sum.barrier_normal > 0.0; });
}

}  // namespace birm3d
