#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "birm3d/kernels/slab_chain.hpp"

namespace birm3d {

namespace {

// Rows of J at a place: what q makes of its velocity.
Vec2 velocity(const Vec2& arm, const Vec3& q) {
    return {q.x() - arm.y() * q.z(), q.y() + arm.x() * q.z()};
}

// J^T.
Vec3 wrench(const Vec2& arm, const Vec2& push) {
    return {push.x(), push.y(), arm.x() * push.y() - arm.y() * push.x()};
}

double rounded(const Vec2& u, double soft) {
    return std::sqrt(u.squaredNorm() + soft * soft);
}

// J mobility K^T of two places of one slab.
Mat2 response(const Vec2& arm, const Mat3& mobility, const Vec2& other) {
    Mat2 result;
    result.col(0) = velocity(arm, mobility * wrench(other, Vec2::UnitX()));
    result.col(1) = velocity(arm, mobility * wrench(other, Vec2::UnitY()));
    return result;
}

// Of a symmetric matrix, through its minors.
Mat3 inverse_of(double xx, double yy, double zz, double xy, double xz, double yz) {
    const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
    const double scale = 1.0 / (xx * a + xy * b + xz * c);
    Mat3 result;
    result << a, b, c, b, xx * zz - xz * xz, xy * xz - xx * yz, c, xy * xz - xx * yz, xx * yy - xy * xy;
    return scale * result;
}

// What a turn of the Cayley map adds to a place, as drift() in integrate.cpp turns it.
Vec2 turned_away(const Vec2& arm, double spin, double dt) {
    const double half = 0.5 * dt * spin, scale = 2.0 * half / (1.0 + half * half);
    return scale * (Vec2(-arm.y(), arm.x()) - half * arm);
}

constexpr double infinity = std::numeric_limits<double>::infinity();

// The friction that a step took is that of the law to this share of the limit, or to what rounding leaves. When it is
// near, steps are Newton's own.
constexpr double lawful = 1e-9, rounding = 1e-6, near_lawful = 1e-2;

// Gap of a pin after the drift that is rounding (m).
constexpr double closed = 1e-12;

}  // namespace

Vec2 SlabChain::speed_between(std::size_t link, Vec3 Part::* motion) const {
    const Link& at = links_[link];
    return velocity(at.on_first, parts_[link].*motion) - velocity(at.on_next, parts_[link + 1].*motion);
}

// Where corners nearly stop, the rounding is taken away step by step, unless the guess does without.
void SlabChain::solve_run(const Run& run) {
    constexpr double softest = 0.1, hardest = 1e-6;
    constexpr int most_from_guess = 15, most_steps = 50;
    if (newton(run, hardest, most_from_guess, true)) return;
    start_from_pins(run);
    for (double soft = softest; soft > 2.0 * hardest; soft *= 0.1)
        newton(run, soft, most_steps, false);
    newton(run, hardest, most_steps, true);
}

// The nearest motion to the start that the pins allow.
void SlabChain::start_from_pins(const Run& run) {
    for (std::size_t i = run.begin; i < run.end; ++i)
        parts_[i].q = parts_[i].start;
    find_way(run, false);
    for (std::size_t i = run.begin; i < run.end; ++i)
        parts_[i].q += parts_[i].way;
}

// Did it arrive? `finish`: close the pins, too, and go on until the law is met. The first step goes all the way, so that
// the pins hold; later ones are halved where they overshoot, until they are small enough for the pins to be closed.
bool SlabChain::newton(const Run& run, double soft, int most_steps, bool finish) {
    for (std::size_t i = run.begin; i < run.end; ++i)
        for (Corner& corner : parts_[i].corners)
            corner.used.setZero();
    settle_laws(run, soft);
    for (std::size_t i = run.begin; i < run.end; ++i)
        for (Corner& corner : parts_[i].corners)
            corner.dual = corner.law;
    const bool closes = finish && drift_ > 0.0;
    if (closes) retarget(run);
    double missed = infinity, gap = infinity;
    for (int i = 0; i < most_steps; ++i) {
        find_way(run, true);
        const double share = i == 0 || missed < near_lawful ? 1.0 : search(run, soft);
        take_step(run, share);
        const double before = missed, gap_before = gap;
        missed = settle_laws(run, soft);
        if (share < 1.0) missed = infinity;
        if (!(missed < near_lawful)) continue;
        gap = closes ? retarget(run) : 0.0;
        const bool is_met = missed <= lawful || (missed <= rounding && missed >= before);
        if (!finish || (is_met && (gap <= closed || gap >= gap_before))) return true;
    }
    return false;
}

// Newton's step H way = -gradient + J^T pull with J (q + way) = target.
void SlabChain::find_way(const Run& run, bool rubs) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
        Part& part = parts_[i];
        Vec3 gradient = part.mass * (part.q - part.start);
        double xx = part.mass, yy = part.mass, zz = part.mass, xy = 0.0, xz = 0.0, yz = 0.0;
        if (rubs && part.limit > 0.0)
            for (const Corner& corner : part.corners) {
                gradient += part.limit * wrench(corner.arm, corner.law);
                const Vec2 &n = corner.law, &y = corner.dual, &r = corner.arm;
                const double scale = part.limit / corner.eta;
                const double a = scale * (1.0 - n.x() * y.x()), c = scale * (1.0 - n.y() * y.y());
                const double b = -0.5 * scale * (n.x() * y.y() + n.y() * y.x());
                const double turn_x = b * r.x() - a * r.y(), turn_y = c * r.x() - b * r.y();
                xx += a, xy += b, yy += c, xz += turn_x, yz += turn_y;
                zz += turn_y * r.x() - turn_x * r.y();
            }
        part.mobility = inverse_of(xx, yy, zz, xy, xz, yz);
        part.way = -(part.mobility * gradient);
    }
    find_pulls(run);
    for (std::size_t l = run.begin; l + 1 < run.end; ++l) {
        const Link& link = links_[l];
        parts_[l].way += parts_[l].mobility * wrench(link.on_first, link.pull);
        parts_[l + 1].way -= parts_[l + 1].mobility * wrench(link.on_next, link.pull);
    }
    work_ += run.end - run.begin;
}

