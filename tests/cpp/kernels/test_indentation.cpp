#include "kernels/indentation.hpp"

#include <algorithm>
#include <numbers>
#include <optional>
#include <random>

#include "check.hpp"
#include "laboratory.hpp"
#include "state/block_contact.hpp"

using namespace birm3d;
using std::numbers::pi;

namespace {

// 8 by 8 nodes at x = 3 m, 2.4 m by 1.6 m, trusses straight back.
const TrussMesh mesh(laboratory::front_face(laboratory::w2_curve(), 8, 8));
const TrussState uncrushed(mesh);
const Panel& front = mesh.panel[1];

// Axis through `foot`, leaning by `lean` towards the vehicle and by `sway` to its side (rad).
Placement standing(const Vec3& foot, double lean = 0.0, double sway = 0.0) {
    const Quat turn = Eigen::AngleAxisd(sway, Vec3::UnitX()) * Eigen::AngleAxisd(lean, Vec3::UnitY());
    const Mat3 to_own = turn.toRotationMatrix().transpose();
    return {to_own, -(to_own * foot)};
}

constexpr double edge = 1.25;  // edge_flank_factor

// How nodes follow an indentation.
struct Followed : NodeFaces, BlockContact {
    BlockColumn follows;
};

// Of nodes that push with `force`; `last`: the indentation an instant before.
Followed follow(const Indentation& now, const Indentation& last, double force) {
    TrussBlockState nodes = uncrushed.block[0];
    nodes.force.fill(force);
    Followed found;
    found.gap.fill(std::numeric_limits<double>::infinity());  // nothing seen so far
    found.per_force.fill(0.0);
    found.set_normal(Vec3::UnitX());
    BlockColumn rank, contact_gap, least_facing, lags;
    lags.fill(0.0);
    least_facing.fill(0.5);
    contact_gap.fill(std::numeric_limits<double>::infinity());
    rank.fill(std::numeric_limits<double>::infinity());
    follow_indentation(now, last, nodes, mesh.block[0], 1, contact_gap, least_facing, lags, found, found,
                       rank, found.follows);
    return found;
}

Followed indentation_by(const Post& post, const Placement& stands, const Placement& last, double reach,
                        double force) {
    return follow(Indentation(post, stands, front, reach, edge), Indentation(post, last, front, reach, edge),
                  force);
}

// Of nodes without force that the post has just come to, from far in front.
Followed indentation_by(const Post& post, const Placement& stands, double reach) {
    const Placement far{stands.rotation, stands.position - stands.rotation * (100.0 * Vec3::UnitX())};
    return indentation_by(post, stands, far, reach, 0.0);
}

// Of a post that stands upright, its surface at x.
double slope_by(double x, double reach) {
    return std::hypot(0.25, (3.0 - x) / reach);
}

Vec3 node(std::size_t i) {
    return {uncrushed.block[0].x[i], uncrushed.block[0].y[i], uncrushed.block[0].z[i]};
}

// Compares forces and torques with the displacements of the nodes for small motions along and about each axis. `follow_at`: how
// loaded nodes follow from `stands` to a placement. `note`: of each node that was compared.
template <class FollowAt, class Note>
void check_by_virtual_work(const Placement& stands, const FollowAt& follow_at, const Note& note) {
    const double h = 1e-6;
    const Followed here = follow_at(stands);
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 way = Vec3::Unit(axis);
        const Placement moved{stands.rotation, stands.position - stands.rotation * (h * way)};
        const Mat3 turn = Eigen::AngleAxisd(h, way).toRotationMatrix();
        const Placement turned{stands.rotation * turn.transpose(), stands.position};
        const Followed forth = follow_at(moved);
        const Followed right = follow_at(turned);
        for (std::size_t i = 0; i < block_size; ++i) {
            if (here.follows[i] != 1.0 || forth.follows[i] != 1.0 || right.follows[i] != 1.0) continue;
            note(i);
            const double force = here.per_force[i] * Vec3(here.nx[i], here.ny[i], here.nz[i])[axis];
            const double torque = here.per_force[i] * Vec3(here.tx[i], here.ty[i], here.tz[i])[axis];
            CHECK_CLOSE(force, -forth.gap[i] / h, 1e-4, "the difference's error");
            CHECK_CLOSE(torque, -right.gap[i] / h, 1e-4, "the same");
        }
    }
}

}  // namespace

