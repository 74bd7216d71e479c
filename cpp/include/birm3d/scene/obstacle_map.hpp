// Finds the obstacles near a place. Of a long row of posts only the few that a vehicle can reach are tested.
#pragma once

#include <vector>

#include "birm3d/base/types.hpp"

namespace birm3d {

struct Obstacle;

class ObstacleMap {
  public:
    ObstacleMap() = default;

    // The first `movable` obstacles, and those without end, are found at every place.
    ObstacleMap(const std::vector<Obstacle>& obstacles, std::size_t movable);

    // Those of which any point can be within `reach` of a place (world, m), in their order; possibly more.
    void find(const Vec3& place, double reach, std::vector<std::size_t>& found) const;

  private:
    struct Middle {
        double along;  // of the middle, along the axis (m)
        std::size_t obstacle;
    };
    Eigen::Index axis_ = 0;        // of the world, along which the obstacles are spread the most
    std::vector<Middle> middles_;  // in their order along the axis
    double widest_ = 0.0;          // half, along the axis, of any of these (m)
    std::vector<std::size_t> everywhere_;
};

}  // namespace birm3d
