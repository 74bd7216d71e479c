#include <Eigen/LU>
#include <algorithm>

#include "kernels/slab_chain_columns.hpp"

namespace birm3d {

namespace {

// Converged if friction and law differ by less than this fraction of the limit, or by rounding only. Below the third
// number, full Newton steps are taken.
constexpr double lawful = 1e-9, rounding = 1e-6, near_lawful = 1e-2;

// Gap of a pin after the drift below which it is rounding (m).
constexpr double closed_by_newton = 1e-12;

Vec2 at(const BlockColumn& x, const BlockColumn& y, std::size_t slab) {
    return {x[slab % block_size], y[slab % block_size]};
}

Mat2 at(const SlabResponse& responses, std::size_t slab) {
    const std::size_t i = slab % block_size;
    Mat2 response;
    response << responses.xx[i], responses.xy[i], responses.yx[i], responses.yy[i];
    return response;
}

}  // namespace

template <class F>
void SlabChain::for_each_block(const Run& run, F f) {
    for (std::size_t b = run.begin / block_size; b * block_size < run.end; ++b) {
        const std::size_t before = b * block_size;
        f(SlabRange{blocks_[b], std::max(run.begin, before) - before,
                    std::min(run.end - before, block_size)});
    }
}

// If corners nearly stop, the regularisation is reduced step by step, unless the guess converges at once.
void SlabChain::solve_run(const Run& run) {
    constexpr double softest = 0.1, hardest = 1e-6;
    constexpr int most_from_guess = 15, most_steps = 50;
    if (newton(run, hardest, most_from_guess, true)) return;
    start_from_pins(run);
    for (double soft = softest; soft > 2.0 * hardest; soft *= 0.1)
        newton(run, soft, most_steps, false);
    newton(run, hardest, most_steps, true);
}

// Starts from the motion nearest to the initial one that the pins allow.
void SlabChain::start_from_pins(const Run& run) {
    for_each_block(run, [](const SlabRange& slabs) { back_to_start(slabs); });
    find_newton_step(run, false);
    for_each_block(run, [](const SlabRange& slabs) { go_on(slabs, 1.0); });
}

// Returns whether it converged. `finish`: also close the pins and iterate until the law is met. The first step is a
// full one, so that the pins hold. Later steps are halved if they overshoot, until they are small enough to close the
// pins.
bool SlabChain::newton(const Run& run, double soft, int most_steps, bool finish) {
    for_each_block(run, [soft](const SlabRange& slabs) { start_from_laws(slabs, soft); });
    const bool closes = finish && drift_ > 0.0;
    if (closes) retarget(run);
    double missed = infinity, gap = infinity;
    for (int i = 0; i < most_steps; ++i) {
        find_newton_step(run, true);
        const double fraction = i == 0 || missed < near_lawful ? 1.0 : search(run, soft);
        for_each_block(run, [fraction](const SlabRange& slabs) { take_step(slabs, fraction); });
        const double before = missed, gap_before = gap;
        missed = settle_laws(run, soft);
        if (fraction < 1.0) missed = infinity;
        if (!(missed < near_lawful)) continue;
        gap = closes ? retarget(run) : 0.0;
        const bool is_met = missed <= lawful || (missed <= rounding && missed >= before);
        if (!finish || (is_met && (gap <= closed_by_newton || gap >= gap_before))) return true;
    }
    return false;
}

// Newton's step p: H p = -gradient + J^T pull with J (q + p) = target.
void SlabChain::find_newton_step(const Run& run, bool with_friction) {
    for_each_block(run, [with_friction](const SlabRange& slabs) {
        find_newton_steps(slabs, with_friction);
        find_responses(slabs);
    });
    find_pulls(run);
    for_each_block(run, [](const SlabRange& slabs) { add_pulls(slabs); });
    work_ += run.end - run.begin;
}

// Elimination from the first pin to the last and back.
void SlabChain::find_pulls(const Run& run) {
    for (std::size_t l = run.begin; l + 1 < run.end; ++l) {
        Link& link = links_[l];
        const SlabBlock &first = block_of(l), &next = block_of(l + 1);
        Mat2 block = at(first.at_high, l) + at(next.at_low, l + 1);
        link.rhs = link.target - at(first.high.speed_x, first.high.speed_y, l) +
                   at(next.low.speed_x, next.low.speed_y, l + 1);
        if (l > run.begin) {
            const Link& before = links_[l - 1];
            const Mat2 across = before.off_diagonal.transpose() * before.inverse;
            block -= across * before.off_diagonal;
            link.rhs -= across * before.rhs;
        }
        link.inverse = block.inverse();
        if (l + 2 < run.end) link.off_diagonal = -at(next.across, l + 1);
    }
    for (std::size_t l = run.end - 1; l-- > run.begin;) {
        Link& link = links_[l];
        Vec2 rhs = link.rhs;
        if (l + 2 < run.end) rhs -= link.off_diagonal * links_[l + 1].pull;
        link.pull = link.inverse * rhs;
        SlabEnd &high = block_of(l).high, &low = block_of(l + 1).low;
        high.pull_x[l % block_size] = low.pull_x[(l + 1) % block_size] = link.pull.x();
        high.pull_y[l % block_size] = low.pull_y[(l + 1) % block_size] = link.pull.y();
    }
}

double SlabChain::value(const Run& run, double soft, double fraction) {
    double sum = 0.0;
    for_each_block(run, [&](const SlabRange& slabs) { sum = add_value(slabs, soft, fraction, sum); });
    return sum;
}

// Fraction of Newton's step after which the function has not grown.
double SlabChain::search(const Run& run, double soft) {
    constexpr double least = 1e-9;
    const double now = value(run, soft, 0.0);
    double fraction = 1.0;
    while (fraction > least && value(run, soft, fraction) > now)
        fraction *= 0.5;
    return fraction;
}

// Greatest difference between the law at the present motions and the frictions used, as a fraction of the limits.
double SlabChain::settle_laws(const Run& run, double soft) {
    double most = 0.0;
    for_each_block(run,
                   [&](const SlabRange& slabs) { most = std::max(most, birm3d::settle_laws(slabs, soft)); });
    return most;
}

// Sets the velocities of the pins that close them after the drift, to first order in the gaps. Returns the widest gap
// that the present motions leave (m).
double SlabChain::retarget(const Run& run) {
    for_each_block(run, [this](const SlabRange& slabs) { find_drifts(slabs, drift_); });
    double widest = 0.0;
    for (std::size_t l = run.begin; l + 1 < run.end; ++l) {
        const SlabEnd &high = block_of(l).high, &low = block_of(l + 1).low;
        const Vec2 gap =
            pins_[l].gap + at(high.drift_x, high.drift_y, l) - at(low.drift_x, low.drift_y, l + 1);
        links_[l].target =
            at(high.speed_x, high.speed_y, l) - at(low.speed_x, low.speed_y, l + 1) - gap / drift_;
        widest = std::max(widest, gap.cwiseAbs().maxCoeff());
    }
    return widest;
}

}  // namespace birm3d