TEST("trusses that point back belong to the front") {
    CHECK(front.any);
    CHECK_CLOSE(laboratory::distance(front.inward, -Vec3::UnitX()), 0.0, 0.0, "an axis");
    CHECK_CLOSE(laboratory::distance(front.box.half, {0.0, 1.2, 0.8}), 0.0, 1e-15, "rounding");
    for (std::size_t p = 0; p < panels; ++p)
        CHECK(mesh.panel[p].any == (p == 1));
}

TEST("beside an upright post the skin is drawn in with the slope") {
    const double radius = 0.2, axis = 2.7;
    int hanging = 0;
    for (const double reach : {0.25, 0.5, 1.0}) {
        const double slope = slope_by(axis - radius, reach);
        const Followed found = indentation_by(Post(radius), standing({axis, 0.1, 0.0}), reach);
        const double arc = radius * slope / std::sqrt(1.0 + slope * slope);
        for (std::size_t i = 0; i < block_size; ++i) {
            if (!(found.follows[i] > 0.0)) continue;  // out of reach
            ++hanging;
            const double w = std::abs(node(i).y() - 0.1), on = std::min(w, arc);
            const double surface = axis - std::sqrt(radius * radius - on * on) + slope * (w - on);
            CHECK_CLOSE(found.gap[i], surface - node(i).x(), 1e-14, "rounding of lengths near 3 m");
        }
    }
    CHECK(hanging > 48);
}

TEST("above a post the skin is drawn in with the slope, too, as steeply as reaches 0.2 m up") {
    const double radius = 0.2, height = 0.3, reach = 0.8, slope = slope_by(2.5, reach);
    const Followed low = indentation_by(Post(radius, height), standing({2.7, 0.0, 0.0}), reach);
    const Followed tall = indentation_by(Post(radius), standing({2.7, 0.0, 0.0}), reach);
    int drawn_in = 0;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(low.follows[i] > 0.0 && tall.follows[i] > 0.0)) continue;
        const double above = std::max(0.0, node(i).z() - height);
        drawn_in += above > 0.0 ? 1 : 0;
        const double hair = above > 0.0 ? reach / 0.2 * slope * 0.05 * radius : 0.0;
        CHECK_CLOSE(low.gap[i], tall.gap[i] + reach / 0.2 * slope * above - hair, 1e-14,
                    "the hair by which the rim is rounded");
    }
    CHECK(drawn_in > 0);
}

TEST("of a post that stands beside the panel only what reaches over its edge presses") {
    // The axis 0.15 m beyond the edge at y = 1.2 m.
    const double radius = 0.2;
    const double reach = 0.5, slope = slope_by(2.7, reach);
    const Followed found = indentation_by(Post(radius), standing({2.9, 1.35, 0.0}), reach);
    const double at_edge = 2.9 - std::sqrt(radius * radius - 0.15 * 0.15);
    for (std::size_t i = 0; i < block_size; ++i)
        if (found.follows[i] > 0.0)
            CHECK_CLOSE(found.gap[i], at_edge + slope * (1.2 - node(i).y()) - node(i).x(), 1e-14, "rounding");
}

TEST("nodes that push go as the post does, wherever they stand, and let it go on along the panel") {
    const Post post(0.2);
    const double way = 1e-3;
    const Placement last = standing({2.8, 0.1, 0.0});
    const Followed in = indentation_by(post, standing({2.8 - way, 0.1, 0.0}), last, 1.0, 1.0);
    const Followed along = indentation_by(post, standing({2.8, 0.1 + way, 0.0}), last, 1.0, 1.0);
    double left = 0.0, right = 0.0;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (in.follows[i] != 1.0 || along.follows[i] != 1.0) continue;
        // Those before the post go with it, those beside it less: its slope grows.
        CHECK(in.gap[i] < -0.1 * way && in.gap[i] > -1.000001 * way);
        CHECK_CLOSE(in.gap[i], -way * -in.per_force[i] * in.nx[i], 1e-3 * way, "of second order");
        // Sideways the node gives a share of the sine of the flank's slope, not all of it.
        CHECK(std::abs(along.gap[i]) < 0.2 * way);
        (node(i).y() < 0.1 ? left : right) = along.gap[i];
    }
    CHECK(left * right < 0.0);
}

