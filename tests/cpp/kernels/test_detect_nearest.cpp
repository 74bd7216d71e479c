// Blocks of nodes against single points.
#include "check.hpp"
#include "geometry/meshes.hpp"
#include "geometry/random_points.hpp"
#include "kernels/detect.hpp"

using namespace birm3d;

namespace {

const Prism::Profile jersey_half = {{0.3048, 0.0}, {0.3048, 0.0762}, {0.127, 0.3302}, {0.0762, 0.8128}};
const Prism::Profile notched = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.5, 0.4}, {0.0, 1.0}};

// A wave with more edges than are looked through.
Prism::Profile wave() {
    Prism::Profile profile;
    for (int i = 0; i <= 20; ++i)
        profile.emplace_back(0.1 * i - 1.0, 0.3 + 0.1 * std::sin(1.3 * i));
    profile.emplace_back(1.0, -0.5);
    profile.emplace_back(-1.0, -0.5);
    return profile;
}

std::vector<Shape> shapes() {
    return {HalfSpace{Vec3(0.6, 0.0, 0.8), 0.3},
            Post(0.2, 0.9),
            Post(0.2),
            Prism::box(0.4, 2.0, 0.8),
            Prism::box(0.4, 2.0, 0.8, 1.0),
            Prism::box(0.4, infinity, infinity),
            Prism::box(0.4, 2.0, 0.8).with_covered_ends(true, false),
            Prism::symmetric(jersey_half, 2.0),
            Prism::symmetric(jersey_half, infinity, 0.5),
            Prism(notched, -0.8, 1.1, {.edges = {0, 3}, .low_end = true}),
            Prism(notched, -0.8, infinity, {}),
            Prism(wave(), -0.9, 1.0, {.edges = {21, 22}}),
            laboratory::extruded({{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}}, {0.2, 0.4}, -0.5, 0.7, 3)
                .mesh(),
            laboratory::post(0.3, -1.0, 0.9, 12).mesh()};
}

struct Block {
    Block(laboratory::Random& random, const Placement& now, double size) {
        const Vec3 middle = random.point(Vec3::Constant(-0.8), Vec3::Constant(1.2));
        for (std::size_t i = 0; i < block_size; ++i) {
            const Vec3 p = now.from_own(middle + random.point(Vec3::Constant(-size), Vec3::Constant(size)));
            x[i] = p.x(), y[i] = p.y(), z[i] = p.z();
        }
    }
    Vec3 node(std::size_t i) const { return {x[i], y[i], z[i]}; }
    Box box() const {
        return Box::around(block_size, [&](std::size_t i) { return node(i); });
    }

    BlockColumn x, y, z;
};

}  // namespace

TEST("a block of nodes sees what single points see, from anywhere") {
    laboratory::Random random(31);
    for (const Shape& shape : shapes())
        for (int k = 0; k < 150; ++k) {
            const Placement now = random.placement(3.0);
            const Block block(random, now, random.within(0.01, 0.8));
            NearestOfBlock out;
            nearest_of(shape, now, now, block.x, block.y, block.z, out);
            for (std::size_t i = 0; i < block_size; ++i) {
                const Nearest exact = nearest(shape, now.to_own(block.node(i)));
                const Vec3 normal(out.nx[i], out.ny[i], out.nz[i]);
                CHECK_CLOSE(out.gap[i], exact.gap, 1e-13, "rounding of places some metres away");
                // Where two faces are equally near the other one may be taken, and near edges the normal
                // follows the rounding of the place.
                const double turn = (now.rotation * normal - exact.normal).norm();
                const double foot =
                    std::abs(nearest(shape, now.to_own(block.node(i) - out.gap[i] * normal)).gap);
                CHECK(turn < 1e-12 || turn < 1e-12 / std::abs(exact.gap) || foot < 1e-13);
            }
        }
}

TEST("nodes inside and those with a force are seen as if all were asked for; the others are outside") {
    laboratory::Random random(32);
    std::size_t left_out = 0, inside = 0;
    for (const Shape& shape : shapes())
        for (int k = 0; k < 50; ++k) {
            const Placement now = random.placement(3.0);
            const Block block(random, now, random.within(0.05, 0.5));
            BlockColumn force{};
            force[static_cast<std::size_t>(k)] = 1e-30;
            NearestOfBlock all, some;
            nearest_of(shape, now, now, block.x, block.y, block.z, all);
            nearest_of(shape, now, now, block.x, block.y, block.z, some, &force);
            for (std::size_t i = 0; i < block_size; ++i) {
                left_out += some.gap[i] == infinity;
                inside += all.gap[i] < 0.0;
                if (some.gap[i] == infinity) {
                    CHECK(all.gap[i] >= 0.0 && force[i] == 0.0);
                    continue;
                }
                CHECK(some.gap[i] == all.gap[i]);
                CHECK(some.nx[i] == all.nx[i] && some.ny[i] == all.ny[i] && some.nz[i] == all.nz[i]);
            }
        }
    CHECK(left_out > 1000 && inside > 1000);
}

