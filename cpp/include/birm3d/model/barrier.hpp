// A barrier: its elements, each a shape with a place, and what the vehicle feels of them. Its line runs along +y at
// heading 0, its traffic face looks to -x.
#pragma once

#include <optional>
#include <vector>

#include "birm3d/base/types.hpp"
#include "birm3d/geometry/shape.hpp"
#include "birm3d/model/moving_element.hpp"

namespace birm3d {

// A wall or a segment of it, a post, a mesh: loads are reported element by element.
struct Element {
    Shape shape;  // own axes: z up, unless upright
    // Of the own axes' origin, from the barrier's origin: the foot, or a post's centre of rotation (m).
    Vec3 position = Vec3::Zero();
    double heading = 0.0;  // turn of the own axes about z (rad)
    bool upright = false;  // own y points up and own z to lower y: a prism drawn upwards from its plan
    // Index of an element before it that this one is a part of, as a wall's rounded edge: loads are that one's. None: it is
    // no part.
    std::optional<std::size_t> part_of = {};
    // Is the skin above the top edge of its vertical traffic face drawn in with the skin before the face? Only of a prism.
    bool draws_in_above = false;

    Mat3 rotation() const;  // own axes to the barrier's
};

struct Barrier {
    // origin, heading: of the line, world. friction: Coulomb coefficient vehicle-barrier. free_standing: absent where it does
    // not slide; else all elements are prisms, see segment_of(), and pinned ones follow each other end to end along y.
    // yielding: absent where no post yields; else all elements are posts.
    Barrier(std::vector<Element> elements, double friction, const Vec3& origin, double heading,
            const std::optional<FreeStanding>& free_standing = {},
            const std::optional<YieldingPosts>& yielding = {});

    // Flat, without end. origin: a point of the traffic face's foot (m). heading: turn of the line about z (rad).
    static Barrier wall(double friction, const Vec3& origin, double heading);

    // Upright cylinder, taller than what meets it. origin: foot of its axis, on the barrier's line.
    static Barrier pole(double friction, const Vec3& origin, double heading, double radius);

    Vec3 normal() const;  // of the barrier's line, towards the traffic
    double top() const;   // greatest height above the ground (m); infinite for half-spaces and endless posts

    std::vector<Element> elements;
    double friction;  // Coulomb coefficient vehicle-barrier (paper 5.4: 0.15 to 0.20 steel on concrete)
    Vec3 origin;      // m, world
    double heading;   // rad
    std::optional<FreeStanding> free_standing;
    std::optional<YieldingPosts> yielding;
    // (elements) where they are free-standing or yield; else none.
    std::vector<MovingElement> moving_elements;
};

}  // namespace birm3d
