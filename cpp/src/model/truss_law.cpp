#include "birm3d/model/truss_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "birm3d/base/error.hpp"

namespace birm3d {

TrussCurve knee_curve(double k_initial, double knee, double k_hardening, double f_max, double k_unloading) {
    require_not_negative("k_initial", k_initial);
    require_not_negative("k_hardening", k_hardening);
    if (!(knee > 0.0)) refuse("knee", "> 0", knee);
    if (!(f_max > 0.0)) refuse("f_max", "> 0", f_max);

    TrussCurve curve{.deflection = {0.0}, .slope = {k_initial}, .k_unloading = k_unloading};
    const double knee_force = std::isinf(knee) ? (k_initial > 0.0 ? knee : 0.0) : k_initial * knee;
    if (knee_force < f_max && std::isfinite(knee)) {
        curve.deflection.push_back(knee);
        curve.slope.push_back(k_hardening);
    }
    if (std::isfinite(f_max)) {
        const double force_at_last = curve.deflection.size() == 2 ? knee_force : 0.0;
        const double closing = curve.deflection.back() + (f_max - force_at_last) / curve.slope.back();
        if (std::isfinite(closing)) {
            curve.deflection.push_back(closing);
            curve.slope.push_back(0.0);
        }
    }
    return curve;
}

TrussCurve point_curve(const std::vector<double>& deflection, const std::vector<double>& force,
                       double k_unloading) {
    if (deflection.size() != force.size() || deflection.size() < 2)
        refuse("envelope", "a list of at least 2 points (deflection, force)",
               static_cast<double>(deflection.size()));
    if (deflection[0] != 0.0 || force[0] != 0.0)
        refuse("envelope[0]", "(0, 0)", "(" + to_text(deflection[0]) + ", " + to_text(force[0]) + ")");

    TrussCurve curve{.deflection = {}, .slope = {}, .k_unloading = k_unloading};
    for (std::size_t i = 0; i + 1 < deflection.size(); ++i) {
        const std::string name = "envelope[" + std::to_string(i + 1) + "]";
        if (!(std::isfinite(deflection[i + 1]) && deflection[i + 1] > deflection[i]))
            refuse(name + " deflection", "finite and > " + to_text(deflection[i]), deflection[i + 1]);
        require_not_negative((name + " force").c_str(), force[i + 1]);
        curve.deflection.push_back(deflection[i]);
        curve.slope.push_back((force[i + 1] - force[i]) / (deflection[i + 1] - deflection[i]));
    }
    curve.deflection.push_back(deflection.back());
    curve.slope.push_back(0.0);
    return curve;
}

TrussCurve with_tail(const TrussCurve& curve, double depth, double slope) {
    if (!(depth > 0.0)) refuse("tail_depth", "> 0", depth);
    require_not_negative("tail_slope", slope);
    TrussCurve out = curve;
    const auto place = std::lower_bound(out.deflection.begin(), out.deflection.end(), depth);
    const auto j = static_cast<std::size_t>(place - out.deflection.begin());
    if (place == out.deflection.end() || *place != depth) {
        out.deflection.insert(place, depth);
        out.slope.insert(out.slope.begin() + static_cast<std::ptrdiff_t>(j), out.slope[j - 1]);
    }
    for (std::size_t i = j; i < out.slope.size(); ++i)
        out.slope[i] += slope;
    return out;
}

namespace {

double degree(const TrussCurve& curve) {
    return has_recovery(curve.recovery) ? recovery_degree : line_degree;
}

}  // namespace

double unloading_slope(const TrussCurve& curve, double force) {
    return std::max(curve.k_unloading, degree(curve) * force / curve.recovery);
}

void require_valid(const TrussCurve& curve, const std::string& name) {
    require_positive((name + "k_unloading").c_str(), curve.k_unloading);
    if (!(curve.recovery > 0.0)) refuse(name + "elastic_recovery", "> 0", curve.recovery);
    if (!(curve.friction_share >= 0.0 && curve.friction_share <= 1.0))
        refuse(name + "friction_share", "in [0, 1]", curve.friction_share);
    if (!(std::isfinite(curve.springback) && curve.springback >= 0.0))
        refuse(name + "springback", "finite and >= 0", curve.springback);
    if (curve.deflection.empty() || curve.deflection.size() != curve.slope.size() ||
        curve.deflection[0] != 0.0)
        refuse(name + "envelope", "one slope for each deflection, the first at 0",
               static_cast<double>(curve.deflection.size()));
    double force = 0.0;
    for (std::size_t i = 0; i < curve.slope.size(); ++i) {
        const double slope = curve.slope[i];
        if (i > 0) {
            const double length = curve.deflection[i] - curve.deflection[i - 1];
            if (!(std::isfinite(length) && length >= 0.0))
                refuse(name + "envelope deflection", "increasing", curve.deflection[i]);
            force += curve.slope[i - 1] * length;
        }
        // By rounding, the last point of a falling slope may be slightly below zero.
        if (force < -1e-9 * std::abs(slope)) refuse(name + "envelope force", ">= 0", force);
        if (!std::isfinite(slope)) refuse(name + "envelope slope", "finite", slope);
        const double unloading = unloading_slope(curve, force);
        if (slope > unloading * (1.0 + 1e-12))
            refuse(
                name + "k_unloading",
                ">= every slope of the envelope (" + to_text(slope) + "), or unloading would create energy",
                unloading);
    }
    if (curve.slope.back() < 0.0) refuse(name + "envelope's last slope", ">= 0", curve.slope.back());
}

double envelope_force(const TrussCurve& curve, double deflection) {
    double force = 0.0;
    double slope = 0.0;
    for (std::size_t j = 0; j < curve.slope.size(); ++j) {
        force += (curve.slope[j] - slope) * std::max(0.0, deflection - curve.deflection[j]);
        slope = curve.slope[j];
    }
    return force;
}

namespace {

// Work of the loading envelope up to a deflection (J).
double envelope_work(const TrussCurve& curve, double deflection) {
    double work = 0.0;
    double slope = 0.0;
    for (std::size_t j = 0; j < curve.slope.size(); ++j) {
        const double beyond = std::max(0.0, deflection - curve.deflection[j]);
        work += 0.5 * (curve.slope[j] - slope) * beyond * beyond;
        slope = curve.slope[j];
    }
    return work;
}

// Leads the truss along its envelope to a greater deflection than before.
void load(const TrussCurve& curve, TrussMemory& memory, double deflection) {
    const double n = degree(curve);
    const double stored = memory.peak_force * memory.length / (n + 1.0);
    const double work = envelope_work(curve, deflection) - envelope_work(curve, memory.peak_deflection);
    memory.peak_deflection = deflection;
    memory.peak_force = envelope_force(curve, deflection);
    memory.length = std::min({curve.recovery, deflection, n * memory.peak_force / curve.k_unloading});
    if (has_recovery(curve.recovery) && memory.peak_force > 0.0)
        memory.length = std::min(memory.length, (n + 1.0) * (stored + work) / memory.peak_force);
}

}  // namespace

double truss_force(const TrussCurve& curve, TrussMemory& memory, double deflection) {
    if (deflection > memory.peak_deflection) {
        load(curve, memory, deflection);
        return memory.peak_force;
    }
    if (!(memory.peak_force > 0.0)) return 0.0;
    const double left = std::max(0.0, 1.0 - (memory.peak_deflection - deflection) / memory.length);
    return memory.peak_force * std::pow(left, degree(curve));
}

}  // namespace birm3d
