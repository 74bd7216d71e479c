// Any barrier as a mesh of triangles, with two ways to find the surface from a point:
//
// nearest: the exact signed distance. The sign comes from the pseudo-normal of the nearest face, edge or
//   corner (J. A. Baerentzen, H. Aanaes, "Signed distance computation using the angle weighted pseudonormal",
//   IEEE Transactions on Visualization and Computer Graphics 11 (2005) 243-253).
// vertex_to_face: the paper's section 5.1, Eq. 8-15. Deviations:
//   - A face is all the neighbouring triangles of one plane. So a contact does not depend on how a flat face is divided.
//   - Eq. 12-14 as printed move away from the plane. P2 is p - gap n and P1 is p - (gap / X) r with X = r . n.
//   - Eq. 15 has a relative tolerance. Of several faces that meet both conditions the nearest plane counts.
//
// A mesh may be open. Then its rim is no surface that one could be behind: points nearest to it are outside.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "birm3d/geometry/box.hpp"
#include "birm3d/geometry/nearest.hpp"

namespace birm3d {

struct TriangleMeshData;

class TriangleMesh {
  public:
    using Face = std::array<std::int64_t, 3>;

    // `vertices` (n) in m; `faces` (m, 3): indices into them, counter-clockwise seen from outside. A closed mesh
    // whose faces all run the other way is turned. Vertices at the same place are one. The surface must not cross
    // itself, which is not checked. Refuses a mesh without faces, indices out of range, numbers that are not finite,
    // and triangles without area. Refuses edges of more than two faces, and neighbours that pass their common edge in
    // the same direction.
    TriangleMesh(const std::vector<Vec3>& vertices, const std::vector<Face>& faces);

    // Of a point in own axes. `hint`: a triangle to begin with, then the nearest one; a good one saves time.
    Nearest nearest(const Vec3& p) const;
    Nearest nearest(const Vec3& p, std::size_t& hint) const;

    // The face that a vertex at `p` has come through while it moved along `direction` (of any length): p is
    // behind its plane, the way back leads through the face (P1) after `longest` at the most (m), and so does
    // the normal (P2). None, if no face meets both conditions. It does not ask whether p is inside at all.
    std::optional<Nearest> vertex_to_face(const Vec3& p, const Vec3& direction,
                                          double longest = infinity) const;

    // What a vertex touches that has come to `p` by the motion `motion` (m); `exact`: what nearest says of p.
    // Outside the mesh: that. Inside: vertex_to_face, where the motion leads through the face; else (beside an
    // edge, at rest, moving along the surface) nearest, so that no vertex inside is ever lost.
    Nearest contact(const Vec3& p, const Vec3& motion, const Nearest& exact) const;

    Box bounds() const;        // as of a Shape
    double thickness() const;  // as of a Shape
    bool closed() const;
    std::size_t triangle_count() const;
    const std::array<Vec3, 3>& corners(std::size_t triangle) const;

    const TriangleMeshData& data() const { return *data_; }

  private:
    std::shared_ptr<const TriangleMeshData> data_;
};

}  // namespace birm3d
