#include "geometry/triangle_mesh_data.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"

namespace birm3d {

namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

std::string face_name(std::size_t i) {
    return "faces[" + std::to_string(i) + "]";
}

std::string edge_name(std::size_t a, std::size_t b) {
    return "edge " + std::to_string(a) + "-" + std::to_string(b);
}

// For each vertex the first one at the same place.
std::vector<std::size_t> first_at_place(const std::vector<Vec3>& vertices) {
    std::vector<std::size_t> order(vertices.size()), first(vertices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        for (int k = 0; k < 3; ++k)
            if (vertices[a][k] != vertices[b][k]) return vertices[a][k] < vertices[b][k];
        return a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] =
            i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

std::vector<Triangle> checked_triangles(const std::vector<Vec3>& vertices,
                                        const std::vector<TriangleMesh::Face>& faces) {
    if (faces.empty()) refuse("faces", "1 or more", 0.0);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!vertices[i].allFinite())
            refuse("vertices[" + std::to_string(i) + "]", "finite", "a number that is not");
    const std::vector<std::size_t> first = first_at_place(vertices);
    std::vector<Triangle> triangles(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        Triangle& t = triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int64_t index = faces[i][k];
            if (index < 0 || static_cast<std::size_t>(index) >= vertices.size())
                refuse(face_name(i), "indices from 0 to " + std::to_string(vertices.size()) + " - 1",
                       std::to_string(index));
            t.vertex[k] = first[static_cast<std::size_t>(index)];
            t.corner[k] = vertices[t.vertex[k]];
        }
        const Vec3 across = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
        t.area = 0.5 * across.norm();
        double longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, (t.corner[(k + 1) % 3] - t.corner[k]).norm());
        const double height = longest > 0.0 ? 2.0 * t.area / longest : 0.0;
        if (!(height > tolerance::triangle_height * longest))
            refuse(face_name(i),
                   "a triangle with a height above " + to_text(tolerance::triangle_height) +
                       " of its longest edge",
                   longest > 0.0 ? height / longest : 0.0);
        t.normal = across / (2.0 * t.area);
        t.offset = t.normal.dot(t.corner[0]);
    }
    return triangles;
}

// neighbour[3 i + k]: the triangle beyond edge k of triangle i, or none.
std::vector<std::size_t> neighbours(const std::vector<Triangle>& triangles) {
    struct Side {
        std::size_t low, high;  // vertices
        bool upwards;
        std::size_t slot;  // 3 i + k
    };
    std::vector<Side> sides;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = triangles[i].vertex[k], b = triangles[i].vertex[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a < b, 3 * i + k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.slot < b.slot;
    });
    std::vector<std::size_t> beyond(3 * triangles.size(), none);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
            ++end;
        const std::string name = edge_name(sides[i].low, sides[i].high);
        if (end - i > 2)
            refuse(name + " of the mesh", "shared by two faces at the most", std::to_string(end - i));
        if (end - i == 2) {
            if (sides[i].upwards == sides[i + 1].upwards)
                refuse(name + " of the mesh", "run through in opposite directions by its two faces",
                       "the same direction in " + face_name(sides[i].slot / 3) + " and " +
                           face_name(sides[i + 1].slot / 3));
            beyond[sides[i].slot] = sides[i + 1].slot / 3;
            beyond[sides[i + 1].slot] = sides[i].slot / 3;
        }
        i = end;
    }
    return beyond;
}

double twelvefold_volume(const std::vector<Triangle>& triangles) {
    const Vec3 from = triangles[0].corner[0];
    double sum = 0.0;
    for (const Triangle& t : triangles)
        sum += 4.0 * t.area * t.normal.dot(t.corner[0] - from);
    return sum;
}

// Turns every triangle over; `beyond` follows.
void flip(std::vector<Triangle>& triangles, std::vector<std::size_t>& beyond) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Triangle& t = triangles[i];
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.vertex[1], t.vertex[2]);
        std::swap(beyond[3 * i], beyond[3 * i + 2]);
        t.normal = -t.normal;
        t.offset = -t.offset;
    }
}

