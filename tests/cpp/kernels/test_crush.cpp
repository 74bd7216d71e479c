#include "kernels/crush.hpp"

#include <cmath>
#include <vector>

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;

namespace {

// 1 MN/m to 0.1 m, 2 MN/m beyond; unloading 10 MN/m.
const TrussCurve curve = knee_curve(1e6, 0.1, 2e6, laboratory::infinity, 10e6);

SkinForces forces_of(const CrushSums& sums, const Wrench& wrench) {
    SkinForces forces;
    forces.contact = wrench;
    forces.normal_force = sums.normal_force();
    forces.work = sums.work();
    forces.stored = sums.stored();
    forces.stiffness = sums.stiffness();
    return forces;
}

// The forces of a mesh of one block by a pole, upright at (x, y).
SkinForces press_by_pole(const TrussMesh& mesh, double x, double y, double radius,
                         const TrussBlockState& before, TrussBlockState& now) {
    NodeFaces faces;
    BlockContact contact;
    for (std::size_t i = 0; i < block_size; ++i) {
        const Vec3 radial(before.x[i] - x, before.y[i] - y, 0.0);
        const Vec3 n = radial.normalized();
        faces.gap[i] = radial.norm() - radius;
        contact.nx[i] = faces.bx[i] = n.x(), contact.ny[i] = faces.by[i] = n.y();
        contact.nz[i] = faces.bz[i] = n.z();
        faces.per_force[i] = 0.0;
    }
    CrushSums sums;
    crush(faces, laboratory::body(), mesh, 0, nullptr, before, now, contact, sums);
    return forces_of(sums, total_wrench(sums));
}

// The forces of a mesh of one block.
SkinForces press(const TrussMesh& mesh, ContactModel model, const HalfSpace& face,
                 const TrussBlockState& before, TrussBlockState& now) {
    const FlatContact surface(laboratory::body(), face, face);
    CrushSums sums;
    BlockContact contact;
    contact.set_normal(face.normal);
    crush(surface, mesh, 0, nullptr, before, now, contact, sums);
    Wrench wrench = total_wrench(surface, sums);
    if (model == ContactModel::along_truss) wrench = along_trusses(mesh.block[0], now, contact);
    return forces_of(sums, wrench);
}

// One node that is pressed by a plane; all in body axes.
struct Press {
    Press(const Vec3& node, const Vec3& anchor, const Vec3& normal_,
          ContactModel model_ = ContactModel::projected, const TrussCurve& curve_ = curve)
        : mesh({{node}, {anchor}, {curve_}, {0}, {1.0}}),
          now(mesh),
          normal(normal_),
          model(model_),
          start(normal_.dot(node)) {}

    // The plane moves to `depth` behind the place where it touches the uncrushed node.
    SkinForces to(double depth) {
        const TrussBlockState before = now.block[0];
        const HalfSpace face{normal, start + depth};
        forces = press(mesh, model, face, before, now.block[0]);
        work += forces.work;
        return forces;
    }

    Vec3 node() const { return {now.block[0].x[0], now.block[0].y[0], now.block[0].z[0]}; }

    TrussMesh mesh;
    TrussState now;
    Vec3 normal;
    ContactModel model;
    double start;
    SkinForces forces;
    double work = 0.0;
};

const std::vector<Vec3> normals = {{-1.0, 0.0, 0.0},
                                   {0.0, 1.0, 0.0},
                                   {0.0, 0.0, 1.0},
                                   Vec3(-2.0, 1.0, 0.5).normalized(),
                                   Vec3(1.0, -1.0, -3.0).normalized()};

}  // namespace

TEST("a truss along the normal is pressed by the law of Fig. 3, whichever way the plane looks") {
    for (const Vec3& n : normals) {
        const Vec3 place(0.4, -0.7, 0.2);
        Press press(place, place + 2.0 * n, n);
        const SkinForces f = press.to(0.25);
        const double force = 1e6 * 0.1 + 2e6 * 0.15;
        CHECK_CLOSE((f.contact.force - force * n).norm(), 0.0, 1e-8, "rounding of lengths near 2 m");
        CHECK_CLOSE((f.contact.torque - (place + 0.25 * n).cross(f.contact.force)).norm(), 0.0, 1e-8,
                    "the same");
        CHECK_CLOSE(f.normal_force, force, 1e-8, "the same");
        CHECK_CLOSE((press.node() - place - 0.25 * n).norm(), 0.0, 1e-15, "held on the plane");
        CHECK(press.now.block[0].touching);
    }
}

TEST("a plane that is not reached does nothing") {
    Press press({1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0});
    const SkinForces f = press.to(-0.03);
    CHECK_CLOSE(f.contact.force.norm(), 0.0, 0.0, "exact");
    CHECK_CLOSE(f.stiffness, 0.0, 0.0, "exact");
    CHECK(!press.now.block[0].touching);
}