// Elimination from the first pin to the last and back.
void SlabChain::find_pulls(const Run& run) {
    for (std::size_t l = run.begin; l + 1 < run.end; ++l) {
        Link& link = links_[l];
        const Part &first = parts_[l], &next = parts_[l + 1];
        Mat2 block = response(link.on_first, first.mobility, link.on_first) +
                     response(link.on_next, next.mobility, link.on_next);
        link.lack = link.target - velocity(link.on_first, first.q + first.way) +
                    velocity(link.on_next, next.q + next.way);
        if (l > run.begin) {
            const Link& before = links_[l - 1];
            const Mat2 across = before.beside.transpose() * before.inverse;
            block -= across * before.beside;
            link.lack -= across * before.lack;
        }
        link.inverse = block.inverse();
        if (l + 2 < run.end) link.beside = -response(link.on_next, next.mobility, links_[l + 1].on_first);
    }
    for (std::size_t l = run.end - 1; l-- > run.begin;) {
        Link& link = links_[l];
        Vec2 lack = link.lack;
        if (l + 2 < run.end) lack -= link.beside * links_[l + 1].pull;
        link.pull = link.inverse * lack;
    }
}

double SlabChain::value(const Run& run, double soft, double share) const {
    double sum = 0.0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
        const Part& part = parts_[i];
        const Vec3 q = part.q + share * part.way;
        sum += 0.5 * part.mass * (q - part.start).squaredNorm();
        if (part.limit > 0.0)
            for (const Corner& corner : part.corners)
                sum += part.limit * rounded(velocity(corner.arm, q), soft * part.reach);
    }
    return sum;
}

// Share of the way after which the function has not grown.
double SlabChain::search(const Run& run, double soft) const {
    constexpr double least = 1e-9;
    const double now = value(run, soft, 0.0);
    double share = 1.0;
    while (share > least && value(run, soft, share) > now)
        share *= 0.5;
    return share;
}

void SlabChain::take_step(const Run& run, double share) {
    for (std::size_t i = run.begin; i < run.end; ++i) {
        Part& part = parts_[i];
        part.q += share * part.way;
        if (!(part.limit > 0.0)) continue;
        for (Corner& corner : part.corners) {
            const Vec2 u = share / corner.eta * velocity(corner.arm, part.way);
            const Vec2 &n = corner.law, &y = corner.dual;
            corner.used = n + u - 0.5 * (y * n.dot(u) + n * y.dot(u));
            const Vec2 next = n + u - y * n.dot(u);
            corner.dual = next / std::max(1.0, next.norm());
        }
    }
}

// By how much the law at the motions at hand differs from the frictions used, as a share of the limits.
double SlabChain::settle_laws(const Run& run, double soft) {
    double most = 0.0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
        Part& part = parts_[i];
        if (!(part.limit > 0.0)) continue;
        for (Corner& corner : part.corners) {
            const Vec2 u = velocity(corner.arm, part.q);
            corner.eta = rounded(u, soft * part.reach);
            corner.law = u / corner.eta;
            most = std::max(most, (corner.law - corner.used).cwiseAbs().maxCoeff());
        }
    }
    return most;
}

// Speeds of the pins that close them after the drift, to first order in what is missing; returns the widest gap left by
// the motions at hand (m).
double SlabChain::retarget(const Run& run) {
    double widest = 0.0;
    for (std::size_t l = run.begin; l + 1 < run.end; ++l) {
        const SlabPin& pin = pins_[l];
        Vec2 gap = pin.gap;
        const auto add = [&](std::size_t slab, const Vec2& arm, double sign) {
            const Part& part = parts_[slab];
            gap += sign * (drift_ * part.q.head<2>() + turned_away(arm, part.q.z() / part.gyration, drift_));
        };
        add(l, pin.on_first, 1.0);
        add(l + 1, pin.on_next, -1.0);
        links_[l].target = speed_between(l, &Part::q) - gap / drift_;
        widest = std::max(widest, gap.cwiseAbs().maxCoeff());
    }
    return widest;
}

}  // namespace birm3d
