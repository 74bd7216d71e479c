// One block of nodes at one instant: what detection hands to the crush, and the crush to friction.
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
    BlockColumn pressure;    // normal force of each node (N)
    BlockColumn nx, ny, nz;  // outward normal at each
    // Where friction acts (m), and the torque of a unit of normal force about the mass centre (m): not kept up at flat
    // surfaces, where they are the node and its own.
    BlockColumn px, py, pz, tx, ty, tz;

    Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
    Places places() const { return {px, py, pz}; }
    Vec3 torque(std::size_t i) const { return {tx[i], ty[i], tz[i]}; }
    void set_normal(const Vec3& n) { nx.fill(n.x()), ny.fill(n.y()), nz.fill(n.z()); }
};

// What each node of a block sees of surfaces of any shape (body axes); its normals now are in the BlockContact.
struct alignas(64) NodeFaces {
    BlockColumn gap;         // of the nearest surface (m)
    BlockColumn bx, by, bz;  // outward normal of the same surface at the instant before
    // Of nodes that an indentation draws in: b is the way itself, and a truss force along it that much greater as a normal force,
    // which acts at the place that the BlockContact says. Zero for others.
    BlockColumn per_force;
};

}  // namespace birm3d