TEST("a slanted truss presses with the share that points along the normal") {
    // Node and anchor 1 m apart, 30 degrees off the normal.
    const Vec3 n(-1.0, 0.0, 0.0);
    const Vec3 b0(std::cos(laboratory::pi / 6.0), std::sin(laboratory::pi / 6.0), 0.0);
    for (const ContactModel model : {ContactModel::projected, ContactModel::along_truss}) {
        Press press(b0, Vec3::Zero(), n, model);
        const SkinForces f = press.to(0.08);
        const Vec3 b = b0 + 0.08 * n;
        const double force = envelope_force(curve, 1.0 - b.norm());
        const Vec3 expected = model == ContactModel::projected ? Vec3(force * (-b.normalized().dot(n)) * n)
                                                               : Vec3(-force * b.normalized());
        CHECK_CLOSE((f.contact.force - expected).norm(), 0.0, 1e-8, "rounding");
    }
}

TEST("unloading releases the node at its residual deflection, and the loop costs its area") {
    for (const Vec3& n : normals) {
        Press press(Vec3::Zero(), 2.0 * n, n);
        for (const double depth : {0.1, 0.2, 0.25})
            press.to(depth);  // stops at the knee: trapezoids are exact
        const double peak = 4e5, residual = 0.25 - peak / 10e6;
        press.to(0.23);
        CHECK_CLOSE(press.forces.normal_force, peak - 10e6 * 0.02, 1e-6,
                    "on the unloading line; rounding of 10 MN/m");
        CHECK_CLOSE(press.forces.stored, 0.5 * 2e5 * 2e5 / 10e6, 1e-6, "what the line still gives back");
        press.to(0.05);
        CHECK_CLOSE(press.forces.contact.force.norm(), 0.0, 0.0, "exact");
        CHECK(!press.now.block[0].touching);
        CHECK_CLOSE((press.node() - residual * n).norm(), 0.0, 1e-14,
                    "it stays where its truss reached zero");
        CHECK_CLOSE(press.work, 0.5 * 0.1 * 1e5 + 0.15 * 2.5e5 - 0.5 * peak * peak / 10e6, 1e-7,
                    "rounding of 4e4 J");

        press.to(residual - 0.01);
        CHECK_CLOSE(press.forces.contact.force.norm(), 0.0, 0.0, "exact: the plane is short of the node");
        press.to(residual + 0.01);
        CHECK_CLOSE(press.forces.normal_force, 1e5, 1e-6, "reloads on the unloading line");
    }
}

TEST("a steep tail stores no more than its load puts in, so that no crush is undone") {
    TrussCurve tailed = with_tail(knee_curve(0.5e6, 0.02, 0.0, laboratory::infinity, 10e6), 0.3, 8.5e6);
    tailed.recovery = 0.09;
    const Vec3 n = -Vec3::UnitX();
    Press press({2.0, 0.0, 0.0}, Vec3::Zero(), n, ContactModel::projected, tailed);
    constexpr int steps = 1000;
    double crushed = 0.0, stored = 0.0;
    for (int i = 1; i <= steps; ++i) {
        stored = press.to(0.33 * i / steps).stored;
        CHECK(press.work - stored >= crushed - 1e-9 * press.work);
        crushed = press.work - stored;
    }
    const double loaded = press.work;
    for (int i = steps; i >= 0; --i)
        press.to(0.33 * i / steps);
    const double returned = loaded - press.work;
    CHECK(returned <= stored * (1.0 + 1e-4));  // the trapezoid rule
    CHECK(returned > 0.9 * stored);  // the rest is lost where the curve meets the envelope below the tail
}

TEST("the projected force and the trusses exchange the same work, slanted or not") {
    // The plane presses in and out again in small steps: work on the trusses against force times way.
    const Vec3 n = Vec3(-1.0, 0.3, 0.0).normalized();
    for (const ContactModel model : {ContactModel::projected, ContactModel::along_truss}) {
        Press press({1.0, 0.2, 0.1}, {0.0, 0.0, 0.0}, n, model);
        double by_plane = 0.0, force = 0.0, depth = 0.0, most = 0.0;
        const int steps = 4000;
        for (int i = 1; i <= steps; ++i) {
            const double next = 0.2 * std::sin(laboratory::pi * i / steps);
            const double next_force = press.to(next).contact.force.dot(n);
            by_plane += 0.5 * (force + next_force) * (next - depth);
            force = next_force;
            depth = next;
            most = std::max(most, press.work);
        }
        const double gap = std::abs(by_plane - press.work) / most;
        CHECK_CLOSE(gap, 0.0, 1e-6, "trapezoid rule of 4000 steps across two kinks");
    }
}

