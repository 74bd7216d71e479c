// Random numbers and laws that hold for every shape.
#pragma once

#include <cmath>
#include <random>

#include "birm3d/geometry/shape.hpp"
#include "geometry/placement.hpp"

namespace laboratory {

// The same numbers on every machine: the standard fixes the engine, not its distributions. It does not fix either in
// which order the arguments of a function are computed, so that one expression draws once.
class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double within(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    birm3d::Vec3 point(const birm3d::Vec3& low, const birm3d::Vec3& high) {
        const double x = within(low.x(), high.x()), y = within(low.y(), high.y());
        return {x, y, within(low.z(), high.z())};
    }
    birm3d::Vec3 direction() {
        for (;;) {
            const birm3d::Vec3 d = point(birm3d::Vec3::Constant(-1.0), birm3d::Vec3::Constant(1.0));
            if (d.norm() > 0.1 && d.norm() < 1.0) return d.normalized();
        }
    }
    birm3d::Mat3 rotation() {
        const birm3d::Vec3 axis = direction();
        return Eigen::AngleAxisd(within(0.0, 6.3), axis).toRotationMatrix();
    }
    birm3d::Placement placement(double far) {
        const birm3d::Mat3 turned = rotation();
        return {turned, point(birm3d::Vec3::Constant(-far), birm3d::Vec3::Constant(far))};
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace laboratory
