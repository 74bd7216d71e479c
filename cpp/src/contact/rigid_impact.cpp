#include "contact/rigid_impact.hpp"

#include <algorithm>

#include "birm3d/base/tolerances.hpp"
#include "contact/impulse_iteration.hpp"
#include "contact/rigid_contacts.hpp"
#include "kernels/integrate.hpp"
#include "scene/bodies.hpp"

namespace birm3d {

namespace {

// Fraction of the kinetic energy that rounding may add in an impact.
constexpr double rounding = 1e-9;

// Greatest approach speed of any contact that touches within `reach` (s); zero if none does (m/s).
double fastest_approach(double reach, std::span<const ContactBody> bodies,
                        const std::vector<RigidContact>& contacts) {
    double fastest = 0.0;
    for (const RigidContact& contact : contacts) {
        const double v = separation_velocity(contact, bodies);
        if (approaches_hard(contact, bodies) && contact.gap <= std::max(tolerance::touching_gap, -reach * v))
            fastest = std::max(fastest, -v);
    }
    return fastest;
}

// Keeps the contacts that take part, and sets their targets. Points that arrive nearly together share one impact,
// because rounding would decide their order. A point that arrives later may still approach afterwards, the faster the
// later it is. So the result is a continuous function of the gaps.
void set_impact_targets(double restitution, double reach, double fastest, std::span<const ContactBody> bodies,
                        std::vector<RigidContact>& contacts) {
    // Gap that a contact still has after `reach` seconds (m).
    const auto late = [&](const RigidContact& contact) {
        return std::max(0.0, contact.gap + reach * std::min(0.0, separation_velocity(contact, bodies)));
    };
    std::erase_if(contacts, [&](const RigidContact& contact) {
        return !contact.bilateral && late(contact) >= tolerance::joint_impact_gap;
    });
    for (RigidContact& contact : contacts) {
        const double v = separation_velocity(contact, bodies);
        contact.target = approaches_hard(contact, bodies) ? -restitution * v : 0.0;
        if (contact.bilateral) continue;
        const double by = late(contact);
        contact.target -= fastest * by / (tolerance::joint_impact_gap - by);
    }
}

// Stores state and energies beside an impact.
void keep(const Scene& scene, const State& state, Impact& impact) {
    impact.happened = true;
    impact.bodies.clear();
    impact.moving_elements = state.moving_elements;
    impact.energies = state.energies;
    impact.energies.kinetic = kinetic_energy_of(scene, state);
    for (const UnitState& unit : state.units)
        impact.bodies.push_back(unit.body);
}

// One impact, tried with less restitution and less friction until no part of it increases the energy.
class ImpactAttempts {
  public:
    ImpactAttempts(const Scene& scene, double reach, double fastest, const std::vector<Twist>& before,
                   std::vector<Twist>& after, Trial& trial)
        : scene_(scene),
          reach_(reach),
          fastest_(fastest),
          before_(before),
          after_(after),
          state_(trial.state),
          memory_(trial.memory),
          contacts_(trial.memory.contacts),
          least_(-rounding * kinetic_energy_of(scene, trial.state)) {
        list_body_states(state_, start_);
        memory_.kick.rolls_freely.assign(state_.units.size(), 0);
        memory_.motions.sliding.clear();
    }

    void settle(double restitution) {
        attempt(restitution);
        constexpr int most_passes = 6;
        for (int pass = 0; pass < most_passes && friction_adds_energy(); ++pass) {
            redirect_friction();
            attempt(restitution);
        }
        // Each round leaves out the friction of one point or more.
        while (remove_driving_friction())
            attempt(restitution);
        if (dissipates()) return;
        attempt(0.0);
        if (remove_driving_friction() || !dissipates()) remove_all_friction();
        double enough = 0.0, too_much = restitution;
        constexpr int halvings = 12;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (enough + too_much);
            attempt(middle);
            (dissipates() && !friction_adds_energy() ? enough : too_much) = middle;
        }
        attempt(enough);
    }