TEST("a truss that would pull the surface towards it does not press") {
    // Node beyond the anchor along the normal: shortening is impossible, the truss gets longer.
    const Vec3 n(-1.0, 0.0, 0.0);
    Press press({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, n);
    CHECK_CLOSE(press.to(0.3).contact.force.norm(), 0.0, 0.0, "exact");
}

TEST("a truss that lies in the surface keeps its force, on whichever side of it rounding puts its anchor") {
    const Vec3 n(-1.0, 0.0, 0.0);
    for (const double depth : {0.3 - 1e-9, 0.3, 0.3 + 1e-9}) {
        Press press({0.0, 0.0, 0.0}, {-0.3, 0.4, 0.0}, n);
        CHECK_CLOSE(press.to(depth).contact.force.norm(), 0.0, 1e-3, "1 MN/m x 0.1 m times 1e-9 m / 0.4 m");
        CHECK_CLOSE(press.now.block[0].force[0], 1e5, 1e-2, "a slope of 1 MN/m");
        // The surface recedes by 0.01 m: the truss is 0.400125 m long and unloads by 10 MN/m.
        const double length = std::hypot(0.01, 0.4), force = 1e5 - 10e6 * (length - 0.4);
        CHECK_CLOSE(press.to(0.29).contact.force.norm(), force * 0.01 / length, 1e-1, "the same");
    }
}

TEST("the block sums what its trusses do") {
    const TrussInput input = laboratory::front_face(laboratory::w2_curve(), 8, 8);
    const TrussMesh mesh(input);
    TrussState state(mesh);
    const TrussBlockState before = state.block[0];
    const HalfSpace face{{-1.0, 0.0, 0.0}, -2.5};
    const SkinForces f = press(mesh, ContactModel::projected, face, before, state.block[0]);
    const double force = 3e6 * 0.4 + 6e6 * 0.1;
    CHECK_CLOSE((f.contact.force - Vec3(-force, 0.0, 0.0)).norm(), 0.0, 1e-6, "rounding of 64 shares");
    CHECK_CLOSE(f.contact.torque.norm(), 0.0, 1e-6, "symmetric");
    CHECK_CLOSE(f.work, 0.25 * force, 1e-6,
                "one straight line from the origin: the trapezoid of a single step");
    CHECK_CLOSE(f.stored, 0.5 * force * force / 60e6, 1e-6, "rounding");
    // The sum over nodes of k (1/m + (r x n) . I^-1 (r x n)).
    double stiffness = 0.0;
    for (const Vec3& r : input.node)
        stiffness += 60e6 / 64.0 * (1.0 / 6804.0 + r.z() * r.z() / 40000.0 + r.y() * r.y() / 42000.0);
    CHECK_CLOSE(f.stiffness, stiffness, 1e-9 * stiffness, "rounding of 64 terms");
}

TEST("a pole of great radius presses like a wall") {
    const TrussMesh mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8));
    const double radius = 1e7;
    TrussState flat(mesh), curved(mesh);
    for (const double place : {2.8, 2.5, 2.3, 2.4}) {
        const TrussBlockState flat_before = flat.block[0], curved_before = curved.block[0];
        const HalfSpace face{-Vec3::UnitX(), -place};
        const SkinForces wall = press(mesh, ContactModel::projected, face, flat_before, flat.block[0]);
        const SkinForces by_pole =
            press_by_pole(mesh, place + radius, 0.0, radius, curved_before, curved.block[0]);
        // Nodes stand up to 1.2 m from the middle: 1.2^2 / 2e7 m less deep, on 60 MN/m.
        CHECK_CLOSE((by_pole.contact.force - wall.contact.force).norm(), 0.0, 10.0, "the pole's curvature");
        CHECK_CLOSE((by_pole.contact.torque - wall.contact.torque).norm(), 0.0, 10.0, "the same");
        CHECK_CLOSE(by_pole.work, wall.work, 3.0, "the same");
        CHECK_CLOSE(by_pole.stiffness, wall.stiffness, 1e-5 * wall.stiffness, "the same");
    }
}

TEST("a node beside a pole goes to its surface along the radius") {
    const Vec3 node(1.0, 0.1, 0.0), anchor(0.0, 0.1, 0.0);
    const TrussMesh mesh({{node}, {anchor}, {curve}, {0}, {1.0}});
    TrussState state(mesh);
    const TrussBlockState before = state.block[0];
    const SkinForces f = press_by_pole(mesh, 1.05, 0.0, 0.2, before, state.block[0]);
    const Vec3 axis(1.05, 0.0, 0.0);
    const Vec3 n = (node - axis).normalized();
    const Vec3 place = axis + 0.2 * n;
    CHECK_CLOSE((Vec3(state.block[0].x[0], state.block[0].y[0], state.block[0].z[0]) - place).norm(), 0.0,
                1e-15, "rounding");
    const Vec3 b = anchor - place;
    const double force = envelope_force(curve, 1.0 - b.norm()) * b.normalized().dot(n);
    CHECK_CLOSE((f.contact.force - force * n).norm(), 0.0, 1e-8, "rounding of 1e5 N");
    CHECK_CLOSE((f.contact.torque - place.cross(force * n)).norm(), 0.0, 1e-8, "the same");
}
