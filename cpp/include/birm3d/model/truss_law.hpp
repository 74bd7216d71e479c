// Force-deflection law of an inelastic truss (paper Fig. 3).
//
//   force
//   f_max |            ________ plateau until the truss bottoms out
//         |           /|
//         |          / |  k_hardening
//         |    _____/  /
//         |   /  knee /  k_unloading: unloads and reloads on this line from wherever
//         |  /       /   the load turned, zero at the residual deflection
//         | / k_initial
//         +----------+----------- deflection (m, shortening positive)
//
// The loading envelope is piecewise linear with any number of points: a sum of hinges,
//   F_env(d) = sum_j slope_change_j * max(0, d - deflection_j),
// so that one loop without branches serves every curve; the paper's knee is its two-slope case.
// Below the peak deflection d_p (force F_p) the truss moves on  F = max(0, F_p - k (d_p - d)).
//
// Fig. 3 has one slope k = k_unloading. Metal structures spring back by a nearly constant length r_e instead,
// `recovery`, so that restitution falls with speed. The force then falls along a curve of degree n = 5.
//
//   F = F_p ((d - d_r) / r)^n
//
// It is zero below the residual deflection d_r = d_p - r. The truss springs back by the length r.
//
//   r = min(r_e (1 - d_p / L), d_p, n F_p / k_unloading)
//
// L is the length of the truss, infinite for a curve by itself. What has been crushed does not spring back.
// While a truss is loaded, r grows no faster than its work allows: F_p r / (n + 1) grows by the work at most.
// A steep rise of the envelope would else store more than the load puts in, and crushed energy would come back.
// The slope is steepest where the load turned, n F_p / r. The energy given back is F_p r / (n + 1).
//
// The degree n comes from the rebound of NHTSA test 10146. The wall's force does work of 17.6 mm times its
// greatest value, and is nearly gone (1 %) after 103 mm. If that is r, n is 103 / 17.6 - 1 = 4.9. The same ratio of
// finite-element vehicles at walls is 4 to 10. A straight line would have n = 1. Without a recovery Fig. 3 holds.
#pragma once

#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/model/recovery.hpp"

namespace birm3d {

// A loading envelope with its unloading slope; per truss (m, N, N/m) or per unit area (m, Pa, Pa/m).
struct TrussCurve {
    std::vector<double> deflection;  // where the slope changes; starts at 0, increasing (m)
    std::vector<double> slope;       // slope from there on; the last one extends to infinity
    double k_unloading = 0.0;        // with a recovery: the least slope where the load turns
    double recovery = infinity;      // m, see has_recovery()
    // Of the barrier's friction, in [0, 1]: folded parts stick to the barrier while the vehicle moves on, and only this
    // share reaches the rigid body.
    double friction_share = 1.0;
    // A cover springs back by this more without force, and what is measured afterwards is less deep (m).
    double springback = 0.0;
};

// The paper's curve: k_initial to the knee, k_hardening to f_max, then the plateau. knee and f_max may be
// infinite.
TrussCurve knee_curve(double k_initial, double knee, double k_hardening, double f_max, double k_unloading);

// A curve through points (deflection, force) that starts at (0, 0) and stays at its last force.
TrussCurve point_curve(const std::vector<double>& deflection, const std::vector<double>& force,
                       double k_unloading);

// The curve that rises from `depth` on by `slope` more, as what is crushed is packed together. Refuses a depth that is not
// > 0 and a slope that is not finite and >= 0.
TrussCurve with_tail(const TrussCurve& curve, double depth, double slope);

// Least value of the slope where the load turns: without the limits by deflection and by the length of the truss.
double unloading_slope(const TrussCurve& curve, double force);

// Refuses slopes that are not finite, forces below zero, and a recovery that is not > 0. Refuses an envelope that is
// steeper than unloading from there, which would release more energy than loading stored.
void require_valid(const TrussCurve& curve, const std::string& name);

double envelope_force(const TrussCurve& curve, double deflection);

// The history of a single truss. TrussState holds the same numbers for all trusses of a vehicle.
struct TrussMemory {
    double peak_deflection = 0.0;
    double peak_force = 0.0;
    double length = 0.0;  // r, which the truss springs back from the peak (m)
};
double truss_force(const TrussCurve& curve, TrussMemory& memory, double deflection);

}  // namespace birm3d
