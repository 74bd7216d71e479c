#include "birm3d/model/settings.hpp"

#include <cmath>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/model/barrier.hpp"
#include "birm3d/model/vehicle.hpp"

namespace birm3d {

void require_valid(const Settings& s) {
    if (s.time_step && !(std::isfinite(*s.time_step) && *s.time_step >= tolerance::shortest_step))
        refuse("time_step", "finite and >= " + to_text(tolerance::shortest_step) + " s", *s.time_step);
    require_within("tolerance", s.tolerance, 1e-9, 1.0);
    if (!(std::isfinite(s.output_interval) && s.output_interval >= tolerance::shortest_step))
        refuse("output_interval", "finite and >= " + to_text(tolerance::shortest_step) + " s",
               s.output_interval);
    require_not_negative("gravity", s.gravity);
    require_not_negative("mu_tire", s.mu_tire);
    require_not_negative("mu_body", s.mu_body);
    require_not_negative("mu_tire_barrier", s.mu_tire_barrier);
    require_within("braking", s.braking, 0.0, 1.0);
    require_positive("cornering_stiffness", s.cornering_stiffness);
    require_within("restitution", s.restitution, 0.0, 1.0);
    require_not_negative("edge_flank_factor", s.edge_flank_factor);
}

Settings usual_settings(const Vehicle& vehicle, const Barrier* barrier) {
    Settings settings;
    if (barrier != nullptr && barrier->friction == 0.0) settings.mu_tire_barrier = 0.0;
    settings.cornering_stiffness = vehicle.cornering_stiffness;
    settings.edge_flank_factor = vehicle.edge_flank_factor;
    return settings;
}

}  // namespace birm3d
