// Dents beside narrow obstacles: see kernels/dent.hpp.
#include <algorithm>
#include <cstdint>

#include "birm3d/base/tolerances.hpp"
#include "birm3d/kernels/friction.hpp"
#include "sim/skin.hpp"

namespace birm3d {

// A node on which others hang stays at the surface while they press, though its own truss does not any more.
const TrussBlockState& Skin::follow_with_leading(std::size_t b) {
    const TrussBlock& truss = mesh_.block[b];
    followed_ = from(b);
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!leads(b, i) || followed_.force[i] > 0.0 || !(faces_.gap[i] > 0.0)) continue;
        const Vec3 b_in = inward(truss, followed_, i);
        const double cosine = b_in.dot(contact_.normal(i));
        if (!(cosine > 0.0)) continue;
        const Vec3 h = way_held(faces_.held[i], cosine, contact_.normal(i), b_in);
        followed_.x[i] -= faces_.gap[i] * h.x();
        followed_.y[i] -= faces_.gap[i] * h.y();
        followed_.z[i] -= faces_.gap[i] * h.z();
        faces_.gap[i] = 0.0;
    }
    return followed_;
}

// The nodes that narrow obstacles press, from a draft of this instant, and how far others can hang on them.
void Skin::find_dents() {
    const auto holds = [&](std::size_t k) { return scene_.obstacles[near_[k].index].holds_skin; };
    if (mesh_.dent_slope == 0.0) return;
    bool any = false;
    for (std::size_t k = 0; k < near_.size(); ++k)
        any = any || holds(k);
    if (!any) return;
    for (std::size_t b = 0; b < mesh_.blocks; ++b)
        if (look_about(b) && std::any_of(seen_.begin(), seen_.end(), holds)) draft(b);
    if (drivers_.empty()) return;
    double deepest = 0.0;
    for (const DentDriver& driver : dent_)
        deepest = std::max(deepest, driver.deflection);
    dent_box_ = Box::around(dent_.size(), [&](std::size_t i) { return dent_[i].place; });
    dent_groups_ = grouped(dent_);
    dent_box_.half += Vec3::Constant(deepest / mesh_.dent_slope);
}

void Skin::draft(std::size_t b) {
    TrussBlockState& next = now_.trusses.block[b];
    const TrussBlockState& block = look(b);
    hanging_.deflection.fill(-1.0);
    set_hanging(b);
    drafted_.push_back(b);
    CrushSums ignored;
    crush_shapes(b, block, next, ignored);
    const TrussBlock& truss = mesh_.block[b];
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool leads_on =
            leads(b, i) && (faces_.gap[i] == 0.0 || (block.force[i] > 0.0 && nearest_[i] != by_dent));
        if (!((contact_.pressure[i] > 0.0 || leads_on) && faces_.held[i] > 0.0)) continue;
        const double cosine = inward(truss, next, i).dot(contact_.normal(i));
        const double per_force = share_held(faces_.held[i], std::max(cosine, 0.0));
        const Vec3 place(truss.node_x[i], truss.node_y[i], truss.node_z[i]);
        const Vec3 anchor(truss.anchor_x[i], truss.anchor_y[i], truss.anchor_z[i]);
        drivers_.push_back({seen_[nearest_[i]], b, i, contact_.normal(i), per_force});
        dent_.push_back({place, (place - anchor) / truss.length[i], next.deflection[i]});
    }
}

// Does any node of the block hang on a driver, or has it done so?
bool Skin::draw_in(std::size_t b) {
    hanging_.deflection.fill(-1.0);
    if (from(b).drawn == 0) {
        if (drivers_.empty()) return false;
        const Vec3 apart = (mesh_.node_box[b].center - dent_box_.center).cwiseAbs();
        if (((mesh_.node_box[b].half + dent_box_.half - apart).array() < 0.0).any()) return false;
    }
    hang(mesh_.block[b], mesh_.node_box[b], mesh_.dent_slope, dent_, dent_groups_, hanging_);
    return from(b).drawn != 0 || std::any_of(hanging_.deflection.begin(), hanging_.deflection.end(),
                                             [](double d) { return d > 0.0; });
}