TEST("force and torque are what the ways of the nodes ask for by virtual work") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    int above = 0, beside = 0, held = 0;
    for (int round = 0; round < 200; ++round) {
        const Post post(0.2 + 0.1 * share(random), 1.5 + 0.9 * share(random));
        const Vec3 foot(2.5 + 0.2 * share(random), 1.3 * share(random), -1.0);
        const double lean = 0.3 * share(random), sway = 0.3 * share(random);
        const Placement stands = standing(foot, lean, sway);
        // As far as an indentation of 2 m goes: to all nodes.
        check_by_virtual_work(
            stands, [&](const Placement& at) { return indentation_by(post, at, stands, 2.0, 1.0); },
            [&](std::size_t) { ++held; });
        const Indentation indentation(post, stands, front, 2.0, edge);
        for (std::size_t i = 0; i < block_size; ++i) {
            above += (node(i) - foot).dot(indentation.along()) > indentation.top ? 1 : 0;
            beside += std::abs((node(i) - foot).dot(indentation.across())) > indentation.radius ? 1 : 0;
        }
    }
    CHECK(above > 1000);
    CHECK(beside > 1000);
    CHECK(held > 10000);
}

TEST(
    "along a post that leans the push is a wedge's, then 0.35 of that into the panel, then that against "
    "friction") {
    const Post post(0.2, 9.0);
    for (const double lean : {-1.1, -0.87, -0.85, -0.3, -0.02, 0.02, 0.3, 0.85, 0.87, 1.1}) {
        const Placement stands = standing({2.0, 0.0, -1.0}, lean);
        const Followed found = indentation_by(post, stands, stands, 2.0, 1.0);
        const double slope = -std::tan(lean), folded = slope / std::hypot(1.0, slope / 0.35),
                     slides = std::copysign(std::tan(std::abs(lean) - std::atan(0.6)), slope),
                     expected = std::abs(lean) > 0.864 ? slides : folded;
        int held = 0;
        for (std::size_t i = 0; i < block_size; ++i) {
            if (found.follows[i] != 1.0) continue;
            ++held;
            CHECK_CLOSE(found.nz[i] / found.nx[i], expected, 1e-12, "rounding");
        }
        CHECK(held > 0);
    }
}

// The edge of a block whose traffic face is turned by `yaw` from the panel (rad).
Placement edge_at(const Vec3& foot, double yaw, double lean = 0.0, double sway = 0.0) {
    const Quat turn = Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(lean, Vec3::UnitY()) *
                      Eigen::AngleAxisd(sway, Vec3::UnitX());
    const Mat3 to_own = turn.toRotationMatrix().transpose();
    return {to_own, -(to_own * foot)};
}

TEST("skin that would fall off more steeply than the faces of an edge lies on them") {
    // The edge points at the panel's middle, both faces at 45 degrees. Its axis is 1 m deep: the slope is 4 without faces.
    const double radius = 0.05, reach = 0.25, foot = 2.0 + radius;
    const Post post(radius, std::numeric_limits<double>::infinity(), 0.75 * pi);
    const Placement stands = edge_at({foot, 0.0, 0.0}, 0.25 * pi),
                    far = edge_at({foot + 100.0, 0.0, 0.0}, 0.25 * pi);
    const Followed found = indentation_by(post, stands, far, reach, 0.0);
    int on_faces = 0;
    for (std::size_t i = 0; i < block_size; ++i) {
        const double depth = 3.0 - (foot - std::sqrt(2.0) * radius) - std::abs(node(i).y());
        if (!(depth > 0.0)) continue;
        ++on_faces;
        CHECK(found.follows[i] == 1.0);
        CHECK_CLOSE(found.gap[i], -depth, 1e-12, "the plane of the face; rounding");
    }
    CHECK(on_faces > 32);
}

TEST("an edge pushes a panel aside where it stands beside the rails") {
    const double radius = 0.05;
    const Post post(radius, std::numeric_limits<double>::infinity(), 0.75 * pi);
    // The block is at y up to this share of the half width from the middle, to the right. It is open to the left: to lower w.
    for (const auto& [share, factor] :
         {std::pair(0.7, edge), {0.5, edge}, {0.45, 0.8}, {0.4, 0.35}, {-0.6, 0.35}}) {
        const Indentation found(post, standing({2.8, -1.2 * share - radius, 0.0}), front, 0.65, edge);
        CHECK_CLOSE(found.flank_low, factor, 1e-12, "rounding");
        CHECK_CLOSE(found.flank_high, 0.0, 1e-12, "the face holds the skin there");
    }
}

