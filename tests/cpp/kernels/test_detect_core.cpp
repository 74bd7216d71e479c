#include "kernels/detect_core.hpp"

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;

namespace {

const auto vehicle = laboratory::block(laboratory::w2_curve(), 13, 10);
const Unit& unit = vehicle->units[0];
const TrussMesh& mesh = unit.trusses;                           // anchors at 1 m
const Shape face = HalfSpace{{-1.0, 0.0, 0.0}, -1.05};  // body axes: the anchors stand 50 mm before it

std::vector<RigidContact> found(const Twist& motion, double dt, const UnitState& state = UnitState(unit),
                                bool pushes = false) {
    std::vector<RigidContact> contacts;
    const PlacedShape shapes[] = {{&face, {}, 0, 0.0, {}, pushes}};
    find_core_contacts(mesh, 3, state, shapes, motion, dt, contacts);
    return contacts;
}

}  // namespace

TEST("anchors that reach the surface within the step become contacts") {
    const Twist ahead{Vec3(10.0, 0.0, 0.0), Vec3::Zero()};
    CHECK(found(ahead, 0.0049).empty());
    CHECK(found(ahead, 0.0051).size() == mesh.count);
    CHECK(found({Vec3(-10.0, 0.0, 0.0), Vec3::Zero()}, 1.0).empty());
    CHECK(found({Vec3(0.0, 10.0, 0.0), Vec3::Zero()}, 1.0).empty());
}

TEST("a turn brings those of one side only") {
    // Yaw to the right: points on the left (+y) move ahead with 1 rad/s times y.
    const std::vector<RigidContact> contacts = found({Vec3::Zero(), Vec3(0.0, 0.0, -1.0)}, 0.08);
    CHECK(!contacts.empty());
    CHECK(contacts.size() < mesh.count / 2);
    for (const RigidContact& c : contacts)
        CHECK(mesh.anchor(c.index).y() > 0.5);
}

TEST("contacts are given in world axes") {
    UnitState state(unit);
    state.body.orientation = from_roll_pitch_yaw({0.1, -0.2, 0.7});
    const std::vector<RigidContact> contacts = found({Vec3(10.0, 0.0, 0.0), Vec3::Zero()}, 0.01, state);
    CHECK(contacts.size() == mesh.count);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const RigidContact& c = contacts[i];
        CHECK(c.source == ContactSource::core);
        CHECK(c.index == i);
        CHECK(c.body == 3);
        CHECK_CLOSE(c.gap, 0.05, 1e-15, "rounding");
        CHECK_CLOSE((c.arm - state.body.orientation * mesh.anchor(i)).norm(), 0.0, 0.0, "exact");
        CHECK_CLOSE((c.normal + state.body.orientation * Vec3::UnitX()).norm(), 0.0, 1e-15, "rounding");
    }
}

TEST("while the obstacle pushes on nodes, anchors count whose own trusses are closed") {
    const Twist ahead{Vec3(10.0, 0.0, 0.0), Vec3::Zero()};
    UnitState state(unit);
    CHECK(found(ahead, 0.01, state, true).empty());
    state.trusses.block[0].x[0] = 1.05;  // on the face
    state.trusses.block[0].x[1] = 2.0;
    const std::vector<RigidContact> contacts = found(ahead, 0.01, state, true);
    CHECK(contacts.size() == 1);
    CHECK(contacts[0].index == mesh.first[0]);
}
