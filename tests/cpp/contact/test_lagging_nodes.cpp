#include "contact/lagging_nodes.hpp"

#include "check.hpp"

using namespace birm3d;

namespace {

// An obstacle with a face at x = 0 that looks to -x. The body has moved towards it by 0.02 m, and up by 0.01 m.
NearObstacle obstacle_ahead() {
    NearObstacle near;
    near.before.position = {-0.1, 0.0, 0.0};
    near.now.position = {-0.08, 0.0, 0.01};
    return near;
}

double gap_of(const NearObstacle& near, const Vec3& node) {
    return -near.now.to_own(node).x();
}

}  // namespace

TEST("a node that arrives within the step has its whole depth") {
    const NearObstacle near = obstacle_ahead();
    const Vec3 node(0.095, 0.0, 0.0), normal = -Vec3::UnitX();
    const double gap = gap_of(near, node);
    CHECK_CLOSE(gap, -0.015, 1e-15, "m");
    CHECK_CLOSE(gap_as_step_began(near, node, normal, gap), 0.005, 1e-15, "m");
    CHECK(without_lag(near, node, normal, gap) == gap);
}

TEST("a node that was inside is moved by as much as the face") {
    const NearObstacle near = obstacle_ahead();
    const Vec3 node(0.3, 0.0, 0.0), normal = -Vec3::UnitX();
    const double gap = gap_of(near, node);
    CHECK_CLOSE(gap_as_step_began(near, node, normal, gap), -0.2, 1e-15, "m");
    CHECK_CLOSE(without_lag(near, node, normal, gap), -0.02, 1e-15, "m");
}

TEST("rounding and chords of a path are no lag") {
    const NearObstacle near = obstacle_ahead();
    const Vec3 node(0.10005, 0.0, 0.0), normal = -Vec3::UnitX();
    const double gap = gap_of(near, node);
    CHECK(without_lag(near, node, normal, gap) == gap);
}
