#include "birm3d/kernels/detect.hpp"

#include "kernels/detect_lanes.hpp"

namespace birm3d {

BIRM3D_LANE_LOOP void extent(const Lanes& values, double& low, double& high) {
    alignas(64) Lanes least = values, most = values;
    for (std::size_t half = lanes / 2; half > 0; half /= 2) {
        BIRM3D_INDEPENDENT
        for (std::size_t i = 0; i < half; ++i) {
            least[i] = least[half + i] < least[i] ? least[half + i] : least[i];
            most[i] = most[half + i] > most[i] ? most[half + i] : most[i];
        }
    }
    low = least[0];
    high = most[0];
}

Box box_around(const Lanes& x, const Lanes& y, const Lanes& z) {
    Vec3 low, high;
    extent(x, low[0], high[0]);
    extent(y, low[1], high[1]);
    extent(z, low[2], high[2]);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

}  // namespace birm3d
