// Gaps between the nodes of panels and the indentations that posts and top edges make, or would make.
#pragma once

#include "birm3d/scene/scene.hpp"
#include "kernels/indentation.hpp"

namespace birm3d {

// Is the obstacle a post, or has it a top edge that draws in skin?
bool draws_in_skin(const Obstacle& obstacle);

// Is it so placed that it can indent the panel? See can_indent() in kernels/indentation.hpp.
bool can_indent(const Obstacle& obstacle, const Placement& stands, const Panel& panel, const Twist& motion,
                bool indents);

// The indentation of a panel by a post or a top edge that stands there, seen from the body.
Indentation indentation_by(const Obstacle& obstacle, const Placement& stands, const Panel& panel,
                           const TrussMesh& mesh, const Settings& settings);

// Least gap of the nodes of a panel from an indentation (m); infinite if all are further away than `far`. The search
// stops at the first gap below `enough`.
double gap_of_panel(const Indentation& indentation, std::size_t panel, const TrussMesh& mesh,
                    const UnitState& unit, double far, double enough);

// Greatest depth of nodes in the indentation of a post that came from in front (m). Depths above `deepest` do not
// count: such a post stands beside the panel.
double overlap_of_indentations(const Scene& scene, const State& state, double deepest);

// A step of at most `longest` in which no post begins to indent a panel (s). Posts beside or inside a panel come from
// the side and make no indentation. `fastest`: bound of the speed of any point of the unit (m/s).
double step_to_indentation(const Scene& scene, const UnitState& unit, const Unit& model, double fastest,
                           double longest);

}  // namespace birm3d
