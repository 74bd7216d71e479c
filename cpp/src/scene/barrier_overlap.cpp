#include "scene/barrier_overlap.hpp"

#include <algorithm>

#include "scene/body_overlap.hpp"
#include "scene/obstacles.hpp"

namespace birm3d {

void note_overlap(const Scene& scene, std::vector<std::size_t>& about, State& state) {
    if (!scene.barrier) return;
    StepStatistics& statistics = state.statistics;
    for (std::size_t u = 0; u < state.units.size(); ++u) {
        const std::vector<Box>& core = scene.vehicle->units[u].core;
        if (core.empty()) continue;
        const BodyState& body = state.units[u].body;
        double radius = 0.0;
        for (const Box& box : core)
            radius = std::max(radius, box.radius());
        scene.map.find(body.position, radius, about);
        for (const std::size_t i : about) {
            if (i == scene.ground) continue;
            const Placement in_shape = placement(pose_of(scene, i, state), body);
            for (const Box& box : core) {
                const double overlap = overlap_of_box(scene.obstacles[i].shape, in_shape, box);
                if (!(overlap > statistics.greatest_overlap)) continue;
                statistics.greatest_overlap = overlap;
                statistics.greatest_overlap_time = state.time;
                statistics.greatest_overlap_element = scene.obstacles[i].element;
            }
        }
    }
}

}  // namespace birm3d
