#include "birm3d/scene/obstacle_map.hpp"

#include <algorithm>
#include <cmath>

#include "birm3d/scene/scene.hpp"

namespace birm3d {

ObstacleMap::ObstacleMap(const std::vector<Obstacle>& obstacles, std::size_t movable) {
    struct Bounds {
        std::size_t obstacle;
        Vec3 middle, half;  // world (m)
    };
    std::vector<Bounds> bounded;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const Obstacle& obstacle = obstacles[i];
        const Box box = bounds(obstacle.shape);
        // Posts may extend downwards to infinity: the horizontal extent is enough.
        Vec3 half = Vec3::Zero();
        for (Eigen::Index k = 0; k < 3; ++k)
            for (Eigen::Index j = 0; j < 2; ++j) {
                const double cosine = std::abs(obstacle.rotation(j, k));
                if (cosine > 0.0) half[j] += cosine * box.half[k];
            }
        const Vec3 middle = obstacle.position + obstacle.rotation * box.center;
        const bool ends = std::isfinite(half.x()) && std::isfinite(half.y()) && middle.head<2>().allFinite();
        if (i < movable || !ends)
            everywhere_.push_back(i);
        else
            bounded.push_back({i, middle, half});
    }
    if (bounded.empty()) return;
    Vec3 low = bounded[0].middle, high = low;
    for (const Bounds& b : bounded) {
        low = low.cwiseMin(b.middle);
        high = high.cwiseMax(b.middle);
    }
    axis_ = high.x() - low.x() > high.y() - low.y() ? 0 : 1;
    for (const Bounds& b : bounded) {
        middles_.push_back({b.middle[axis_], b.obstacle});
        widest_ = std::max(widest_, b.half[axis_]);
    }
    std::sort(middles_.begin(), middles_.end(), [](const Middle& a, const Middle& b) {
        return a.along != b.along ? a.along < b.along : a.obstacle < b.obstacle;
    });
}

void ObstacleMap::find(const Vec3& place, double reach, std::vector<std::size_t>& found) const {
    found = everywhere_;
    const double far = reach + widest_;
    const auto from = std::partition_point(middles_.begin(), middles_.end(),
                                           [&](const Middle& m) { return m.along < place[axis_] - far; });
    const auto to = std::partition_point(from, middles_.end(),
                                         [&](const Middle& m) { return m.along <= place[axis_] + far; });
    for (auto at = from; at != to; ++at)
        found.push_back(at->obstacle);
    std::sort(found.begin(), found.end());
}

}  // namespace birm3d
