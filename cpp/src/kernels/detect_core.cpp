#include "kernels/detect_core.hpp"

#include <algorithm>
#include <array>

#include "birm3d/base/tolerances.hpp"
#include "kernels/detect.hpp"

namespace birm3d {

namespace {

// How far a point with the speed `approach` can get within the step, with the centripetal part of rotation. It is
// never less than the gap of points that share an impact.
double reach_within_step(const TrussMesh& mesh, const Twist& motion, double approach, double dt) {
    const double centripetal = 0.5 * motion.angular_velocity.squaredNorm() * mesh.reach * dt * dt;
    return std::max(tolerance::joint_impact_gap, tolerance::touching_gap + centripetal + dt * approach);
}

}  // namespace

double core_margin(const TrussMesh& mesh, const Twist& motion, double dt) {
    return reach_within_step(mesh, motion,
                             motion.velocity.norm() + motion.angular_velocity.norm() * mesh.reach, dt);
}

namespace {

// A truss is closed if what is left of its depth is at most this share of it, plus what one step can crush. Depths count along
// the panel's axis: posts and walls push nodes along it, or along their trusses.
constexpr double open_share = 0.1;

// An anchor that gives way and lies deeper than this in an obstacle was passed while its truss was open (m).
constexpr double passed_depth = 1e-3;

bool is_closed(const TrussMesh& mesh, const TrussState& trusses, std::size_t b, std::size_t i, double reach) {
    const TrussBlock& truss = mesh.block[b];
    const TrussBlockState& now = trusses.block[b];
    const Vec3& inward = mesh.panel[static_cast<std::size_t>(truss.panel[i])].inward;
    const Vec3 anchor = anchor_of(truss, i), node(now.x[i], now.y[i], now.z[i]),
               uncrushed(truss.node_x[i], truss.node_y[i], truss.node_z[i]);
    return inward.dot(anchor - node) <= open_share * inward.dot(anchor - uncrushed) + reach;
}

}  // namespace

void find_core_contacts(const Unit& unit, std::size_t body, const UnitState& state,
                        std::span<const PlacedShape> shapes, const Twist& motion, double dt,
                        std::vector<RigidContact>& contacts) {
    const TrussMesh& mesh = unit.trusses;
    const auto relative = [&motion](const PlacedShape& shape) {
        return Twist{motion.velocity - shape.motion.velocity,
                     motion.angular_velocity - shape.motion.angular_velocity};
    };
    double margin = 0.0;
    for (const PlacedShape& shape : shapes)
        margin = std::max(margin, core_margin(mesh, relative(shape), dt));
    std::vector<const PlacedShape*> near;
    alignas(64) NearestOfBlock nearest, found;
    std::array<const PlacedShape*, block_size> at;
    for (std::size_t b = 0; b < mesh.skin_blocks; ++b) {
        near.clear();
        for (const PlacedShape& shape : shapes)
            if (within_reach(*shape.shape, shape.placement, mesh.anchor_box[b], margin))
                near.push_back(&shape);
        if (near.empty()) continue;
        // Only the nearest surface counts: edges behind a neighbour's face are no obstacle.
        const TrussBlock& block = mesh.block[b];
        nearest.gap.fill(margin);
        at.fill(nullptr);
        for (const PlacedShape* shape : near) {
            nearest_of(*shape->shape, shape->placement, shape->placement, block.anchor_x, block.anchor_y,
                       block.anchor_z, found);
            for (std::size_t i = 0; i < block_size; ++i) {
                if (!(found.gap[i] < nearest.gap[i])) continue;
                at[i] = shape;
                nearest.gap[i] = found.gap[i];
                nearest.nx[i] = found.nx[i], nearest.ny[i] = found.ny[i], nearest.nz[i] = found.nz[i];
            }
        }
        for (std::size_t i = 0; i < mesh.nodes_in(b); ++i) {
            if (at[i] == nullptr) continue;
            const std::size_t truss = mesh.first[b] + i;
            const Vec3 anchor = anchor_of(block, i), normal(nearest.nx[i], nearest.ny[i], nearest.nz[i]);
            double gap = nearest.gap[i];
            const Twist there = relative(*at[i]);
            const double approach = -normal.dot(there.velocity + there.angular_velocity.cross(anchor));
            const double reach = reach_within_step(mesh, there, std::max(0.0, approach), dt);
            if (gap >= reach) continue;
            const bool passed = gap < -passed_depth,
                       indents = at[i]->pushes && std::holds_alternative<Post>(*at[i]->shape);
            if ((passed || indents) && unit.gives_way(anchor)) {
                if (!is_closed(mesh, state.trusses, b, i, reach)) continue;
                if (passed) gap = 0.0;  // the anchor rests where it is now
            }
            RigidContact contact;
            contact.source = ContactSource::core;
            contact.index = truss;
            contact.obstacle = at[i]->obstacle;
            contact.body = body;
            contact.arm = state.body.orientation * anchor;
            contact.normal = state.body.orientation * normal;
            contact.gap = gap;
            contact.compliance = tolerance::body_compliance;
            contact.friction = at[i]->friction;
            contacts.push_back(contact);
        }
    }
}

}  // namespace birm3d
