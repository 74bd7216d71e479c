// Runs on several threads at once. The outcomes are compared here; races show in a build with ThreadSanitizer, see
// .ci/sanitize.
#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "birm3d/ensemble/runner.hpp"
#include "check.hpp"
#include "laboratory.hpp"

using namespace birm3d;
using laboratory::pi;

namespace {

constexpr std::size_t threads = 4;

// Scenes that share a vehicle, a barrier and settings, as those of a study do.
std::vector<Scene> scenes() {
    const auto flying = laboratory::block(laboratory::w2_curve(), 12, 9);
    const auto rolling = laboratory::block(laboratory::w2_curve(), 10, 10, laboratory::four_wheels(), 1.0);
    const auto wall = laboratory::wall(0.2);
    return {laboratory::scene(flying, wall, laboratory::weightless()),
            laboratory::scene(flying, wall, laboratory::weightless(1e-2), 0.7),
            Scene(rolling, wall, Approach{12.0, 0.5 * pi, 0.0, 0.1}, Settings(), 0.2),
            Scene(rolling, wall, Approach{15.0, 0.6, 0.0, 0.1, 0.1, 0.05}, Settings(), 0.2)};
}

template <class Work>
void on_threads(const Work& work) {
    std::vector<std::thread> all;
    for (std::size_t i = 0; i < threads; ++i)
        all.emplace_back([&work, i] { work(i); });
    for (std::thread& thread : all)
        thread.join();
}

}  // namespace

TEST("runners on several threads share scenes and give the bits of one thread") {
    const std::vector<Scene> all = scenes();
    std::vector<std::uint64_t> alone;
    Runner runner;
    for (const Scene& scene : all) {
        runner.set_scene(scene);
        alone.push_back(runner.run(scene.approach, {}, [] {}).state_hash);
    }
    std::array<std::vector<std::uint64_t>, threads> found;
    on_threads([&](std::size_t thread) {
        Runner own;
        for (std::size_t i = 0; i < 2 * all.size(); ++i) {
            const Scene& scene = all[(thread + i) % all.size()];
            own.set_scene(scene);
            found[thread].push_back(own.run(scene.approach, {}, [] {}).state_hash);
        }
    });
    for (std::size_t thread = 0; thread < threads; ++thread)
        for (std::size_t i = 0; i < 2 * all.size(); ++i)
            CHECK(found[thread][i] == alone[(thread + i) % all.size()]);
}

TEST("a scene may be read and run elsewhere while its simulation runs and starts anew") {
    Simulation simulation(scenes()[3]);
    simulation.run([] {});
    const std::uint64_t expected = simulation.state().hash();
    std::atomic<int> right = 0;
    on_threads([&](std::size_t thread) {
        if (thread == 0) {
            for (int i = 0; i < 3; ++i) {
                simulation.reset();
                simulation.run([] {});
            }
            right += simulation.state().hash() == expected;
            return;
        }
        Runner own;
        own.set_scene(simulation.scene());
        right += own.run(simulation.scene().approach, {}, [] {}).state_hash == expected;
    });
    CHECK(right == static_cast<int>(threads));
}
