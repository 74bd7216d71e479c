#include "contact/corner.hpp"

#include <bit>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Square of the sine of the angle between two faces below which they make no corner.
constexpr double parallel = 0.01;

// Bit sets of faces in the order in which they are tried: those with the most faces first.
constexpr std::array<unsigned, 7> subsets{7, 3, 5, 6, 1, 2, 4};

// The faces of a subset, one after the other.
struct Faces {
    explicit Faces(unsigned subset) {
        for (std::size_t k = 0; k < Corner::most; ++k)
            if ((subset >> k & 1U) != 0) at[count++] = k;
    }
    std::array<std::size_t, Corner::most> at{};
    std::size_t count = 0;
};

// The matrix of q_k . h_j: how the gap of face k changes for each metre that face j displaces the node. Rows and columns
// beyond the subset are those of the identity.
Mat3 products(const Corner& corner, const Faces& faces) {
    Mat3 products = Mat3::Identity();
    for (std::size_t k = 0; k < faces.count; ++k)
        for (std::size_t j = 0; j < faces.count; ++j)
            products(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) =
                corner.face[faces.at[k]].gradient.dot(corner.face[faces.at[j]].direction);
    return products;
}

// The solution x of M x = y. `a`, `b` and `c` are the rows of M.
Vec3 solve(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& y) {
    const Vec3 across = b.cross(c);
    return (y.x() * across + y.y() * c.cross(a) + y.z() * a.cross(b)) / a.dot(across);
}

}  // namespace

bool Corner::add(const CornerFace& further) {
    if (count == most) return false;
    Vec3 rest = further.normal;
    std::array<Vec3, most> axes;
    for (std::size_t k = 0; k < count; ++k) {
        axes[k] = face[k].normal;
        for (std::size_t j = 0; j < k; ++j)
            axes[k] -= axes[k].dot(axes[j]) * axes[j];
        axes[k].normalize();
        rest -= rest.dot(axes[k]) * axes[k];
    }
    if (rest.squaredNorm() < parallel) return false;
    face[count++] = further;
    return true;
}

unsigned Corner::pushing() const {
    unsigned subset = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (face[k].weight > 0.0) subset |= 1U << k;
    return subset;
}

Vec3 Corner::displacement_onto(unsigned subset) const {
    const Faces faces(subset);
    if (faces.count == 0) return Vec3::Zero();
    Vec3 gaps = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        gaps[static_cast<Eigen::Index>(k)] = -face[faces.at[k]].gap;
    const Mat3 system = products(*this, faces);
    const Vec3 amounts = solve(system.row(0), system.row(1), system.row(2), gaps);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        sum += amounts[static_cast<Eigen::Index>(k)] * face[faces.at[k]].direction;
    return sum;
}

// Can the faces of a subset carry the truss's force with positive weights, so that it presses on no other face?
bool Corner::try_weights(unsigned subset, const Vec3& b) {
    const Faces faces(subset);
    Vec3 required = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        required[static_cast<Eigen::Index>(k)] = b.dot(face[faces.at[k]].direction);
    const Mat3 system = products(*this, faces);
    const Vec3 weights = solve(system.col(0), system.col(1), system.col(2), required);
    Vec3 taken = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k) {
        if (!(weights[static_cast<Eigen::Index>(k)] > 0.0)) return false;
        taken += weights[static_cast<Eigen::Index>(k)] * face[faces.at[k]].gradient;
    }
    for (std::size_t k = 0; k < count; ++k)
        if ((subset >> k & 1U) == 0 && (b - taken).dot(face[k].direction) > 0.0) return false;
    for (std::size_t k = 0; k < faces.count; ++k)
        face[faces.at[k]].weight = weights[static_cast<Eigen::Index>(k)];
    return true;
}

std::size_t Corner::distribute(const Vec3& b) {
    for (CornerFace& each : face)
        each.weight = 0.0;
    for (const unsigned subset : subsets)
        if ((subset >> count) == 0 && try_weights(subset, b))
            return static_cast<std::size_t>(std::popcount(subset));
    return 0;
}

void Corner::release() {
    const Vec3 moved = pushed_displacement();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const bool inside = face[k].gap + face[k].gradient.dot(moved) < -tolerance::touching_gap;
        if (face[k].weight > 0.0 || inside) face[kept++] = face[k];
    }
    count = kept;
}

}  // namespace birm3d
