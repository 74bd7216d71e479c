// Which panels posts and top edges indent, see kernels/indentation.hpp.
#include "contact/indented_panels.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "birm3d/base/tolerances.hpp"
#include "kernels/integrate.hpp"
#include "scene/indentation_gaps.hpp"

namespace birm3d {

namespace {

// Is the post or face in front of all nodes of the panel, as they were at the start of the step? `least`: greatest gap that does
// not count as in front (m).
bool is_in_front(const ContactPass& pass, const Indentation& indentation, std::size_t p, double least) {
    return gap_of_panel(indentation, p, pass.mesh, pass.before, 0.0, least) > least;
}

// Has the post, which is before the panel and deeper than its nodes now, come from in front, and not past the panel's edge?
bool came_from_in_front(const ContactPass& pass, std::size_t p, const Indentation& then,
                        const Indentation& now) {
    const double beside = then.beside();
    // A free step ends where the post lies on the nodes to rounding.
    constexpr double least = -tolerance::touching_gap;
    if (beside < 0.0) return is_in_front(pass, then, p, least);
    // It passed the edge within the step. Where was it just past the edge?
    const double share = (beside + tolerance::touching_gap) / (beside - now.beside());
    const Indentation at_edge = between(then, now, std::min(1.0, share));
    const double gap = gap_of_panel(at_edge, p, pass.mesh, pass.before, infinity, least);
    // Crushed skin may have left the edge. Then the skin counts before which the post is now.
    return gap < infinity ? gap > least : is_in_front(pass, as_deep_as(now, at_edge), p, least);
}

// A post or a face with a top edge before a panel, at the end and at the start of the step.
struct PanelMeeting {
    std::size_t panel;
    Indentation indentation, before;

    std::uint8_t bit() const { return static_cast<std::uint8_t>(1U << panel); }
    void stay_behind(double distance) {
        indentation.stay_behind(distance);
        before.stay_behind(distance);
    }
};

void indent(const ContactPass& pass, std::size_t k, const PanelMeeting& meeting, IndentedPanels& now,
            std::vector<IndentedPanel>& list) {
    now.panels |= meeting.bit();
    now.behind[meeting.panel] = meeting.indentation.behind;
    // Bound of how far the post can have moved in, and nodes can have moved off it, within the step.
    const double growth =
        2.0 * pass.margin * meeting.indentation.fastest_growth(pass.mesh.panel[meeting.panel]);
    list.push_back({k, meeting.panel, meeting.indentation, meeting.before, growth});
}

// The rounded corner of a front or a rear. A post that comes past a panel's edge meets it there if it is no deeper in the panel than
// this (m). Deeper posts stand beside the panel.
constexpr double corner_depth = 0.4;

// Least cosine of the post's motion into the panel, at a corner. A post that slides along a side does not indent it by passing its
// front edge.
constexpr double least_into_corner = 0.3;

// How far the indentation of a post that comes past the panel's edge stays behind it, so that no node jumps (m); nothing where the
// post does not meet the corner there.
std::optional<double> behind_at_corner(const ContactPass& pass, std::size_t k, const PanelMeeting& meeting,
                                       const Twist& motion) {
    const auto* post = std::get_if<Post>(&pass.obstacle(k).shape);
    if (pass.obstacle(k).top_edge || post == nullptr || post->opens) return std::nullopt;
    if (meeting.before.beside_across() < 0.0)
        return std::nullopt;  // it came from below, or was before the panel already
    if (!comes_towards(pass.mesh.panel[meeting.panel], pass.near[k].now, motion, least_into_corner))
        return std::nullopt;
    const double gap =
        gap_of_panel(meeting.before, meeting.panel, pass.mesh, pass.before, infinity, -infinity);
    if (-gap > corner_depth) return std::nullopt;
    return std::max(0.0, -gap) + tolerance::touching_gap;
}

// The panels that the post indents: it came into them from in front and has not released them.
IndentedPanels find_indented_panels(const ContactPass& pass, std::size_t k,
                                    std::vector<IndentedPanel>& list) {
    const TrussMesh& mesh = pass.mesh;
    const NearObstacle& near = pass.near[k];
    const Obstacle& obstacle = pass.obstacle(k);
    const IndentedPanels last = panels_by(pass.before.indented, near.index);
    const bool pushes = pushes_on(pass.before, near.index);
    const Twist motion = twist_in_body_axes(pass.unit.body, pass.before.body);
    IndentedPanels now{near.index};
    for (std::size_t p = 0; p < panels; ++p) {
        const Panel& panel = mesh.panel[p];
        const auto bit = static_cast<std::uint8_t>(1U << p);
        const bool indents = (last.panels & bit) != 0, passed = (last.passed & bit) != 0;
        if (!panel.any || !can_indent(obstacle, near.now, panel, motion, indents)) continue;
        const Indentation indentation = indentation_by(obstacle, near.now, panel, mesh, pass.scene.settings);
        if (!indents && !(indentation.beside() < 0.0)) continue;
        if (indentation.is_beyond(panel)) {
            now.passed |= bit;
            continue;
        }
        if (!(indents && pushes) && is_in_front(pass, indentation, p, 0.0)) continue;
        PanelMeeting meeting{p, indentation,
                             indentation_by(obstacle, near.before, panel, mesh, pass.scene.settings)};
        meeting.stay_behind(last.behind[p]);
        if (!indents && (passed || !came_from_in_front(pass, p, meeting.before, meeting.indentation))) {
            const auto behind = passed ? std::nullopt : behind_at_corner(pass, k, meeting, motion);
            if (!behind) {
                now.passed |= bit;
                continue;
            }
            meeting.stay_behind(*behind);
        }
        indent(pass, k, meeting, now, list);
    }
    return now;
}

}  // namespace

void find_indentations(ContactPass& pass, std::vector<IndentedPanel>& list,
                       std::vector<IndentedPanels>& now) {
    list.clear();
    now.clear();
    pass.greatest_following = infinity;
    if (pass.mesh.indentation_length == 0.0) return;
    for (std::size_t k = 0; k < pass.near.size(); ++k) {
        if (!draws_in_skin(pass.obstacle(k))) continue;
        const IndentedPanels indented = find_indented_panels(pass, k, list);
        if ((indented.panels | indented.passed) != 0) now.push_back(indented);
    }
    pass.indentations = list;
    for (const IndentedPanels& before : pass.before.indented) {
        pass.indented_before |= before.panels;
        if (pass.scene.obstacles[before.obstacle].top_edge) continue;  // skin that hung over it lags already
        const int still = panels_by(now, before.obstacle).panels;
        pass.left_panels |= static_cast<std::uint8_t>(before.panels & ~still);
    }
    if (pass.indented_before == 0) return;
    pass.greatest_following = 2.0 * pass.margin;
    for (const IndentedPanel& indented : list)
        pass.greatest_following = std::max(pass.greatest_following, indented.growth);
}

}  // namespace birm3d
