#include "contact/tire_contact.hpp"

#include <algorithm>

#include "kernels/friction_tire.hpp"

namespace birm3d {

void note_tire_nodes(const ContactPass& pass, std::size_t k, std::size_t b, const Places& places,
                     const BlockContact& contact, ContactSums& sums) {
    if (!(pass.scene.settings.mu_tire_barrier > 0.0)) return;
    const std::size_t first = pass.mesh.first[b] - pass.mesh.shell;
    for (std::size_t i = 0; i < block_size; ++i) {
        if (!(contact.normal_force[i] > 0.0)) continue;
        sums.tire_nodes.push_back(tire_node_contact(pass.mesh.tire_nodes[first + i], k,
                                                    pass.relative_motion[k], places[i], contact.normal(i),
                                                    contact.normal_force[i]));
    }
}

void add_tire_friction(const ContactPass& pass, ContactSums& sums) {
    const double mu = pass.scene.settings.mu_tire_barrier;
    const double full_speed = pass.full_friction_speed;
    // The nodes come wheel by wheel, as their blocks do.
    for (auto first = sums.tire_nodes.begin(); first != sums.tire_nodes.end();) {
        const auto end = std::find_if(first, sums.tire_nodes.end(), [&](const TireNodeContact& node) {
            return node.wheel != first->wheel;
        });
        const double rolling =
            pass.scene.settings.braking < 1.0 ? free_rolling_speed(full_speed, {first, end}) : 0.0;
        for (; first != end; ++first)
            add_tire_node_friction(mu, full_speed, rolling, *first,
                                   sums.obstacles[first->near].friction_load);
    }
}

}  // namespace birm3d
