// The loads of a block's nodes on each obstacle, with friction, and their sums for the step.
#include <algorithm>

#include "birm3d/kernels/friction.hpp"
#include "birm3d/scene/obstacles.hpp"
#include "contact/contact_pass.hpp"

namespace birm3d {

namespace {

Wrench turned(const Wrench& w, const Mat3& R) {
    return {R * w.force, R * w.torque};
}

Mat6 turned(const Mat6& of, const Mat3& R) {
    Mat6 turned;
    for (const int i : {0, 3})
        for (const int j : {0, 3})
            turned.block<3, 3>(i, j) = R * of.block<3, 3>(i, j) * R.transpose();
    return turned;
}

// Keeps the pressure of nodes whose nearest is the k-th, and sums their loads.
struct Part {
    double force, x, y, z, tx, ty, tz;
};
BIRM3D_LANE_LOOP Part take_part(const std::array<std::size_t, lanes>& nearest, std::size_t k,
                                const BlockContact& contact, Lanes& pressure) {
    alignas(64) Lanes force, x, y, z, tx, ty, tz;
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const double own = nearest[i] == k ? contact.pressure[i] : 0.0;
        pressure[i] = force[i] = own;
        x[i] = own * contact.nx[i];
        y[i] = own * contact.ny[i];
        z[i] = own * contact.nz[i];
        tx[i] = own * contact.tx[i];
        ty[i] = own * contact.ty[i];
        tz[i] = own * contact.tz[i];
    }
    return {lane_sum(force), lane_sum(x), lane_sum(y), lane_sum(z), lane_sum(tx), lane_sum(ty), lane_sum(tz)};
}

// Skin that a post dents goes in with it: it slides on it only along the panel.
BIRM3D_LANE_LOOP void rub_along_panel(const NodeFaces& faces, BlockContact& contact) {
    BIRM3D_INDEPENDENT
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool dented = faces.per_force[i] > 0.0;
        contact.nx[i] = dented ? faces.bx[i] : contact.nx[i];
        contact.ny[i] = dented ? faces.by[i] : contact.ny[i];
        contact.nz[i] = dented ? faces.bz[i] : contact.nz[i];
    }
}

}  // namespace

// Nodes of one block that push on several obstacles: to each its own.
void Skin::share_out(std::size_t b, const TrussBlockState& next) {
    if (!corners_.empty()) share_out_corners(b, next);
    BlockContact part = contact_;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
        const Part of = take_part(nearest_, k, contact_, part.pressure);
        if (!(of.force > 0.0)) continue;
        ObstacleSums& sums = obstacles_[seen_[k]];
        sums.contact += {Vec3(of.x, of.y, of.z), Vec3(of.tx, of.ty, of.tz)};
        sums.normal_force += of.force;
        rub(seen_[k], b, next, contact_.places(), part);
    }
}

void Skin::rub(std::size_t near, std::size_t b, const TrussBlockState& next, const Places& places,
               const BlockContact& contact) {
    ObstacleSums& sums = obstacles_[near];
    if (along_) sums.by_trusses += along_trusses(mesh_.block[b], next, contact);
    if (b >= mesh_.shell_blocks) {
        if (scene_.settings.mu_tire_barrier > 0.0) note_treads(near, b, places, contact);
        return;
    }
    const double mu = scene_.obstacles[near_[near].index].friction;
    const Vec3* const normal = plane_normal_ ? &*plane_normal_ : nullptr;
    if (!(mu > 0.0)) return;
    if (block_dents_.empty())
        return add_friction(mu, full_speed_, away_[near], places, contact, normal, sums.rubbing);
    BlockContact within = contact;
    rub_along_panel(faces_, within);
    add_friction(mu, full_speed_, away_[near], places, within, nullptr, sums.rubbing);
}

void Skin::hand_over() {
    SkinForces& skin = now_.skin;
    skin = {};
    skin.rubbed = {R_ * motion_.velocity, R_ * motion_.angular_velocity};
    std::vector<ContactLoad>& loads = trial_.skin.contact_loads;
    loads.clear();
    const auto add = [&skin](const CrushSums& sums) {
        skin.work += sums.work();
        skin.stored += sums.stored();
        skin.stiffness += sums.stiffness();
    };
    add(shared_);
    for (std::size_t k = 0; k < near_.size(); ++k) {
        const ObstacleSums& sums = obstacles_[k];
        if (!sums.seen) continue;
        trial_.seen.push_back(near_[k].index);
        ContactLoad touch;
        touch.obstacle = near_[k].index;
        touch.contact = sums.contact;
        touch.contact += total_wrench(sums.sums);
        touch.normal_force = sums.normal_force + sums.sums.normal_force();
        add(sums.sums);
        for (const PlaneSums& plane : planes_) {
            if (plane.near != k) continue;
            touch.contact += total_wrench(plane.surface, plane.sums);
            touch.normal_force += plane.sums.normal_force();
            add(plane.sums);
        }
        if (along_) touch.contact = sums.by_trusses;
        touch.contact = turned(touch.contact, R_);
        touch.friction = turned(sums.rubbing.friction, R_);
        if (sums.rubbing.resistance.trace() > 0.0) skin.resistance += sums.rubbing.resistance;
        skin.contact += touch.contact;
        skin.friction += touch.friction;
        skin.normal_force += touch.normal_force;
        if (touch.normal_force > 0.0) loads.push_back(touch);
    }
    if (skin.resistance.trace() > 0.0) skin.resistance = turned(skin.resistance, R_);
    // A contact that has ended keeps an empty load until its history is over: the divided differences of its structure
    // still contain it for two steps.
    for (const ContactLoad& last : before_.contact_loads) {
        const Load &rate = last.history.rate, &second = last.history.second_difference;
        if (!(last.normal_force > 0.0) && rate.normal_force == 0.0 && second.normal_force == 0.0) continue;
        const auto place = std::lower_bound(
            loads.begin(), loads.end(), last.obstacle,
            [](const ContactLoad& touch, std::size_t obstacle) { return touch.obstacle < obstacle; });
        if (place != loads.end() && place->obstacle == last.obstacle) continue;
        ContactLoad ended;
        ended.obstacle = last.obstacle;
        loads.insert(place, ended);
    }
    now_.contact_loads = loads;
}

}  // namespace birm3d
