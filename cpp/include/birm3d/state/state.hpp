// Everything that changes during a run. A copy of it is a checkpoint: nothing is hidden elsewhere.
#pragma once

#include <cstdint>
#include <vector>

#include "birm3d/base/hash.hpp"
#include "birm3d/model/vehicle.hpp"
#include "birm3d/state/balances.hpp"
#include "birm3d/state/body_state.hpp"
#include "birm3d/state/contacts.hpp"
#include "birm3d/state/energies.hpp"
#include "birm3d/state/truss_state.hpp"

namespace birm3d {

// The state of a unit without its trusses. It is small and is copied with every step that is tried.
struct UnitMotion {
    BodyState body;
    SkinForces skin;                         // at this instant
    std::vector<ContactLoad> contact_loads;  // in the order of the obstacles
    std::vector<IndentedPanels> indented;    // the same
    std::vector<double> wheel_loads;         // see follow_loads(); empty where no wheel can give way
    WheelSet given_way = 0;                  // wheels that were loaded beyond what they carry
    double steering_angle = 0.0;             // of the wheels that steer, to the left (rad)
};

struct UnitState : UnitMotion {
    explicit UnitState(const Unit& unit) : trusses(unit.trusses) {}

    // Back to how it was made, in the same memory.
    void reset(const Unit& unit) {
        body = {};
        skin = {};
        contact_loads.clear();
        indented.clear();
        wheel_loads.clear();
        given_way = 0;
        steering_angle = 0.0;
        trusses.reset(unit.trusses);
    }

    TrussState trusses;
};

// How the steps went so far.
struct StepStatistics {
    std::uint64_t steps = 0;
    std::uint64_t rejected = 0;
    std::uint64_t node_evaluations = 0;     // of rejected steps too
    double shortest_step = infinity;        // s
    double longest_step = 0.0;              // s
    double least_critical_step = infinity;  // s, sqrt(3)/omega of the trusses in contact
    double deepest_point =
        0.0;  // greatest depth of a truss's anchor inside a barrier at the end of a step (m)
    double greatest_overlap =
        0.0;  // of the rigid body's boxes with an element; see src/scene/body_overlap.hpp (m)
    double greatest_overlap_time = 0.0;        // when (s)
    std::size_t greatest_overlap_element = 0;  // with which

    // Counts of what accepted steps computed. "Near" means within reach of a block of nodes, or met by the rigid
    // body.
    std::uint64_t skin_nodes =
        0;  // nodes of the skin in blocks that anything has come into, each counted once
    std::uint64_t tire_nodes = 0;     // the same of tyres
    std::uint64_t near_elements = 0;  // of the barrier, that were near in any step
    std::uint64_t free_steps = 0;     // steps in which no node was near anything
    double free_time = 0.0;           // their sum (s)
    std::uint64_t body_steps = 0;     // steps in which the rigid body stood against the barrier or the ground
    double core_contact_force = 0.0;  // greatest mean over 50 ms of the barrier's force on the rigid core (N)
    double core_contact_time = 0.0;   // when (s)
    // Greatest upward speed of a unit's mass centre after the barrier was touched (m/s).
    double fastest_rise = 0.0;
    double greatest_tilt = 0.0;          // of a post that yields, from the vertical (rad)
    std::uint64_t wheels_on_ground = 0;  // wheels that carried load, summed over the steps
    std::uint64_t wheels_given_way = 0;  // wheels that were loaded beyond what they carry
};

// An impulse of the barrier on the rigid core.
struct CoreImpulse {
    double time;   // s
    Vec3 impulse;  // world axes (N s)
};

// How far a run has come.
struct Progress {
    double time = 0.0;  // s
    Energies energies;
    double truss_work = 0.0;  // all work done on trusses: stored + crushed (J)
    double next_step = 0.0;   // s, proposed by the step control
    bool touched = false;     // has the barrier been touched at all?
    bool decided = false;     // is the outcome of the run known?
    double decided_at = 0.0;  // s
    StepStatistics statistics;
    std::vector<CoreImpulse> core_impulses;  // of the last 50 ms
};

struct State : Progress {
    explicit State(const Vehicle& vehicle) {
        for (const Unit& unit : vehicle.units)
            units.emplace_back(unit);
    }

    // Back to how it was made, in the same memory; of the same vehicle.
    void reset(const Vehicle& vehicle) {
        static_cast<Progress&>(*this) = {};
        for (std::size_t u = 0; u < units.size(); ++u)
            units[u].reset(vehicle.units[u]);
        moving_elements.clear();
        balances = {};
    }

    std::vector<UnitState> units;
    // Of the barrier, where they are free-standing or yield; else none.
    std::vector<BodyState> moving_elements;
    std::vector<char> was_near;  // (elements of the barrier) in any step? Statistics only
    Balances balances;           // the same

    std::uint64_t hash() const {
        Hash hash;
        hash.add(time);
        const auto add_body = [&hash](const BodyState& body) {
            hash.add(body.position);
            hash.add(body.orientation);
            hash.add(body.velocity);
            hash.add(body.angular_momentum);
        };
        for (const UnitState& unit : units) {
            add_body(unit.body);
            unit.trusses.add_to(hash);
            if (unit.given_way != 0) hash.add(static_cast<double>(unit.given_way));
            if (unit.steering_angle != 0.0) hash.add(unit.steering_angle);
            for (const IndentedPanels& indented : unit.indented) {
                hash.add(Vec3(static_cast<double>(indented.obstacle), indented.panels, indented.passed));
                for (const double behind : indented.behind)
                    if (behind != 0.0) hash.add(behind);
            }
        }
        for (const BodyState& element : moving_elements)
            add_body(element);
        hash.add(energies.total());
        return hash.value();
    }
};

}  // namespace birm3d
