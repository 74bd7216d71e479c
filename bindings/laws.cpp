#include <pybind11/stl.h>

#include "arrays.hpp"
#include "birm3d/model/truss_law.hpp"
#include "kernels/impulse.hpp"
#include "kernels/integrate.hpp"
#include "register.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d::bindings {

namespace {

// What a zone's law may have beside its envelope.
TrussCurve completed(TrussCurve curve, double elastic_recovery, double tail_depth, double tail_slope,
                     double friction_share, double springback) {
    if (tail_slope != 0.0) curve = with_tail(curve, tail_depth, tail_slope);
    curve.recovery = elastic_recovery;
    curve.friction_share = friction_share;
    curve.springback = springback;
    require_valid(curve, "");
    return curve;
}

constexpr double none = birm3d::infinity;

}  // namespace

void register_laws(py::module_& m) {
    py::class_<TrussCurve>(m, "TrussCurve",
                           "Piecewise-linear loading envelope with an unloading slope (paper Fig. 3).")
        .def_readonly("deflection", &TrussCurve::deflection, "m, where the slope changes")
        .def_readonly("slope", &TrussCurve::slope, "slope from there on")
        .def_readonly("k_unloading", &TrussCurve::k_unloading, "slope of unloading, or the least one")
        .def_readonly("elastic_recovery", &TrussCurve::recovery, "m, infinite where the slope is constant")
        .def_readonly("friction_share", &TrussCurve::friction_share, "of the barrier's friction")
        .def_readonly("springback", &TrussCurve::springback, "m, without force")
        .def(
            "envelope", [](const TrussCurve& curve, double d) { return envelope_force(curve, d); },
            py::arg("deflection"),
            "Force of the loading envelope at a deflection (m); its unit is that of the slopes times m.")
        .def(
            "follow",
            [](const TrussCurve& curve, const InputArray& path) {
                TrussMemory memory;
                Column force;
                for (const double d : numbers(path, "path"))
                    force.push_back(truss_force(curve, memory, d));
                return py::array_t<double>(static_cast<py::ssize_t>(force.size()), force.data());
            },
            py::arg("path"), "Forces (n,) along a path of deflections (n,) that starts uncrushed.");
    m.def(
        "knee_curve",
        [](double k_initial, double knee, double k_hardening, double f_max, double k_unloading,
           double elastic_recovery, double tail_depth, double tail_slope, double friction_share,
           double springback) {
            return completed(knee_curve(k_initial, knee, k_hardening, f_max, k_unloading), elastic_recovery,
                             tail_depth, tail_slope, friction_share, springback);
        },
        py::arg("k_initial"), py::arg("knee"), py::arg("k_hardening"), py::arg("f_max"),
        py::arg("k_unloading"), py::arg("elastic_recovery") = none, py::arg("tail_depth") = none,
        py::arg("tail_slope") = 0.0, py::arg("friction_share") = 1.0, py::arg("springback") = 0.0,
        "The paper's curve: k_initial to the knee, k_hardening to f_max, then the plateau; beyond tail_depth "
        "steeper by tail_slope.");
    m.def(
        "point_curve",
        [](const std::vector<double>& deflection, const std::vector<double>& force, double k_unloading,
           double elastic_recovery, double tail_depth, double tail_slope, double friction_share,
           double springback) {
            return completed(point_curve(deflection, force, k_unloading), elastic_recovery, tail_depth,
                             tail_slope, friction_share, springback);
        },
        py::arg("deflection"), py::arg("force"), py::arg("k_unloading"), py::arg("elastic_recovery") = none,
        py::arg("tail_depth") = none, py::arg("tail_slope") = 0.0, py::arg("friction_share") = 1.0,
        py::arg("springback") = 0.0,
        "A curve through points, flat after the last; beyond tail_depth steeper by tail_slope.");

    m.def(
        "tumble",
        [](const InputArray& inertia, const InputArray& angular_velocity_, double dt, int steps) {
            const RigidBody body(1.0, matrix(inertia, "inertia"));
            BodyState state;
            state.angular_momentum = body.inertia * vector(angular_velocity_, "angular_velocity");
            py::array_t<double> energy(steps), momentum({steps, 3}), orientation({steps, 4});
            for (int i = 0; i < steps; ++i) {
                drift(body, dt, state);
                energy.mutable_at(i) = kinetic_energy(body, state);
                const Vec3 L =
                    inverse_inertia_in_world(body, state).inverse() * angular_velocity(body, state);
                for (int k = 0; k < 3; ++k)
                    momentum.mutable_at(i, k) = L[k];
                const Quat& q = state.orientation;
                orientation.mutable_at(i, 0) = q.w(), orientation.mutable_at(i, 1) = q.x();
                orientation.mutable_at(i, 2) = q.y(), orientation.mutable_at(i, 3) = q.z();
            }
            return py::make_tuple(energy, momentum, orientation);
        },
        py::arg("inertia"), py::arg("angular_velocity"), py::arg("dt"), py::arg("steps"),
        "Free motion from the identity orientation: energy (n,) J, angular momentum (n, 3), quaternion (n, "
        "4) w x y z.");

    m.def(
        "collide",
        [](double mass_a, const InputArray& inertia_a, const InputArray& velocity_a, const InputArray& spin_a,
           double mass_b, const InputArray& inertia_b, const InputArray& velocity_b, const InputArray& spin_b,
           const InputArray& arm_a, const InputArray& arm_b, const InputArray& normal, double restitution) {
            const RigidBody a(mass_a, matrix(inertia_a, "inertia_a")),
                b(mass_b, matrix(inertia_b, "inertia_b"));
            std::vector<ContactBody> bodies = {
                {a.inverse_mass,
                 a.inverse_inertia,
                 {vector(velocity_a, "velocity_a"), vector(spin_a, "spin_a")}},
                {b.inverse_mass,
                 b.inverse_inertia,
                 {vector(velocity_b, "velocity_b"), vector(spin_b, "spin_b")}}};
            RigidContact contact;
            contact.other = 1;
            contact.arm = vector(arm_a, "arm_a");
            contact.other_arm = vector(arm_b, "arm_b");
            contact.normal = vector(normal, "normal");
            const double before = separation_velocity(contact, bodies);
            contact.target = -restitution * before;
            std::vector<RigidContact> contacts = {contact};
            solve_impulses(contacts, bodies, std::abs(before));
            return py::make_tuple(contacts[0].impulse, copy(bodies[0].motion.velocity),
                                  copy(bodies[0].motion.angular_velocity), copy(bodies[1].motion.velocity),
                                  copy(bodies[1].motion.angular_velocity));
        },
        py::arg("mass_a"), py::arg("inertia_a"), py::arg("velocity_a"), py::arg("spin_a"), py::arg("mass_b"),
        py::arg("inertia_b"), py::arg("velocity_b"), py::arg("spin_b"), py::arg("arm_a"), py::arg("arm_b"),
        py::arg("normal"), py::arg("restitution"),
        "Eq. 1 for two free bodies: impulse and the velocities and spins afterwards; normal from b to a.");
}

}  // namespace birm3d::bindings