TEST("the nodes at rest, those that moved: a mesh asks where they came from") {
    const Shape wall =
        laboratory::extruded({{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.8}, {0.0, 0.8}}, {0.2, 0.4}, -1.0, 1.0, 3)
            .mesh();
    const Placement now{Mat3::Identity(), Vec3(0.1, 0.0, 0.77)};  // behind the front, below the top
    BlockColumn x{}, y{}, z{};
    NearestOfBlock out;
    nearest_of(wall, now, now, x, y, z, out);
    CHECK_CLOSE(out.gap[0], -0.03, 1e-15, "at rest: the top is nearest");
    const Placement before{Mat3::Identity(), Vec3(-0.1, 0.0, 0.77)};
    nearest_of(wall, now, before, x, y, z, out);
    CHECK_CLOSE(out.gap[63], -0.1, 1e-15, "it came through the front");
    CHECK_CLOSE(out.nx[63], -1.0, 1e-15, "it came through the front");
}

TEST("what is out of reach is farther than the margin") {
    laboratory::Random random(33);
    for (const Shape& shape : shapes()) {
        int out_of_reach = 0, useless = 0;
        for (int k = 0; k < 600; ++k) {
            const Placement now = random.placement(2.0);
            const Block block(random, now, random.within(0.01, 0.5));
            const double margin = random.within(0.0, 0.3);
            const bool reach = within_reach(shape, now, block.box(), margin);
            double least = infinity;
            for (std::size_t i = 0; i < block_size; ++i)
                least = std::min(least, nearest(shape, now.to_own(block.node(i))).gap);
            if (!reach) CHECK(least >= margin);
            out_of_reach += !reach;
            useless += reach && least > margin + 2.0;
        }
        CHECK(useless == 0);
        CHECK(out_of_reach > 5);
    }
}

TEST("a deep box across the bottom of a wall is within reach") {
    const Shape wall = Prism::box(4.0, 8.0, 1.0);
    CHECK(within_reach(wall, {}, {{2.0, 0.0, -0.01}, {0.1, 0.1, 0.1}}, 0.05));
    CHECK(!within_reach(wall, {}, {{2.0, 0.0, -0.2}, {0.1, 0.1, 0.1}}, 0.05));
    CHECK(within_reach(Post(0.2), {}, {{0.5, 0.0, 0.0}, {0.2, 0.2, 0.2}}, 0.11));
    CHECK(!within_reach(Post(0.2), {}, {{0.5, 0.0, 0.0}, {0.2, 0.2, 0.2}}, 0.09));
}

TEST("a flat part is the nearest surface to the whole box, and is found where it should be") {
    laboratory::Random random(35);
    for (const Shape& shape : shapes()) {
        int found = 0;
        double worst = 0.0;
        for (int k = 0; k < 3000; ++k) {
            // Also upright: random turns alone are seldom along a face.
            Placement now = random.placement(2.0);
            if (k % 2) now.rotation = Eigen::AngleAxisd(random.within(0.0, 6.3), Vec3::UnitZ()).matrix();
            const Block block(random, now, random.within(0.01, 0.3));
            const Box box = block.box();
            const auto flat = flat_part(shape, now, box);
            if (!flat) continue;
            ++found;
            // Its nodes and its corners.
            BlockColumn x = block.x, y = block.y, z = block.z;
            for (std::size_t c = 0; c < 8; ++c) {
                const auto end = [&](std::size_t bit) { return c & bit ? 1.0 : -1.0; };
                x[c] = box.center.x() + end(1) * box.half.x();
                y[c] = box.center.y() + end(2) * box.half.y();
                z[c] = box.center.z() + end(4) * box.half.z();
            }
            NearestOfBlock out;
            nearest_of(shape, now, now, x, y, z, out);
            for (std::size_t i = 0; i < block_size; ++i) {
                const Vec3 p(x[i], y[i], z[i]), normal(out.nx[i], out.ny[i], out.nz[i]);
                worst = std::max(worst, std::abs(flat->gap(p) - out.gap[i]));
                // A corner of the box may lie on the limit between two faces.
                if (i >= 8) worst = std::max(worst, (flat->normal - normal).norm() * std::abs(out.gap[i]));
            }
        }
        CHECK_CLOSE(worst, 0.0, 1e-13, "rounding of places some metres away");
        std::printf("    shape %zu: %d of 3000 boxes have a flat part\n", shape.index(), found);
        if (std::holds_alternative<HalfSpace>(shape)) CHECK(found == 3000);
        if (std::holds_alternative<Prism>(shape)) CHECK(found > 40);
        if (std::holds_alternative<Post>(shape) || std::holds_alternative<TriangleMesh>(shape))
            CHECK(found == 0);
    }
}

