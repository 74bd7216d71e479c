#include "step/step_statistics.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Counts an element of the barrier the first time that it is near.
void count_near(const Scene& scene, std::size_t obstacle, State& state) {
    if (obstacle == scene.ground) return;
    const std::size_t element = scene.obstacles[obstacle].element;
    if (state.was_near[element] != 0) return;
    state.was_near[element] = 1;
    ++state.statistics.near_elements;
}

// The time over which forces on the rigid core are averaged: the force of one step says nothing (s).
constexpr double core_mean = 0.05;

void note_core_impulse(const Scene& scene, const Trial& accepted, State& state) {
    Vec3 impulse = Vec3::Zero();
    for (const auto* impulses : {&accepted.impulses, &accepted.at_start.impulses, &accepted.at_end.impulses})
        for (const ContactImpulses& sum : *impulses)
            for (const ObstacleImpulse& on : sum.obstacles)
                if (on.obstacle != scene.ground) impulse += on.impulse;
    if (impulse == Vec3::Zero()) return;
    std::vector<CoreImpulse>& recent = state.core_impulses;
    std::erase_if(recent, [&](const CoreImpulse& one) { return one.time <= state.time - core_mean; });
    recent.push_back({state.time, impulse});
    Vec3 sum = Vec3::Zero();
    for (const CoreImpulse& one : recent)
        sum += one.impulse;
    const double force = sum.norm() / core_mean;
    if (force <= state.statistics.core_contact_force) return;
    state.statistics.core_contact_force = force;
    state.statistics.core_contact_time = state.time;
}

}  // namespace

void count_step(const Scene& scene, const Trial& accepted, State& state) {
    StepStatistics& statistics = state.statistics;
    statistics.steps += 1;
    statistics.shortest_step = std::min(statistics.shortest_step, accepted.dt);
    statistics.longest_step = std::max(statistics.longest_step, accepted.dt);
    statistics.least_critical_step = std::min(statistics.least_critical_step, accepted.critical_step);
    if (std::all_of(accepted.active.begin(), accepted.active.end(),
                    [](const BlockSet& active) { return active.blocks().empty(); })) {
        ++statistics.free_steps;
        statistics.free_time += accepted.dt;
    }
    for (const std::size_t obstacle : accepted.reached)
        count_near(scene, obstacle, state);
    for (std::size_t u = 0; u < accepted.impulses.size(); ++u) {
        const ContactImpulses* const sums[] = {&accepted.impulses[u], &accepted.at_start.impulses[u],
                                               &accepted.at_end.impulses[u]};
        for (const ContactImpulses* sum : sums)
            for (const ObstacleImpulse& on : sum->obstacles)
                if (on.impulse != Vec3::Zero()) count_near(scene, on.obstacle, state);
        for (std::size_t w = 0; w < accepted.impulses[u].tire.size(); ++w)
            statistics.wheels_on_ground += std::any_of(std::begin(sums), std::end(sums),
                                                       [w](const auto* sum) { return sum->tire[w] > 0.0; });
    }
    statistics.body_steps += accepted.body_held();
    note_core_impulse(scene, accepted, state);
    statistics.wheels_given_way = 0;
    for (const UnitState& unit : state.units) {
        statistics.wheels_given_way += static_cast<std::uint64_t>(std::popcount(unit.given_way));
        if (state.touched)
            statistics.fastest_rise = std::max(statistics.fastest_rise, unit.body.velocity.z());
    }
    if (scene.tilts())
        for (const BodyState& post : state.moving_elements)
            statistics.greatest_tilt = std::max(statistics.greatest_tilt, tilt_of(post));
}

}  // namespace birm3d
