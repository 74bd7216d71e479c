// One block of nodes at one instant: the output of detection for the crush, and of the crush for friction.
#pragma once

#include "birm3d/base/block.hpp"
#include "birm3d/base/types.hpp"

namespace birm3d {

// Where the forces on a block of nodes act, body axes (m).
struct Places {
    const BlockColumn &x, &y, &z;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

// One block of nodes beside a surface, body axes.
struct alignas(64) BlockContact {
    BlockColumn normal_force;  // of each node (N)
    BlockColumn nx, ny, nz;    // outward normal at each
    // Where friction acts (m), and the torque of a unit of normal force about the mass centre (m). They are not set
    // at flat surfaces, where the node gives them.
    BlockColumn px, py, pz, tx, ty, tz;

    Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
    Places places() const { return {px, py, pz}; }
    Vec3 torque(std::size_t i) const { return {tx[i], ty[i], tz[i]}; }
    void set_normal(const Vec3& n) { nx.fill(n.x()), ny.fill(n.y()), nz.fill(n.z()); }
};

// The nearest surface of each node of a block (body axes). Its present normal is in the BlockContact.
struct alignas(64) NodeFaces {
    BlockColumn gap;         // of the nearest surface (m)
    BlockColumn bx, by, bz;  // outward normal of the same surface at the start of the step
    // Above zero for nodes that follow an indentation. Then b is the direction of the displacement, and the normal
    // force is this times the truss force along b. It acts at the place in the BlockContact. Zero for other nodes.
    BlockColumn per_force;
};

}  // namespace birm3d