TEST("force and torque of an edge are what the ways of the nodes ask for by virtual work") {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    int on_face = 0, held = 0;
    for (int round = 0; round < 300; ++round) {
        const Post post(0.1 + 0.05 * share(random), 1.5 + 0.9 * share(random), 0.75 * pi);
        const Placement stands =
            edge_at({2.2 + 0.3 * share(random), 0.6 * share(random), -1.0}, pi * (0.25 + 0.2 * share(random)),
                    0.1 * share(random), 0.1 * share(random));
        const double reach = 0.3;
        const Indentation indentation(post, stands, front, reach, edge);
        const double falls = std::min(indentation.side_low.slope, indentation.side_high.slope);
        check_by_virtual_work(
            stands, [&](const Placement& at) { return indentation_by(post, at, stands, reach, 1.0); },
            [&](std::size_t i) {
                ++held;
                const double w = std::abs((node(i) - indentation.foot()).dot(indentation.across()));
                on_face += w > 0.2 && slope_by(2.5, reach) > falls ? 1 : 0;
            });
    }
    CHECK(on_face > 1000);
    CHECK(held > 10000);
}

TEST("force and torque of a top edge are what the ways of the nodes ask for by virtual work") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    int above = 0, sunk = 0;
    for (int round = 0; round < 200; ++round) {
        const TopEdge top{0.0, -3.0, 3.0, 1.0 + 0.8 * share(random)};
        const Quat turned_to = Eigen::AngleAxisd(0.6 * share(random), Vec3::UnitZ()) *
                               Eigen::AngleAxisd(0.2 * share(random), Vec3::UnitY()) *
                               Eigen::AngleAxisd(0.2 * share(random), Vec3::UnitX());
        const Mat3 to_own = turned_to.toRotationMatrix().transpose();
        const Placement stands{to_own, -(to_own * Vec3(2.5 + 0.2 * share(random), share(random), -1.0))};
        const Indentation now(top, stands, front, 2.0);
        check_by_virtual_work(
            stands, [&](const Placement& at) { return follow(Indentation(top, at, front, 2.0), now, 1.0); },
            [&](std::size_t i) {
                const bool is_above = stands.to_own(node(i)).z() > top.height;
                ++(is_above ? above : sunk);
            });
    }
    CHECK(above > 1000);
    CHECK(sunk > 1000);
}

TEST("above a wall the skin is drawn in with the slope, below its top the face holds it") {
    const double at = 2.5, reach = 0.5;
    const TopEdge top{0.0, -0.7, 0.6, 1.0};
    const Placement stands = standing({at, 0.0, -1.0}), far = standing({at + 100.0, 0.0, -1.0});
    const Followed found =
        follow(Indentation(top, stands, front, reach), Indentation(top, far, front, reach), 0.0);
    int drawn_in = 0;
    for (std::size_t i = 0; i < block_size; ++i) {
        const double above = node(i).z() + 1.0 - top.height, y = node(i).y();
        const double depth = 3.0 - at - reach / 0.2 * slope_by(at, reach) * above;
        const bool follows = above > 0.0 && y > top.low && y < top.high && depth > 0.0;
        CHECK(found.follows[i] == (follows ? 1.0 : 0.0));
        if (!follows) continue;
        ++drawn_in;
        CHECK_CLOSE(found.gap[i], -depth, 1e-12, "rounding");
    }
    CHECK(drawn_in > 3);
}

TEST("no node is further inside than what the box says, however deep the post") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    int reached = 0;
    for (int round = 0; round < 800; ++round) {
        const std::optional<double> opens = round % 3 == 0 ? std::optional(0.75 * pi) : std::nullopt;
        const Post post(0.2 + 0.1 * share(random), 1.5 + 0.9 * share(random), opens);
        const double deepest = round % 2 == 0 ? 1.0 : 4.0, reach = 0.6 + 0.3 * share(random);
        const Vec3 foot(2.8 + deepest * share(random), 2.0 * share(random), -1.0);
        const Placement stands = edge_at(foot, opens ? 0.25 * pi + 0.6 * share(random) : 0.0,
                                         0.4 * share(random), 0.4 * share(random));
        const Indentation indentation(post, stands, front, reach, edge);
        const Followed found = indentation_by(post, stands, reach);
        const double least = *std::min_element(found.gap.begin(), found.gap.end());
        CHECK(-least <= most_inside(indentation, front.box) + 1e-12);
        for (std::size_t i = 0; i < block_size; ++i) {
            CHECK(-found.gap[i] <= most_inside(indentation, {node(i), Vec3::Zero()}) + 1e-12);
            reached += found.gap[i] < 0.0 ? 1 : 0;
        }
    }
    CHECK(reached > 4000);
}
