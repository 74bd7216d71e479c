// Segments that are joined form one structure, and the stepping scheme follows the load on the structure as a whole.
// When a node passes from one segment to the next, the load on each segment jumps, but the load on the structure is
// continuous. So a wall of segments gives the same result as the same wall in one piece.
#pragma once

#include <span>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

// Index one past the last contact of the structure that contacts[first] belongs to. `contacts` has the contacts of
// one structure side by side.
inline std::size_t end_of_structure(const Scene& scene, std::span<const ContactLoad> contacts,
                                    std::size_t first) {
    const std::size_t structure = scene.obstacles[contacts[first].obstacle].structure;
    std::size_t end = first + 1;
    while (end < contacts.size() && scene.obstacles[contacts[end].obstacle].structure == structure)
        ++end;
    return end;
}

// Sum of the load histories of a structure's contacts.
inline LoadHistory history_of_structure(const Scene& scene, std::span<const ContactLoad> contacts,
                                        std::size_t structure) {
    LoadHistory sum;
    for (const ContactLoad& contact : contacts) {
        if (scene.obstacles[contact.obstacle].structure != structure) continue;
        const LoadHistory& history = contact.history;
        sum.now += history.now;
        sum.rate += history.rate;
        sum.second_difference += history.second_difference;
        if (history.step == 0.0) continue;
        sum.step = history.step;
        sum.previous_step = history.previous_step;
        sum.time_since = history.time_since;
        sum.is_smooth = history.is_smooth;
    }
    return sum;
}

}  // namespace birm3d