TEST("a vehicle's front before a wall has a flat part, at its end it has none") {
    const Prism wall = Prism::box(0.4, 20.0, 1.0);
    const Box front{{0.0, 0.0, 0.5}, {0.3, 0.9, 0.3}};
    for (const double x : {-5.0, -0.2, 0.0}) {
        const Placement now{Mat3::Identity(), {x - 0.3, 3.0, 0.0}};
        const auto flat = flat_part(wall, now, front);
        CHECK(flat.has_value());
        CHECK_CLOSE((flat->normal + Vec3::UnitX()).norm(), 0.0, 1e-15, "the traffic face");
    }
    CHECK(!flat_part(wall, {Mat3::Identity(), {-0.3, 9.5, 0.0}}, front));
    CHECK(!flat_part(wall, {Mat3::Identity(), {-0.3, 3.0, 0.3}}, front));   // above the top
    CHECK(!flat_part(wall, {Mat3::Identity(), {-0.3, 3.0, -0.3}}, front));  // below the bottom
    CHECK(
        flat_part(Prism::box(0.4, 20.0, 1.0, 1.0), {Mat3::Identity(), {-0.3, 3.0, -0.3}}, front).has_value());
    CHECK(!flat_part(wall, {Mat3::Identity(), {0.0, 3.0, 0.0}}, front));  // past the middle
}

TEST("a shape behind a plane is nearer to no place than the plane is") {
    laboratory::Random random(39);
    for (const Shape& shape : shapes()) {
        const Box box = bounds(shape);
        for (int k = 0; k < 200; ++k) {
            const Placement now = random.placement(2.0);
            const Vec3 normal = random.point(Vec3::Constant(-1.0), Vec3::Constant(1.0)).normalized();
            const HalfSpace plane{normal, normal.dot(now.from_own(box.center)) + random.within(0.0, 3.0)};
            if (!is_behind(plane, shape, now)) continue;
            CHECK(box.half.allFinite());
            for (int i = 0; i < 50; ++i) {
                const Vec3 p = now.from_own(random.point(Vec3::Constant(-2.0), Vec3::Constant(2.0)));
                CHECK(nearest(shape, now.to_own(p)).gap >= plane.gap(p) - 1e-12);
            }
        }
    }
    const HalfSpace face{-Vec3::UnitX(), 0.0};  // looks to -x
    const auto post_at = [&](double x) {
        return is_behind(face, Post(0.2), {Mat3::Identity(), {-x, 0.0, 0.0}});
    };
    CHECK(post_at(0.2));
    CHECK(post_at(0.3));
    CHECK(!post_at(0.199));
}

TEST("block_size of one block have the same bits in any order") {
    laboratory::Random random(37);
    for (const Shape& shape : shapes()) {
        if (std::holds_alternative<TriangleMesh>(shape)) continue;  // ties go by the order
        const Placement now = random.placement(2.0);
        const Block block(random, now, 0.4);
        BlockColumn x, y, z;
        for (std::size_t i = 0; i < block_size; ++i) {
            const std::size_t from = (i * 23 + 5) % block_size;
            x[i] = block.x[from], y[i] = block.y[from], z[i] = block.z[from];
        }
        NearestOfBlock straight, mixed;
        nearest_of(shape, now, now, block.x, block.y, block.z, straight);
        nearest_of(shape, now, now, x, y, z, mixed);
        for (std::size_t i = 0; i < block_size; ++i) {
            const std::size_t from = (i * 23 + 5) % block_size;
            CHECK(mixed.gap[i] == straight.gap[from] && mixed.nx[i] == straight.nx[from] &&
                  mixed.ny[i] == straight.ny[from] && mixed.nz[i] == straight.nz[from]);
        }
    }
}
