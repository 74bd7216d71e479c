#include "contact/lagging_nodes.hpp"

namespace birm3d {

double gap_as_step_began(const NearObstacle& near, const Vec3& node, const Vec3& normal, double gap) {
    const Vec3 motion = near.before.to_own(node) - near.now.to_own(node);
    return gap + near.now.direction_to_own(normal).dot(motion);
}

bool lags_behind(double gap_as_step_began) {
    constexpr double least = 1e-4;  // m
    return gap_as_step_began < -least;
}

double without_lag(const NearObstacle& near, const Vec3& node, const Vec3& normal, double gap) {
    const double before = gap_as_step_began(near, node, normal, gap);
    return lags_behind(before) && gap < 0.0 ? gap - before : gap;
}

void keep_lags(const ContactPass& pass, ContactBlock& block) {
    block.lags.reset();
    const bool was_left = (pass.mesh.panels_of[block.index] & pass.left_panels) != 0;
    if (!block.start->may_lag() && !was_left) return;
    const TrussBlockState& nodes = *block.start;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (block.faces.per_force[i] > 0.0) continue;  // an indentation moves it
        if (!was_left && !block.start->may_lag(i)) continue;
        double& gap = block.faces.gap[i];
        const double moves = without_lag(pass.near[block.reachable[block.nearest[i]]],
                                         {nodes.x[i], nodes.y[i], nodes.z[i]}, block.contact.normal(i), gap);
        if (moves != gap) block.lags.set(i);
        gap = moves;
    }
    if (block.start->hangs || was_left)
        block.hangs = block.hangs || block.lags.any();
    else
        block.lagging |= block.lags;
}

}  // namespace birm3d
