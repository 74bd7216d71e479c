#include "birm3d/scene/obstacle_map.hpp"

#include <random>

#include "check.hpp"
#include "laboratory.hpp"
#include "scene/obstacles.hpp"

using namespace birm3d;

namespace {

Obstacle standing(const Shape& shape, const Vec3& position, double heading) {
    return {shape, Eigen::AngleAxisd(heading, Vec3::UnitZ()).toRotationMatrix(), position, 0.0, 0};
}

}  // namespace

TEST("every obstacle within reach of a place is found, in order, and few others of a long row") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    for (const double row_heading : {0.0, 0.7, 1.6}) {
        const Vec3 along(-std::sin(row_heading), std::cos(row_heading), 0.0);
        std::vector<Obstacle> obstacles;
        for (int i = 0; i < 500; ++i)
            obstacles.push_back(standing(Post(0.1 + 0.05 * share(random), 1.0),
                                         1.5 * (i - 250) * along + 0.3 * share(random) * Vec3::UnitX(), 0.0));
        obstacles.push_back(standing(Prism::box(0.3, 6.0, 1.0), {4.0, 30.0, 0.0}, 0.5));
        obstacles.push_back(standing(HalfSpace{Vec3::UnitZ(), 0.0}, Vec3::Zero(), 0.0));
        const ObstacleMap map(obstacles, 2);
        for (int round = 0; round < 300; ++round) {
            const Vec3 place =
                400.0 * share(random) * along + 5.0 * share(random) * Vec3::UnitX() + Vec3::UnitZ();
            const double reach = 4.0 + 3.0 * share(random);
            std::vector<std::size_t> found;
            map.find(place, reach, found);
            CHECK(std::is_sorted(found.begin(), found.end()));
            CHECK(found.size() < 30);
            for (std::size_t i = 0; i < obstacles.size(); ++i) {
                const Obstacle& obstacle = obstacles[i];
                const Vec3 own = obstacle.rotation.transpose() * (place - obstacle.position);
                const bool within = nearest(obstacle.shape, own).gap <= reach;
                const bool listed = std::binary_search(found.begin(), found.end(), i);
                CHECK(listed || !within);
                if (i < 2 || i + 1 == obstacles.size()) CHECK(listed);
            }
        }
    }
}
