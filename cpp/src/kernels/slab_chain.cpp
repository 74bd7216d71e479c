// Chooses the slabs that are solved for; Newton's method is in slab_chain_newton.cpp.
#include "kernels/slab_chain.hpp"

#include <cmath>

namespace birm3d {

namespace {

// A pin between slabs at rest whose gap is below this has no force (m).
constexpr double closed = 1e-10;

}  // namespace

void SlabChain::set_up(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift) {
    pins_ = pins;
    drift_ = drift;
    work_ = 0;
    status_.resize(slabs.size());
    blocks_.resize((slabs.size() + block_size - 1) / block_size);
    links_.resize(pins.size());
    motions_.assign(slabs.size(), Vec3::Zero());
    frictions_.assign(slabs.size(), Vec3::Zero());
    pulls_.assign(slabs.size(), Vec3::Zero());
    for (std::size_t s = 0; s < slabs.size(); ++s)
        set_up_slab(slabs[s], s);
    for (std::size_t l = 0; l < pins.size(); ++l) {
        const SlabPin& pin = pins[l];
        set_up_end(block_of(l), block_of(l).high, l % block_size, pin.on_first, -0.5 * pin.gap);
        set_up_end(block_of(l + 1), block_of(l + 1).low, (l + 1) % block_size, pin.on_next, 0.5 * pin.gap);
        links_[l].pull.setZero();
        links_[l].target.setZero();
        if (drift > 0.0 && pin.gap.cwiseAbs().maxCoeff() > closed)
            for (const std::size_t beside : {l, l + 1})
                status_[beside].awake = status_[beside].fresh = true;
    }
}

void SlabChain::set_up_slab(const PinnedSlab& slab, std::size_t s) {
    SlabBlock& b = block_of(s);
    const std::size_t i = s % block_size;
    const double k = std::sqrt(slab.inertia / slab.mass);
    b.mass[i] = slab.mass, b.gyration[i] = k;
    b.reach[i] = slab.limit / slab.mass;
    constexpr double nothing = 1e-100;  // m/s
    b.limit[i] = b.reach[i] > nothing ? 0.25 * slab.limit : 0.0;
    b.start_x[i] = slab.motion.x(), b.start_y[i] = slab.motion.y(), b.start_z[i] = k * slab.motion.z();
    b.q_x[i] = slab.guess.x(), b.q_y[i] = slab.guess.y(), b.q_z[i] = k * slab.guess.z();
    for (std::size_t c = 0; c < slab.arm.size(); ++c)
        b.corners[c].arm_x[i] = slab.arm[c].x() / k, b.corners[c].arm_y[i] = slab.arm[c].y() / k;
    for (SlabEnd* end : {&b.low, &b.high})
        set_up_end(b, *end, i, Vec2::Zero(), Vec2::Zero());  // ends without a pin
    status_[s].awake = status_[s].fresh = !b.start(i).isZero(0.0) || !b.q(i).isZero(0.0);
}

// `to_middle`: from the place on the slab to the middle of the pin's two places.
void SlabChain::set_up_end(const SlabBlock& b, SlabEnd& end, std::size_t i, const Vec2& place,
                           const Vec2& to_middle) {
    const Vec2 arm = (place + to_middle) / b.gyration[i];
    end.place_x[i] = place.x(), end.place_y[i] = place.y();
    end.arm_x[i] = arm.x(), end.arm_y[i] = arm.y();
    end.pull_x[i] = end.pull_y[i] = 0.0;
}

void SlabChain::find_runs() {
    runs_.clear();
    for (std::size_t i = 0; i < status_.size(); ++i) {
        if (!status_[i].awake) continue;
        if (i == 0 || !status_[i - 1].awake) runs_.push_back({i, i});
        runs_.back().end = i + 1;
    }
}

// Impulse of the pins, in q's units.
Vec3 SlabChain::pull_on(std::size_t slab) const {
    const SlabBlock& b = block_of(slab);
    const std::size_t i = slab % block_size;
    Vec3 sum = Vec3::Zero();
    const auto add = [&sum, i](const SlabEnd& end, const Vec2& pull) {
        sum += Vec3(pull.x(), pull.y(), end.arm_x[i] * pull.y() - end.arm_y[i] * pull.x());
    };
    if (slab < links_.size()) add(b.high, links_[slab].pull);
    if (slab > 0) add(b.low, -links_[slab - 1].pull);
    return sum;
}

// Does friction hold the slab, so that it moves only by the regularisation?
bool SlabChain::is_held(std::size_t slab) const {
    constexpr double well = 0.9;  // of the limit: |u| is twice e there
    const SlabBlock& b = block_of(slab);
    const std::size_t i = slab % block_size;
    return b.limit[i] > 0.0 &&
           std::all_of(b.corners.begin(), b.corners.end(), [i](const SlabCorners& corner) {
               return Vec2(corner.law_x[i], corner.law_y[i]).squaredNorm() < well * well;
           });
}

// Adds a quarter of the run, and one more slab, from slab `end` on. So all tries together cost a few times the last
// one.
void SlabChain::wake(const Run& run, std::size_t end, int direction) {
    const std::size_t number = 1 + (run.end - run.begin) / 4;
    auto i = static_cast<std::ptrdiff_t>(end);
    for (std::size_t count = 0; count < number; ++count, i += direction) {
        if (i < 0 || i >= static_cast<std::ptrdiff_t>(status_.size())) break;
        SlabStatus& woken = status_[static_cast<std::size_t>(i)];
        if (woken.awake) break;
        woken.awake = woken.fresh = true;
    }
}

// Adds slabs before and behind the run where its ends are not held. Returns whether any were added.
bool SlabChain::wake_around(const Run& run) {
    const bool before = run.begin > 0 && !is_held(run.begin);
    const bool behind = run.end < status_.size() && !is_held(run.end - 1);
    if (before) wake(run, run.begin - 1, -1);
    if (behind) wake(run, run.end, 1);
    return before || behind;
}

// Adds the neighbours of slabs that move or are pushed, because they may hold them.
void SlabChain::take_in_neighbours() {
    for (std::size_t i = 1; i < status_.size(); ++i)
        status_[i].awake = status_[i].awake || status_[i - 1].fresh;
    for (std::size_t i = status_.size() - 1; i-- > 0;)
        status_[i].awake = status_[i].awake || status_[i + 1].fresh;
    for (SlabStatus& part : status_)
        part.fresh = part.awake;
}

void SlabChain::store_results() {
    for (std::size_t s = 0; s < status_.size(); ++s) {
        if (!status_[s].awake) continue;
        const SlabBlock& b = block_of(s);
        const std::size_t i = s % block_size;
        const double k = b.gyration[i];
        const auto to_world = [k](const Vec3& q) { return Vec3(q.x(), q.y(), k * q.z()); };
        const Vec3 pull = pull_on(s);
        pulls_[s] = to_world(pull);
        motions_[s] = {b.q_x[i], b.q_y[i], b.q_z[i] / k};
        if (b.limit[i] > 0.0) frictions_[s] = to_world(b.mass[i] * (b.q(i) - b.start(i)) - pull);
    }
}

void SlabChain::solve(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift) {
    set_up(slabs, pins, drift);
    take_in_neighbours();
    for (bool woken = true; woken;) {
        find_runs();
        woken = false;
        for (const Run& run : runs_) {
            bool fresh = false;
            for (std::size_t i = run.begin; i < run.end; ++i)
                fresh = fresh || status_[i].fresh, status_[i].fresh = false;
            if (fresh) solve_run(run);
        }
        for (const Run& run : runs_)
            woken = wake_around(run) || woken;
    }
    store_results();
}

}  // namespace birm3d
