#include "kernels/detect.hpp"

#include "kernels/detect_block.hpp"
#include "kernels/detect_dispatch.hpp"

namespace birm3d {

Box box_around(const BlockColumn& x, const BlockColumn& y, const BlockColumn& z) {
    Extent extent;
    detect_rows.find_extent({x.data(), y.data(), z.data()}, extent);
    const Eigen::Map<const Vec3> low(extent.low), high(extent.high);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

Extent to_own(const Turn& turn, const BlockColumn& x, const BlockColumn& y, const BlockColumn& z,
              OwnLanes& own) {
    Extent extent;
    detect_rows.place_nodes(turn, {x.data(), y.data(), z.data()}, {own.x.data(), own.y.data(), own.z.data()},
                            extent);
    return extent;
}

}  // namespace birm3d
