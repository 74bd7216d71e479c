// How a scene is computed; constant during a run.
#pragma once

#include <optional>

namespace birm3d {

struct Barrier;
struct Vehicle;

enum class ContactModel {
    projected,    // the truss force projected on the surface normal: keeps the energy (default)
    along_truss,  // the paper's rule, for comparison: creates or loses energy where truss and normal differ
};

enum class TireModel {
    slip,  // lateral force continuous in the slip angle (brush model), default
    skid,  // the paper's rule: full friction against the velocity once it leaves the heading
};

struct Settings {
    std::optional<double> time_step;  // s; fixed, or adaptive where absent
    double tolerance = 1e-3;          // wanted relative error of the metrics (adaptive steps)
    double output_interval = 1e-4;    // s
    double gravity = 9.80665;         // m/s^2
    bool ground = true;
    double mu_tire = 0.8;          // tyre-pavement friction coefficient
    double mu_body = 0.4;          // vehicle body-pavement, where it slides on the ground
    double mu_tire_barrier = 0.6;  // tyre-barrier
    double braking = 0.0;  // share of the tyre-pavement friction that brakes: 0 rolling, 1 locked wheels
    double cornering_stiffness =
        10.0;                  // lateral force per normal load and radian of slip at small slip (1/rad)
    double restitution = 0.1;  // of rigid contacts (paper 5.2)
    // Sideways force of the skin on the rounded edge of a wall that catches none of the rails, over that on a frictionless wedge.
    // It is chosen by hand to meet tests with 25 % overlap, all at a radius of 0.15 m.
    double edge_flank_factor = 1.25;
    ContactModel contact_model = ContactModel::projected;
    TireModel tire_model = TireModel::slip;

    bool operator==(const Settings&) const = default;
};

void require_valid(const Settings& settings);

// Of a scene that asks for nothing: the vehicle's own numbers, and no friction of tyres on a barrier that has none. `barrier`
// may be absent.
Settings usual_settings(const Vehicle& vehicle, const Barrier* barrier);

}  // namespace birm3d