// Nodes that hang deeper than a surface would press them go by their driver; those that have lost theirs are let go.
// Returns whether there are any of either kind.
bool Skin::set_hanging(std::size_t b) {
    const TrussBlock& truss = mesh_.block[b];
    const TrussBlockState& block = from(b);
    const bool drafted = std::binary_search(drafted_.begin(), drafted_.end(), b);
    bool any = false;
    for (std::size_t i = 0; i < lanes; ++i) {
        const double drawn_to = hanging_.deflection[i];
        const bool was_drawn = (block.drawn >> i & 1U) != 0;
        const bool at_surface = faces_.gap[i] < 0.0 || (block.force[i] > 0.0 && !was_drawn);
        if (!(drawn_to > 0.0) && !was_drawn) continue;
        const Vec3 b_in = inward(truss, block, i);
        if (at_surface) {
            // Where the surface presses the node to: as drafted, or, free to slide, by the gap along its truss.
            const double cosine = std::max(b_in.dot(contact_.normal(i)), 0.0);
            const double pressed_to =
                drafted ? now_.trusses.block[b].deflection[i] : block.deflection[i] - faces_.gap[i] * cosine;
            if (drawn_to <= pressed_to + tolerance::drawn_further) continue;
        } else if (!was_drawn && drawn_to <= block.deflection[i]) {
            continue;
        }
        any = true;
        nearest_[i] = by_dent;
        faces_.own_way[i] = 1.0;
        const bool lost = !(drawn_to > 0.0);
        faces_.gap[i] = lost ? 1.0 : block.deflection[i] - drawn_to;
        const Vec3 n = lost ? Vec3(Vec3::Zero()) : b_in;
        contact_.nx[i] = n.x(), contact_.ny[i] = n.y(), contact_.nz[i] = n.z();
        faces_.bx[i] = n.x(), faces_.by[i] = n.y(), faces_.bz[i] = n.z();
    }
    return any;
}

// Hands what hangs over to its drivers.
void Skin::note_drawn(TrussBlockState& next) {
    next.drawn = 0;
    next.touching = false;
    for (std::size_t i = 0; i < lanes; ++i) {
        if (!(next.force[i] > 0.0)) continue;
        if (nearest_[i] != by_dent) {
            next.touching = true;
            continue;
        }
        next.drawn |= std::uint64_t{1} << i;
        drivers_[hanging_.driver[i]].extra += 0.5 * next.force[i];
        drivers_[hanging_.second[i]].extra += 0.5 * next.force[i];
    }
    if (!next.touching) next.box = box_around(next.x, next.y, next.z);
}

// What hangs on a node presses with it on its obstacle.
void Skin::load_drivers() {
    TrussBlockState places{};  // places and normals of empty lanes are numbers, too
    BlockContact contact{};
    for (std::size_t k = 0; k < near_.size(); ++k) {
        ObstacleSums& sums = obstacles_[k];
        std::size_t count = 0;
        const auto rub_some = [&] {
            std::fill(contact.pressure.begin() + static_cast<std::ptrdiff_t>(count), contact.pressure.end(),
                      0.0);
            const double mu = scene_.obstacles[near_[k].index].friction;
            if (mu > 0.0 && count > 0)
                add_friction(unit_.body, mu, full_speed_, motion_, places, contact, sums.friction);
            count = 0;
        };
        for (const Driver& driver : drivers_) {
            if (driver.near != k || driver.extra == 0.0) continue;
            TrussBlockState& block = now_.trusses.block[driver.block];
            block.leading |= std::uint64_t{1} << driver.lane;
            block.touching = true;
            const Vec3 node(block.x[driver.lane], block.y[driver.lane], block.z[driver.lane]);
            const double force = driver.extra * driver.per_force;
            const Vec3 push = force * driver.normal;
            sums.contact += {push, node.cross(push)};
            sums.normal_force += force;
            places.x[count] = node.x(), places.y[count] = node.y(), places.z[count] = node.z();
            contact.nx[count] = driver.normal.x(), contact.ny[count] = driver.normal.y();
            contact.nz[count] = driver.normal.z();
            contact.pressure[count] = force;
            if (++count == lanes) rub_some();
        }
        rub_some();
    }
}

}  // namespace birm3d
