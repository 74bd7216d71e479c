#include "birm3d/ensemble/runner.hpp"

#include <stdexcept>
#include <vector>

#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

// Scenes of two vehicles that share what they can: one in weightlessness at a wall, one on wheels at a post and at a wall.
std::vector<Scene> scenes() {
    const auto flying = laboratory::block(laboratory::w2_curve(), 12, 9);
    const auto rolling = laboratory::block(laboratory::w2_curve(), 10, 10, laboratory::four_wheels(), 1.0);
    const auto post = std::make_shared<const Barrier>(Barrier::pole(0.1, Vec3(0.0, 0.3, 0.0), 0.0, 0.2));
    Settings grounded;
    return {laboratory::scene(flying, laboratory::wall(), laboratory::weightless()),
            laboratory::scene(flying, laboratory::wall(0.3), laboratory::weightless(1e-2), 0.7),
            Scene(rolling, post, Approach{12.0, 0.5 * pi, 0.0, 0.1}, grounded, 0.3),
            Scene(rolling, laboratory::wall(0.2), Approach{15.0, 0.6, 0.0, 0.1, 0.1, 0.05}, grounded, 0.3)};
}

const auto nothing = [] {};

RunSummary run(Runner& runner, const Scene& scene, const ExtremeGroups& wanted = {}) {
    runner.set_scene(scene);
    return runner.run(scene.approach, wanted, nothing);
}

void check_same(const RunSummary& found, const Scene& scene) {
    Simulation alone(scene);
    laboratory::run(alone);
    CHECK(found.state_hash == alone.state().hash());
    CHECK(found.end_reason == alone.end_reason());
    CHECK(found.statistics.steps == alone.state().statistics.steps);
    const Extremes expected = extremes_of(alone.recorder().resample(alone.scene()), *scene.vehicle,
                                          scene.barrier.get(), {}, alone.event());
    CHECK(found.extremes.rows == expected.rows);
    CHECK(found.extremes.normal_force->peak == expected.normal_force->peak);
    CHECK(found.extremes.normal_force->last == expected.normal_force->last);
    CHECK(found.extremes.motion->reversal_time == expected.motion->reversal_time);
    CHECK(found.extremes.motion->travel == expected.motion->travel);
    CHECK(found.extremes.motion->velocity_change == expected.motion->velocity_change);
    CHECK(found.extremes.motion->deceleration == expected.motion->deceleration);
    CHECK(found.extremes.attitude->yaw == expected.attitude->yaw);
    CHECK(found.extremes.energy->residual == expected.energy->residual);
}

}  // namespace

TEST("a run in used memory has the bits of a run in its own") {
    const std::vector<Scene> all = scenes();
    Runner runner;
    for (const std::size_t i : {0, 1, 0, 2, 3, 2, 1, 3, 0})
        check_same(run(runner, all[i]), all[i]);
}

TEST("an approach of its own is that of a scene made with it") {
    const Scene base = scenes().back();
    Runner runner;
    runner.set_scene(base);
    for (const double speed : {5.0, 25.0, 10.0}) {
        Approach approach = base.approach;
        approach.speed = speed;
        approach.angle = 0.3 + 0.02 * speed;
        check_same(runner.run(approach, {}, nothing),
                   Scene(base.vehicle, base.barrier, approach, base.settings, base.duration));
    }
}

TEST("a run that fails, or that is ended, leaves nothing behind") {
    const std::vector<Scene> all = scenes();
    Runner runner;
    for (int i = 0; i < 2; ++i) {
        runner.set_scene(all[3]);
        CHECK_THROWS(runner.run(Approach{-1.0}, {}, nothing), std::invalid_argument);
        check_same(runner.run(all[3].approach, {}, nothing), all[3]);
        Scene fixed = all[0];
        fixed.settings.time_step = 0.05;
        CHECK_THROWS(run(runner, fixed), std::runtime_error);
        Scene long_run = all[2];
        long_run.settings.time_step = 1e-5;
        runner.set_scene(long_run);
        CHECK_THROWS(runner.run(long_run.approach, {}, [] { throw std::length_error("enough"); }),
                     std::length_error);
        check_same(run(runner, all[0]), all[0]);
        check_same(run(runner, all[2]), all[2]);
    }
}

TEST("groups that are not wanted are absent, the others are the same") {
    const Scene scene = scenes()[1];
    Runner runner;
    const RunSummary whole = run(runner, scene);
    const RunSummary force = run(runner, scene, {.motion = false, .attitude = false, .energy = false});
    CHECK(force.extremes.normal_force->peak == whole.extremes.normal_force->peak);
    CHECK(!force.extremes.motion && !force.extremes.attitude && !force.extremes.energy);
    CHECK(whole.extremes.motion && whole.extremes.attitude && whole.extremes.energy);
}

TEST("a hash tells signs and places apart") {
    Simulation simulation(scenes()[0]);
    laboratory::run(simulation);
    State state = simulation.state();
    const std::uint64_t hash = state.hash();
    TrussBlockState& block = state.units[0].trusses.block[0];
    CHECK(block.x[0] != 0.0 && block.x[8] != 0.0);
    block.x[0] = -block.x[0];
    CHECK(state.hash() != hash);
    block.x[8] = -block.x[8];
    CHECK(state.hash() != hash);
    block.x[0] = -block.x[0], block.x[8] = -block.x[8];
    CHECK(state.hash() == hash);
    std::swap(block.y[0], block.y[1]);
    CHECK(state.hash() != hash);
}
