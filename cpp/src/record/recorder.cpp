#include "birm3d/record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "birm3d/base/error.hpp"
#include "birm3d/base/rotation.hpp"
#include "contact/trial.hpp"
#include "kernels/integrate.hpp"
#include "record/recorder_rows.hpp"

namespace birm3d {

namespace {

// Numbers that the record of a run holds at the most, one row a step: 0.8 GB.
constexpr double most_recorded = 1e8;

// Refuses fixed steps that are more than a record holds.
void require_room(const Scene& scene, std::size_t width) {
    if (!scene.settings.time_step || !scene.duration) return;
    const double most = std::floor(most_recorded / static_cast<double>(width));
    const double end = *scene.duration, step = *scene.settings.time_step;
    if (end / step > most)
        refuse("time_step",
               "at least " + to_text(1.005 * end / most, 3) + " s for the " + to_text(end) +
                   " s of the run to be at most " + std::to_string(static_cast<long>(most)) + " steps",
               step);
}

}  // namespace

Recorder::Recorder(const Scene& scene, const State& start) {
    restart(scene, start);
}

void Recorder::restart(const Scene& scene, const State& start) {
    std::vector<ContactImpulses> none;
    width_ = at_units;
    for (const Unit& unit : scene.vehicle->units) {
        width_ += unit_width(unit);
        none.emplace_back(unit.wheels.size());
    }
    width_ += joint_width * scene.vehicle->joints.size() + element_width * start.moving_elements.size();
    require_room(scene, width_);
    values_.clear();
    obstacles_.clear();
    add_row(scene, start.time, start.energies,
            {start.units, nullptr, start.moving_elements, none,
             std::vector<Wrench>(scene.vehicle->joints.size()), false});
}

bool Recorder::full() const {
    const std::size_t numbers = values_.size() + obstacles_.size() * (sizeof(ObstacleRow) / sizeof(double));
    return static_cast<double>(numbers) > most_recorded;
}

void Recorder::add(const Scene& scene, const Trial& accepted) {
    const State& state = accepted.state;
    if (rows() == 1)
        values_.reserve(512 * width_);  // not before the first step: a simulation may never be run
    if (accepted.at_start.happened) {
        // The forces of that instant are those of the row before.
        const std::size_t before = values_.size() - width_;
        const std::size_t last = rows() - 1;
        add_row(scene, values_[before + at_time], accepted.at_start.energies,
                {state.units, &accepted.at_start.bodies, accepted.at_start.moving_elements,
                 accepted.at_start.impulses, accepted.at_start.joint_impulses, false});
        const double* from = values_.data() + before + at_units;
        double* to = values_.data() + values_.size() - width_ + at_units;
        for (const Unit& unit : scene.vehicle->units) {
            std::copy(from + at_barrier_force, from + at_tire_friction, to + at_barrier_force);
            std::copy(from + at_ground_force, from + at_ground_impulse, to + at_ground_force);
            from += unit_width(unit), to += unit_width(unit);
        }
        for (ObstacleRow& row : obstacles_)
            if (row.row == last + 1) std::fill_n(row.values.begin() + at_load, 6, 0.0);
        for (std::size_t i = 0, count = obstacles_.size(); i < count; ++i)
            if (obstacles_[i].row == last)
                std::copy_n(obstacles_[i].values.begin() + at_load, 6,
                            obstacle_row(last + 1, obstacles_[i].obstacle).values.begin() + at_load);
    }
    const Impact& end = accepted.at_end;
    add_row(scene, state.time, end.happened ? end.energies : state.energies,
            {state.units, end.happened ? &end.bodies : nullptr,
             end.happened ? end.moving_elements : state.moving_elements, accepted.impulses,
             accepted.joint_impulses, true});
    if (end.happened)
        add_row(scene, state.time, state.energies,
                {state.units, nullptr, state.moving_elements, end.impulses, end.joint_impulses, false});
}

Recorder::ObstacleRow& Recorder::obstacle_row(std::size_t row, std::size_t obstacle) {
    for (auto known = obstacles_.rbegin(); known != obstacles_.rend() && known->row == row; ++known)
        if (known->obstacle == obstacle) return *known;
    obstacles_.push_back({row, obstacle, {}});
    return obstacles_.back();
}

// Over 60 lines: the numbers of a row are written one after the other, in their order.
void Recorder::add_row(const Scene& scene, double time, const Energies& e, const Loads& loads) {
    const std::size_t index = rows();
    const std::size_t begin = values_.size();
    values_.resize(begin + width_);
    double* row = values_.data() + begin;
    const auto put = [](double* to, const Vec3& v) { std::copy_n(v.data(), 3, to); };
    const auto add_to = [](double* to, const Vec3& v) {
        for (int i = 0; i < 3; ++i)
            to[i] += v[i];
    };
    row[at_time] = time;
    for (std::size_t i = 0; i < energy_terms.size(); ++i)
        row[at_energies + i] = e.*energy_terms[i].value;
    row += at_units;
    for (std::size_t u = 0; u < loads.units.size(); ++u) {
        const BodyState& body = loads.bodies ? (*loads.bodies)[u] : loads.units[u].body;
        const Unit& model = scene.vehicle->units[u];
        const ContactImpulses& impulses = loads.impulses[u];
        put(row + at_position, body.position);
        std::copy_n(body.orientation.coeffs().data(), 4, row + at_orientation);
        put(row + at_velocity, body.velocity);
        put(row + at_angular_velocity, body.orientation.conjugate() * angular_velocity(model.body, body));
        put(row + at_tire_friction, impulses.tire_friction);
        put(row + at_joint_impulse, impulses.joints);
        row[at_normal_impulse] = impulses.barrier_normal;
        for (const ContactLoad& contact : loads.units[u].contact_loads) {
            const bool ground = contact.obstacle == scene.ground;
            const Load& now = contact.history.now;
            add_to(row + (ground ? at_ground_force : at_barrier_force), now.wrench.force);
            if (!ground) row[at_normal_force] += contact.normal_force;
            const Load curvature = loads.curved ? contact.higher_order.corrector : Load{};
            add_to(row + (ground ? at_ground_curvature : at_barrier_curvature), curvature.wrench.force);
            if (ground) continue;
            row[at_normal_curvature] += curvature.normal_force;
            double* on = obstacle_row(index, scene.obstacles[contact.obstacle].element).values.data();
            add_to(on + at_load, -now.wrench.force);
            add_to(on + at_load + 3, now.reaction_torque);
            add_to(on + at_load_curvature, -curvature.wrench.force);
            add_to(on + at_load_curvature + 3, curvature.reaction_torque);
        }
        for (const ObstacleImpulse& one : impulses.obstacles) {
            const bool ground = one.obstacle == scene.ground;
            add_to(row + (ground ? at_ground_impulse : at_barrier_impulse), one.impulse);
            if (ground) continue;
            double* on = obstacle_row(index, scene.obstacles[one.obstacle].element).values.data();
            add_to(on + at_load_impulse, -one.impulse);
            add_to(on + at_load_impulse + 3, one.torque);
        }
        std::copy(impulses.tire.begin(), impulses.tire.end(), row + at_tire_impulses);
        row += unit_width(model);
    }
    for (const Wrench& joint : loads.joint_impulses) {
        put(row, joint.force);
        put(row + 3, joint.torque);
        row += joint_width;
    }
    for (std::size_t i = 0; i < loads.moving_elements.size(); ++i) {
        const BodyState& body = loads.moving_elements[i];
        put(row + at_element_position, body.position);
        std::copy_n(body.orientation.coeffs().data(), 4, row + at_element_orientation);
        put(row + at_element_velocity, body.velocity);
        row[at_element_spin] = angular_velocity(scene.barrier->moving_elements[i].body, body).z();
        row += element_width;
    }
}

}  // namespace birm3d
