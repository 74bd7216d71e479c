// Segments that are joined bear one load: where a node passes from one to the next, the whole goes on as before. What
// the scheme does by the course of a load it does by that of the structure, so that a wall in segments is the same wall.
#pragma once

#include <span>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

// The touches of one structure stand side by side: place after the last of those that begin with `first`.
inline std::size_t end_of_structure(const Scene& scene, std::span<const Touch> touches, std::size_t first) {
    const std::size_t structure = scene.obstacles[touches[first].obstacle].structure;
    std::size_t end = first + 1;
    while (end < touches.size() && scene.obstacles[touches[end].obstacle].structure == structure)
        ++end;
    return end;
}

// Sum of the courses of the touches of a structure.
inline LoadCourse course_of_structure(const Scene& scene, std::span<const Touch> touches,
                                      std::size_t structure) {
    LoadCourse sum;
    for (const Touch& touch : touches) {
        if (scene.obstacles[touch.obstacle].structure != structure) continue;
        const LoadCourse& course = touch.course;
        sum.now += course.now;
        sum.rate += course.rate;
        sum.bend += course.bend;
        if (course.step == 0.0) continue;
        sum.step = course.step;
        sum.step_before = course.step_before;
        sum.lapse = course.lapse;
        sum.bend_lasts = course.bend_lasts;
    }
    return sum;
}

}  // namespace birm3d
