#include "kernels/detect_core.hpp"

#include "birm3d/base/rotation.hpp"
#include "check.hpp"
#include "laboratory.hpp"
#include "state/rigid_contact.hpp"

using namespace birm3d;

namespace {

const auto vehicle = laboratory::block(laboratory::w2_curve(), 13, 10);
const Unit& unit = vehicle->units[0];
const TrussMesh& mesh = unit.trusses;                   // anchors at 1 m
const Shape face = HalfSpace{{-1.0, 0.0, 0.0}, -1.05};  // body axes: the anchors stand 50 mm before it

std::vector<RigidContact> found(const Unit& of, const PlacedShape& shape, const Twist& motion, double dt,
                                const UnitState& state) {
    std::vector<RigidContact> contacts;
    find_core_contacts(of, 3, state, {&shape, 1}, motion, dt, contacts);
    return contacts;
}

std::vector<RigidContact> found(const Twist& motion, double dt, const UnitState& state = UnitState(unit)) {
    return found(unit, {&face, {}, 0, 0.0}, motion, dt, state);
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

TEST("an anchor outside the rigid boxes meets a post once its own truss is closed") {
    const Twist ahead{Vec3(10.0, 0.0, 0.0), Vec3::Zero()};
    const Shape post = Post(4.0, 3.0);  // as wide as the face, 50 mm before the anchors in the middle
    const Placement stands{Mat3::Identity(), Vec3(-5.05, 0.0, 1.0)};
    const auto count = [&](const Unit& of, bool pushes, const UnitState& state) {
        return found(of, {&post, stands, 0, 0.0, {}, pushes}, ahead, 0.01, state).size();
    };
    UnitState state(unit);
    const std::size_t all = count(unit, true, state);  // a vehicle without boxes
    CHECK(all > 10);
    Unit yielding = unit;
    yielding.core = {{Vec3::Zero(), Vec3(0.5, 1.2, 0.8)}};  // half a metre behind all anchors
    CHECK(count(yielding, true, state) == all);             // its trusses are independent
    yielding.trusses.indentation_length = 0.65;
    CHECK(count(yielding, true, state) == 0);
    CHECK(count(yielding, false, state) == all);  // no node feels it
    for (TrussBlockState& block : state.trusses.block)
        block.x.fill(1.05);  // all nodes on the post
    CHECK(count(yielding, true, state) == all);
    yielding.core = {{Vec3(0.5, 0.0, 0.0), Vec3(0.5, 1.2, 0.8)}};  // up to the anchors
    CHECK(count(yielding, true, UnitState(unit)) == all);
}
