// An extruded profile: a closed polygon of the own x-z plane, convex or not, drawn along y. Walls, Jersey
// barriers, curbs.
//
// Faces can be covered: they stand on the ground or abut a neighbour and are no surface. |gap| is the distance to the
// faces that are not covered; the gap is negative inside the solid. So a point inside is never pushed out through a
// covered face. Across a covered face the sign of the gap changes and its size does not. Points under a covered
// bottom are outside: where points may get there, extend the profile below the ground.
#pragma once

#include <memory>
#include <vector>

#include "birm3d/geometry/box.hpp"
#include "birm3d/geometry/nearest.hpp"

namespace birm3d {

struct PrismEdge;

class Prism {
  public:
    using Profile = std::vector<Eigen::Vector2d>;

    struct Cover {
        std::vector<std::size_t> edges = {};  // edge i runs from point i of the profile to the next one
        bool low_end = false, high_end = false;
    };

    // `profile`: x and z of the corners (m), either way round. The ends y_low < y_high may be infinite (m). Refuses
    // fewer than 3 points, points that are not finite, edges without length, and edges that touch or cross each
    // other. Refuses to cover an edge that does not exist, or all of the surface.
    Prism(const Profile& profile, double y_low, double y_high, const Cover& cover);

    // A wall: traffic face at x = 0, body at 0 <= x <= thickness, middle at y = 0, -foot <= z <= height,
    // bottom covered. Width and height may be infinite.
    static Prism box(double thickness, double width, double height, double foot = 0.0);

    // Symmetric about x = 0: `half_profile` holds half width and z of the corners, from the lowest one up. The
    // bottom, `foot` below the lowest corner, is covered. Middle at y = 0; the width along y may be infinite.
    static Prism symmetric(const Profile& half_profile, double width, double foot = 0.0);

    // The same body with its ends covered or not: a segment of a longer barrier.
    Prism with_covered_ends(bool low_end, bool high_end) const;

    // Of a point in own axes.
    Nearest nearest(const Vec3& p) const;

    // Lower bound of the distance of all points of the box from the solid (m); 0 if some may be inside. Covered faces
    // count too. Of an endless prism the part that its ends add is left out.
    double no_nearer(const Box& box) const;

    const Box& bounds() const { return bounds_; }  // as of a Shape
    double thickness() const;                      // as of a Shape

    const std::vector<PrismEdge>& edges() const;  // not covered
    const std::vector<PrismEdge>& covered_edges() const;
    double y_low() const { return y_low_; }
    double y_high() const { return y_high_; }
    bool low_end_is_surface() const { return low_end_; }
    bool high_end_is_surface() const { return high_end_; }
    // Is `y` (m, own axes) past an end that abuts a neighbour?
    bool is_past_covered_end(double y) const {
        return (!low_end_ && y < y_low_) || (!high_end_ && y > y_high_);
    }

  private:
    struct Outline;

    Prism(std::shared_ptr<const Outline> outline, double y_low, double y_high, bool cover_low,
          bool cover_high);
    static std::shared_ptr<const Outline> outline_of(const Profile& profile,
                                                     const std::vector<std::size_t>& covered);

    std::shared_ptr<const Outline> outline_;
    Box bounds_;
    double y_low_, y_high_;    // m
    bool low_end_, high_end_;  // is there a surface?
};

}  // namespace birm3d