  private:
    void attempt(double restitution) {
        for (std::size_t b = 0; b < start_.size(); ++b)
            body_state(state_, b) = start_[b];
        list_motions(state_, memory_.bodies, memory_.motions.pushed);
        memory_.kick.contacts = contacts_;
        set_impact_targets(restitution, reach_, fastest_, memory_.bodies, memory_.kick.contacts);
        const std::span<const Twist> rolling =
            memory_.motions.sliding.empty() ? before_ : memory_.motions.sliding;
        kick_by_contacts(scene_,
                         {.pressed = Column(state_.moving_elements.size()),
                          .at_end = rolling,
                          .from = before_,
                          .is_impact = true},
                         memory_, state_);
        list_motions(state_, memory_.bodies, after_);
    }

    // Do all normal impulses together dissipate energy?
    bool dissipates() const {
        double loss = 0.0;
        for (const RigidContact& contact : memory_.kick.contacts)
            if (!contact.bilateral) loss += loss_of(contact, before_, after_);
        return loss >= least_;
    }

    double loss_by_friction(const RigidContact& contact) const {
        return friction_loss(scene_, state_, contact, before_, after_);
    }
    double loss_by_tires(std::size_t u) const {
        return -power(memory_.kick.on_ground[u], mean(before_[u], after_[u]));
    }

    bool friction_adds_energy() const {
        for (std::size_t u = 0; u < memory_.kick.on_ground.size(); ++u)
            if (loss_by_tires(u) < least_) return true;
        return std::any_of(
            memory_.kick.contacts.begin(), memory_.kick.contacts.end(), [&](const RigidContact& contact) {
                return contact.source == ContactSource::core && loss_by_friction(contact) < least_;
            });
    }

    // Lets friction act against the mean of the motions before and after, or half way towards it.
    void redirect_friction() {
        const bool first = memory_.motions.sliding.empty();
        if (first) memory_.motions.sliding.resize(before_.size());
        for (std::size_t b = 0; b < before_.size(); ++b) {
            const Twist middle = mean(before_[b], after_[b]);
            memory_.motions.sliding[b] = first ? middle : mean(memory_.motions.sliding[b], middle);
        }
    }

    // Removes friction from points that it accelerates. Were there any?
    bool remove_driving_friction() {
        bool any = false;
        for (std::size_t u = 0; u < memory_.kick.on_ground.size(); ++u)
            if (loss_by_tires(u) < least_) memory_.kick.rolls_freely[u] = 1, any = true;
        for (const RigidContact& contact : memory_.kick.contacts) {
            if (contact.source != ContactSource::core || !(loss_by_friction(contact) < least_)) continue;
            any = true;
            for (RigidContact& known : contacts_)
                if (known.source == contact.source && known.body == contact.body &&
                    known.index == contact.index && known.obstacle == contact.obstacle)
                    known.friction = 0.0;
        }
        return any;
    }

    void remove_all_friction() {
        memory_.kick.rolls_freely.assign(state_.units.size(), 1);
        for (RigidContact& contact : contacts_)
            contact.friction = 0.0;
    }

    const Scene& scene_;
    const double reach_, fastest_;
    const std::vector<Twist>& before_;
    std::vector<Twist>& after_;
    State& state_;
    KickMemory& memory_;
    std::vector<RigidContact> contacts_;
    std::vector<BodyState> start_;
    const double least_;  // J
};

}  // namespace

bool approaches_hard(const RigidContact& contact, std::span<const ContactBody> bodies) {
    return !contact.bilateral && separation_velocity(contact, bodies) < -tolerance::restitution_speed;
}

void impact_at_once(const Scene& scene, Stage stage, double reach, const std::vector<Twist>& before,
                    std::vector<Twist>& after, Trial& trial) {
    State& state = trial.state;
    KickMemory& memory = trial.memory;
    const double fastest = fastest_approach(reach, memory.bodies, memory.contacts);
    if (fastest == 0.0) return;
    const bool start = stage == Stage::before_drift;
    Impact& impact = start ? trial.at_start : trial.at_end;
    if (!start) keep(scene, state, impact);
    ImpactAttempts(scene, reach, fastest, before, after, trial).settle(scene.settings.restitution);
    memory.kick.rolls_freely.clear();
    memory.motions.sliding.clear();
    add_impulses(scene, state, memory.kick, impact.impulses, impact.joint_impulses);
    book_contacts(scene, memory.kick, before, after, state);
    if (start) keep(scene, state, impact);
}

}  // namespace birm3d
