// Which slabs are solved for, and what comes out; Newton's method is in slab_chain_newton.cpp.
#include "birm3d/kernels/slab_chain.hpp"

#include <cmath>

namespace birm3d {

namespace {

// A pin between slabs at rest that is this well closed pulls at nothing (m).
constexpr double closed = 1e-10;

}  // namespace

void SlabChain::set_up(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift) {
    pins_ = pins;
    drift_ = drift;
    work_ = 0;
    parts_.resize(slabs.size());
    links_.resize(pins.size());
    motions_.assign(slabs.size(), Vec3::Zero());
    frictions_.assign(slabs.size(), Vec3::Zero());
    pulls_.assign(slabs.size(), Vec3::Zero());
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        const PinnedSlab& slab = slabs[i];
        Part& part = parts_[i];
        const double k = std::sqrt(slab.inertia / slab.mass);
        part.mass = slab.mass, part.gyration = k;
        part.reach = slab.limit / slab.mass;
        constexpr double nothing = 1e-100;  // m/s
        part.limit = part.reach > nothing ? 0.25 * slab.limit : 0.0;
        part.start = {slab.motion.x(), slab.motion.y(), k * slab.motion.z()};
        part.q = {slab.guess.x(), slab.guess.y(), k * slab.guess.z()};
        for (std::size_t c = 0; c < slab.arm.size(); ++c)
            part.corners[c].arm = slab.arm[c] / k;
        part.awake = part.fresh = !part.start.isZero(0.0) || !part.q.isZero(0.0);
    }
    for (std::size_t l = 0; l < pins.size(); ++l) {
        const SlabPin& pin = pins[l];
        Part &first = parts_[l], &next = parts_[l + 1];
        links_[l].on_first = (pin.on_first - 0.5 * pin.gap) / first.gyration;
        links_[l].on_next = (pin.on_next + 0.5 * pin.gap) / next.gyration;
        links_[l].pull.setZero();
        links_[l].target.setZero();
        if (drift > 0.0 && pin.gap.cwiseAbs().maxCoeff() > closed)
            first.awake = first.fresh = next.awake = next.fresh = true;
    }
}

void SlabChain::find_runs() {
    runs_.clear();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (!parts_[i].awake) continue;
        if (i == 0 || !parts_[i - 1].awake) runs_.push_back({i, i});
        runs_.back().end = i + 1;
    }
}

// Impulse of the pins, in q's units.
Vec3 SlabChain::pull_on(std::size_t slab) const {
    Vec3 sum = Vec3::Zero();
    const auto add = [&sum](const Vec2& arm, const Vec2& pull) {
        sum += Vec3(pull.x(), pull.y(), arm.x() * pull.y() - arm.y() * pull.x());
    };
    if (slab < links_.size()) add(links_[slab].on_first, links_[slab].pull);
    if (slab > 0) add(links_[slab - 1].on_next, -links_[slab - 1].pull);
    return sum;
}

// Is all that moves it the rounding off?
bool SlabChain::is_held(const Part& part) {
    constexpr double well = 0.9;  // of the limit: |u| is twice e there
    return part.limit > 0.0 &&
           std::all_of(part.corners.begin(), part.corners.end(),
                       [](const Corner& corner) { return corner.law.squaredNorm() < well * well; });
}

// From slab `end` on: a quarter of the run, and one more. So all tries together cost a few times the last one.
void SlabChain::wake(const Run& run, std::size_t end, int direction) {
    const std::size_t wanted = 1 + (run.end - run.begin) / 4;
    auto i = static_cast<std::ptrdiff_t>(end);
    for (std::size_t count = 0; count < wanted; ++count, i += direction) {
        if (i < 0 || i >= static_cast<std::ptrdiff_t>(parts_.size())) break;
        Part& woken = parts_[static_cast<std::size_t>(i)];
        if (woken.awake) break;
        woken.awake = woken.fresh = true;
    }
}

// Are slabs to be taken in before or behind the run?
bool SlabChain::wake_around(const Run& run) {
    const bool before = run.begin > 0 && !is_held(parts_[run.begin]);
    const bool behind = run.end < parts_.size() && !is_held(parts_[run.end - 1]);
    if (before) wake(run, run.begin - 1, -1);
    if (behind) wake(run, run.end, 1);
    return before || behind;
}

// Those beside slabs that move or are pushed may hold them.
void SlabChain::take_in_neighbours() {
    for (std::size_t i = 1; i < parts_.size(); ++i)
        parts_[i].awake = parts_[i].awake || parts_[i - 1].fresh;
    for (std::size_t i = parts_.size() - 1; i-- > 0;)
        parts_[i].awake = parts_[i].awake || parts_[i + 1].fresh;
    for (Part& part : parts_)
        part.fresh = part.awake;
}

void SlabChain::hand_over() {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        if (!part.awake) continue;
        const auto to_world = [&part](const Vec3& q) { return Vec3(q.x(), q.y(), part.gyration * q.z()); };
        const Vec3 pull = pull_on(i);
        pulls_[i] = to_world(pull);
        motions_[i] = {part.q.x(), part.q.y(), part.q.z() / part.gyration};
        if (part.limit > 0.0) frictions_[i] = to_world(part.mass * (part.q - part.start) - pull);
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
                fresh = fresh || parts_[i].fresh, parts_[i].fresh = false;
            if (fresh) solve_run(run);
        }
        for (const Run& run : runs_)
            woken = wake_around(run) || woken;
    }
    hand_over();
}

}  // namespace birm3d