// Neighbours whose corners all lie in the plane of the first form one face and take over its plane. Faces begin
// with the largest triangles, whose normals are the most accurate.
void join_flat_faces(std::vector<Triangle>& triangles, const std::vector<std::size_t>& beyond, double size) {
    std::vector<std::size_t> order(triangles.size()), open;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return triangles[a].area != triangles[b].area ? triangles[a].area > triangles[b].area : a < b;
    });
    for (Triangle& t : triangles)
        t.face = none;
    std::size_t face = 0;
    for (const std::size_t seed : order) {
        if (triangles[seed].face != none) continue;
        const Vec3 normal = triangles[seed].normal;
        const double offset = triangles[seed].offset;
        triangles[seed].face = face;
        open.assign(1, seed);
        while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t j = beyond[3 * i + k];
                if (j == none || triangles[j].face != none) continue;
                Triangle& t = triangles[j];
                bool flat = t.normal.dot(normal) > 0.0;
                for (const Vec3& corner : t.corner)
                    flat = flat && std::abs(normal.dot(corner) - offset) <= tolerance::flat_face * size;
                if (!flat) continue;
                t.face = face;
                t.normal = normal;
                t.offset = offset;
                open.push_back(j);
            }
        }
        ++face;
    }
}

// Pseudo-normals: of an edge the sum of its two normals, of a corner the sum of all normals weighted with the
// angles there.
void set_vicinities(std::vector<Triangle>& triangles, const std::vector<std::size_t>& beyond,
                    std::size_t vertex_count) {
    std::vector<Vec3> at_vertex(vertex_count, Vec3::Zero());
    std::vector<Vicinity> kind(vertex_count, Vicinity::flat);
    std::vector<std::size_t> face(vertex_count, none);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t v = t.vertex[k];
            const Vec3 a = t.corner[(k + 1) % 3] - t.corner[k], b = t.corner[(k + 2) % 3] - t.corner[k];
            at_vertex[v] += std::atan2(a.cross(b).norm(), a.dot(b)) * t.normal;
            if (face[v] == none) face[v] = t.face;
            if (face[v] != t.face && kind[v] == Vicinity::flat) kind[v] = Vicinity::bent;
            if (beyond[3 * i + k] == none || beyond[3 * i + (k + 2) % 3] == none) kind[v] = Vicinity::rim;
        }
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Triangle& t = triangles[i];
        t.pseudo_normal[inner] = t.normal;
        t.vicinity[inner] = Vicinity::flat;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t j = beyond[3 * i + k];
            t.pseudo_normal[edge_0 + k] = j == none ? t.normal : Vec3(t.normal + triangles[j].normal);
            t.vicinity[edge_0 + k] = j == none                     ? Vicinity::rim
                                     : triangles[j].face == t.face ? Vicinity::flat
                                                                   : Vicinity::bent;
            t.pseudo_normal[corner_0 + k] = at_vertex[t.vertex[k]];
            t.vicinity[corner_0 + k] = kind[t.vertex[k]];
        }
    }
}

}  // namespace

std::vector<Triangle> triangles_of(const std::vector<Vec3>& vertices,
                                   const std::vector<TriangleMesh::Face>& faces, bool& closed) {
    std::vector<Triangle> triangles = checked_triangles(vertices, faces);
    std::vector<std::size_t> beyond = neighbours(triangles);
    closed = std::find(beyond.begin(), beyond.end(), none) == beyond.end();
    if (closed && twelvefold_volume(triangles) < 0.0) flip(triangles, beyond);
    double size = 0.0;
    for (const Triangle& t : triangles)
        for (const Vec3& corner : t.corner)
            size = std::max(size, (corner - triangles[0].corner[0]).norm());
    join_flat_faces(triangles, beyond, size);
    set_vicinities(triangles, beyond, vertices.size());
    for (Triangle& t : triangles)
        t.plain = plain_triangle(t.corner);
    return triangles;
}

}  // namespace birm3d
