// A dent drags its surroundings along: beside a narrow obstacle the skin is drawn in with a slope of its own,
//   d_j >= d_i - slope |p_j - p_i|   for every node i that the obstacle presses,
// with d the deflections of the trusses and p the uncrushed places of their nodes. A node j that hangs on a node i
// moves along its own truss, and its truss force F_j loads node i as if it were the own one of truss i: both have the
// same rate of deflection, so that is what virtual work asks for. Nodes hang on nodes of the same panel, whose trusses
// point the same way.
//
// A flat wall presses neighbours alike: there nothing hangs on anything. Not in the paper, whose trusses know nothing of
// each other: between them a narrow post passes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "birm3d/model/truss_mesh.hpp"

namespace birm3d {

// A node that an obstacle presses.
struct DentDriver {
    Vec3 place;         // uncrushed, body axes (m)
    Vec3 direction;     // of its uncrushed truss, from the anchor to the node
    double deflection;  // m
};

// Some drivers that stand together, from `first` to before `last`.
struct DentGroup {
    std::size_t first, last;
    Box box;         // around their places
    double deepest;  // m
};
std::vector<DentGroup> grouped(std::span<const DentDriver> drivers);

// What hangs on the drivers in one block.
struct alignas(64) Hanging {
    Lanes deflection;                       // that each node is drawn in to; below zero: none (m)
    // On which each hangs, half on the one and half on the other where two draw it in alike.
    std::array<std::size_t, lanes> driver, second;
};

// `box`: around the uncrushed nodes of the block.
void hang(const TrussBlock& trusses, const Box& box, double slope, std::span<const DentDriver> drivers,
          std::span<const DentGroup> groups, Hanging& hanging);

}  // namespace birm3d
