// How far the nodes of panels are from the indentations that posts make, or would make.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "kernels/indentation.hpp"

namespace birm3d {

// Least gap of the nodes of a panel from an indentation (m); infinite where all are further away than `far`. Any that is no more
// than `enough` will do.
double gap_of_panel(const Indentation& indentation, std::size_t panel, const TrussMesh& mesh,
                    const UnitState& unit, double far, double enough);

// How far the indentation of any post lies over nodes that it has come to from in front, but for any that would be deeper than
// `deepest` (m): such a post stands beside the panel.
double overlap_of_indentations(const Scene& scene, const State& state, double deepest);

// A step of at most `longest` in which no post comes to indentation a panel (s). Those that stand beside it or within come from
// the side. `fastest`: any point of the unit (m/s).
double step_to_indentation(const Scene& scene, const UnitState& unit, const TrussMesh& mesh, double fastest,
                           double longest);

}  // namespace birm3d
