#include "contact/corner.hpp"

#include <bit>

#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

// Square of the sine below which two faces make no corner.
constexpr double parallel = 0.01;

// The least of any subset of faces, in the order in which they are tried: the most faces first.
constexpr std::array<unsigned, 7> subsets{7, 3, 5, 6, 1, 2, 4};

// The faces of a subset, one after the other.
struct Faces {
    explicit Faces(unsigned of) {
        for (std::size_t k = 0; k < Corner::most; ++k)
            if ((of >> k & 1U) != 0) at[count++] = k;
    }
    std::array<std::size_t, Corner::most> at{};
    std::size_t count = 0;
};

// Rows and columns beyond the subset are those of the identity.
Mat3 products(const Corner& corner, const Faces& faces) {
    Mat3 products = Mat3::Identity();
    for (std::size_t k = 0; k < faces.count; ++k)
        for (std::size_t j = 0; j < faces.count; ++j)
            products(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) =
                corner.face[faces.at[k]].gradient.dot(corner.face[faces.at[j]].way);
    return products;
}

// Of M x = y, the rows of M being given.
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
    unsigned of = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (face[k].share > 0.0) of |= 1U << k;
    return of;
}

Vec3 Corner::way_onto(unsigned of) const {
    const Faces faces(of);
    if (faces.count == 0) return Vec3::Zero();
    Vec3 gaps = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        gaps[static_cast<Eigen::Index>(k)] = -face[faces.at[k]].gap;
    const Mat3 of_ways = products(*this, faces);
    const Vec3 ways = solve(of_ways.row(0), of_ways.row(1), of_ways.row(2), gaps);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        sum += ways[static_cast<Eigen::Index>(k)] * face[faces.at[k]].way;
    return sum;
}

// Do faces of a subset take all of the truss's force that presses on any of them, each a share above zero?
bool Corner::try_shares(unsigned of, const Vec3& b) {
    const Faces faces(of);
    Vec3 wanted = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k)
        wanted[static_cast<Eigen::Index>(k)] = b.dot(face[faces.at[k]].way);
    const Mat3 of_ways = products(*this, faces);
    const Vec3 shares = solve(of_ways.col(0), of_ways.col(1), of_ways.col(2), wanted);
    Vec3 taken = Vec3::Zero();
    for (std::size_t k = 0; k < faces.count; ++k) {
        if (!(shares[static_cast<Eigen::Index>(k)] > 0.0)) return false;
        taken += shares[static_cast<Eigen::Index>(k)] * face[faces.at[k]].gradient;
    }
    for (std::size_t k = 0; k < count; ++k)
        if ((of >> k & 1U) == 0 && (b - taken).dot(face[k].way) > 0.0) return false;
    for (std::size_t k = 0; k < faces.count; ++k)
        face[faces.at[k]].share = shares[static_cast<Eigen::Index>(k)];
    return true;
}

std::size_t Corner::share_out(const Vec3& b) {
    for (CornerFace& of : face)
        of.share = 0.0;
    for (const unsigned of : subsets)
        if ((of >> count) == 0 && try_shares(of, b)) return static_cast<std::size_t>(std::popcount(of));
    return 0;
}

void Corner::release() {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k)
        if (face[k].share > 0.0 || face[k].gap < -tolerance::touching_gap) face[kept++] = face[k];
    count = kept;
}

}  // namespace birm3d
