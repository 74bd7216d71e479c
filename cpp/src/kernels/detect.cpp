#include "kernels/detect.hpp"

#include "kernels/detect_block.hpp"
#include "kernels/simd_table.hpp"

namespace birm3d {

Box box_around(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z) {
    Extent extent;
    simd.find_extent({x.data(), y.data(), z.data()}, extent);
    const Eigen::Map<const Vec3> low(extent.low), high(extent.high);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

Extent to_own(const PlainPlacement& placed, const BlockColumn& x, const BlockColumn& y, const BlockColumn& z,
              OwnNodes& own) {
    Extent extent;
    simd.place_nodes(placed, {x.data(), y.data(), z.data()}, {own.x.data(), own.y.data(), own.z.data()},
                     extent);
    return extent;
}

}  // namespace birm3d
