// Which panels a post, an edge or a face with a top edge can indent, and where it stands as it comes to one.
#include <cmath>

#include "kernels/indentation.hpp"

namespace birm3d {

namespace {

// Cosine of the angle between a post's axis and a panel's direction: beyond the first the post does not begin to indent the
// panel, beyond the second it ceases to.
constexpr double most_tilted = 0.5, overturned = 0.95;

// Cosine by which a face that looks at the traffic points at a panel, see facing(). Above the first its edge or its top begins to
// indent the panel; below the second the top stops.
constexpr double least_facing = 0.7, turned_away = 0.3;

// The same cosines of any face of an edge, where the panel comes towards the edge.
constexpr double least_facing_ahead = 0.3, edge_turned_away = 0.1;

// A panel comes towards an edge if this cosine is exceeded: of the angle between its outward direction and its velocity at the
// edge. A panel that slides along the end of a wall meets the edge as it meets any surface.
constexpr double least_approach = 0.7;

// Cosine of the angle between a panel's outward direction and the direction into the block behind a face; 1 if the face points
// at the panel. `behind`: the latter, own axes.
double facing(const Panel& panel, const Placement& stands, const Vec3& behind) {
    return -panel.inward.dot(stands.direction_from_own(behind));
}

bool is_upright(const Placement& stands, const Panel& panel, bool indents) {
    const double cosine = std::abs(stands.direction_from_own(Vec3::UnitZ()).dot(panel.inward));
    return cosine < (indents ? overturned : most_tilted);
}

}  // namespace

bool comes_towards(const Panel& panel, const Placement& stands, const Twist& motion, double least) {
    const Vec3 velocity = motion.velocity + motion.angular_velocity.cross(stands.from_own(Vec3::Zero()));
    return -panel.inward.dot(velocity) > least * velocity.norm();
}

bool can_indent(const Post& post, const Placement& stands, const Panel& panel, const Twist& motion,
                bool indents) {
    if (!is_upright(stands, panel, indents)) return false;
    if (!post.opens) return true;
    for (int k = 0; k < 2; ++k) {
        const Vec3 behind = post.along_face(k);  // the other face
        const double cosine = facing(panel, stands, behind);
        const bool looks_at_traffic = behind.x() > 0.5;
        if (indents && cosine > edge_turned_away) return true;
        if (looks_at_traffic && cosine > least_facing) return true;
        if (cosine > least_facing_ahead && comes_towards(panel, stands, motion, least_approach)) return true;
    }
    return false;
}

bool can_indent(const TopEdge&, const Placement& stands, const Panel& panel, bool indents) {
    return is_upright(stands, panel, indents) &&
           facing(panel, stands, Vec3::UnitX()) > (indents ? turned_away : least_facing);
}

Indentation between(const Indentation& one, const Indentation& other, double fraction) {
    constexpr double Indentation::* places[] = {
        &Indentation::ox,      &Indentation::oy,     &Indentation::oz,
        &Indentation::low,     &Indentation::high,   &Indentation::top,
        &Indentation::surface, &Indentation::bottom, &Indentation::ceiling};
    Indentation middle = other;
    for (const auto place : places)
        middle.*place = one.*place + fraction * (other.*place - one.*place);
    return middle;
}

Indentation as_deep_as(const Indentation& place, const Indentation& other) {
    const Vec3 foot = place.foot() + (other.foot() - place.foot()).dot(place.into()) * place.into();
    Indentation moved = place;
    moved.ox = foot.x(), moved.oy = foot.y(), moved.oz = foot.z();
    moved.surface = other.surface;
    return moved;
}

}  // namespace birm3d
