// Friction of tyres at the barrier: see kernels/friction_tread.hpp.
#include <algorithm>

#include "birm3d/kernels/friction_tread.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

// How fast a wheel turns follows from the friction of all its nodes. So friction is added when all of them are known.
void Skin::note_treads(std::size_t near, std::size_t b, const Places& places, const BlockContact& contact) {
    const std::size_t first = mesh_.first[b] - mesh_.shell;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(contact.pressure[i] > 0.0)) continue;
        treads_.push_back(tread_contact(mesh_.tread[first + i], near, away_[near],
                                        {places.x[i], places.y[i], places.z[i]}, contact.normal(i),
                                        contact.pressure[i]));
    }
}

void Skin::rub_treads() {
    const double mu = scene_.settings.mu_tire_barrier;
    // They come wheel by wheel, as their blocks do.
    for (auto first = treads_.begin(); first != treads_.end();) {
        const auto end = std::find_if(first, treads_.end(),
                                      [&](const TreadContact& node) { return node.wheel != first->wheel; });
        const double turning = scene_.settings.braking < 1.0 ? free_turning(full_speed_, {first, end}) : 0.0;
        for (; first != end; ++first)
            add_tread_friction(mu, full_speed_, turning, *first, obstacles_[first->near].rubbing);
    }
}

}  // namespace birm3d
