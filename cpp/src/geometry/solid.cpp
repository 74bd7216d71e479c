#include "birm3d/geometry/solid.hpp"

namespace birm3d {

Vec3 centroid(const Tetrahedron& t) {
    return 0.25 * (t[0] + t[1] + t[2] + t[3]);
}

double signed_volume(const Tetrahedron& t) {
    return (t[1] - t[0]).dot((t[2] - t[0]).cross(t[3] - t[0])) / 6.0;
}

Mat3 central_inertia(const Tetrahedron& t) {
    const Vec3 center = centroid(t);
    Mat3 sum = Mat3::Zero();
    for (const Vec3& vertex : t) {
        const Vec3 k = vertex - center;
        sum += k.squaredNorm() * Mat3::Identity() - k * k.transpose();
    }
    return signed_volume(t) / 20.0 * sum;
}

std::array<Tetrahedron, 6> split(const Hexahedron& h) {
    // Walk around the diagonal 0-6 through the six nodes off it; consecutive ones span a tetrahedron with it.
    constexpr std::array<std::size_t, 7> ring = {1, 2, 3, 7, 4, 5, 1};
    std::array<Tetrahedron, 6> parts;
    for (std::size_t i = 0; i < 6; ++i)
        parts[i] = {h[0], h[ring[i]], h[ring[i + 1]], h[6]};
    return parts;
}

}  // namespace birm3d
