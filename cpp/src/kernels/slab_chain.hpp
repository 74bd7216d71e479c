// Coulomb friction of slabs that pins hold together end to end: one minimum for all of them.
//
// The convex function is that of ground_slide.hpp, summed over the slabs. The pins are its equality constraints. All
// slabs of a chain are solved together, because how far friction lets one move depends on all of them. |u| is regularised
// as eta = sqrt(|u|^2 + e^2), with e a millionth of the speed that friction can remove.
//
// Newton's method for the motions and the frictions y_i together, each a share of the corner's limit c (Chan, Golub and
// Mulet, SIAM J. Sci. Comput. 20, 1999, p. 1964):
//   M (v - v0) + sum of c J_i^T y_i = impulses of the pins,   eta_i y_i = u_i.
// A step is a system in the impulses of the pins alone. It is block-tridiagonal, with 2 x 2 blocks, and is eliminated from
// one end to the other: the cost grows with the number of slabs.
//
// Slabs at rest behind a slab that friction holds carry no force and are left out of the system. Starting from slabs
// that move or are pushed, neighbours are added until friction holds the outermost ones. That does not change the
// minimum.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "birm3d/base/block.hpp"
#include "birm3d/base/types.hpp"

namespace birm3d {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// A slab that slides on the ground. Motions are (x, y, rotation about the vertical), world axes.
struct PinnedSlab {
    double mass;                 // kg
    double inertia;              // about the vertical (kg m^2)
    std::array<Vec2, 4> arm;     // from the mass centre to the corners of the base, symmetric about it (m)
    double limit;                // friction coefficient times normal impulse of all corners (N s)
    Vec3 motion = Vec3::Zero();  // without friction and pins (m/s, m/s, rad/s)
    Vec3 guess = Vec3::Zero();   // of the motion with both; zero if it is expected to rest
};

// The pin between a slab and the next one.
struct SlabPin {
    Vec2 on_first, on_next;   // from the mass centres to the place of the pin on either slab (m)
    Vec2 gap = Vec2::Zero();  // from the place on the next slab to that on the first one (m)
};

// One corner of the bases of some slabs, a column entry for each slab: friction by the law at the present motion, the
// dual y, and the values that the last step used.
struct SlabCorners {
    BlockColumn arm_x, arm_y;  // in units of k
    BlockColumn law_x, law_y, dual_x, dual_y, used_x, used_y;
    BlockColumn eta;  // regularised |u| (m/s)
};

// An end of some slabs, with the pin there.
struct SlabEnd {
    BlockColumn place_x, place_y;  // of the pin, from the mass centre (m)
    BlockColumn arm_x, arm_y;      // of the middle of its two places, in units of k
    BlockColumn pull_x, pull_y;    // (N s)
    BlockColumn speed_x, speed_y;  // (m/s)
    BlockColumn drift_x, drift_y;  // (m)
};

// J mobility K^T of two ends (1/kg).
struct SlabResponse {
    BlockColumn xx, xy, yx, yy;
};

// Some slabs in q = (v_x, v_y, k w), k their radius of gyration. Operations that are independent for each slab run
// over columns.
struct alignas(64) SlabBlock {
    BlockColumn mass, gyration, limit, reach;  // of one corner (N s); what friction can take (m/s)
    BlockColumn start_x, start_y, start_z, q_x, q_y, q_z, step_x, step_y, step_z;
    BlockColumn xx, xy, xz, yy, yz, zz;  // mobility, the inverse of the curvature
    std::array<SlabCorners, 4> corners;
    SlabEnd low, high;  // towards the slab before, and the next one
    SlabResponse at_low, at_high, across;

    Vec3 start(std::size_t i) const { return {start_x[i], start_y[i], start_z[i]}; }
    Vec3 q(std::size_t i) const { return {q_x[i], q_y[i], q_z[i]}; }
};

class SlabChain {
  public:
    // One pin between each two slabs. With a `drift` (s) the pins are closed after a drift of that length. Without,
    // the joined places have the same velocity. A pin's force acts half way between its two places, so that it keeps
    // the angular momentum.
    void solve(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift);

    std::span<const Vec3> motions() const { return motions_; }      // (slabs) with friction and pins
    std::span<const Vec3> frictions() const { return frictions_; }  // (slabs) N s, N s, N m s
    // (slabs) impulses of the pins on each of them (N s, N s, N m s).
    std::span<const Vec3> pulls() const { return pulls_; }

    // Was the slab part of the system? Others rest.
    bool is_awake(std::size_t slab) const { return slab < status_.size() && status_[slab].awake; }

    // Cost of the last solution: the sum of slabs over all Newton steps.
    std::size_t work() const { return work_; }

  private:
    struct SlabStatus {
        bool awake, fresh;
    };
    struct Link {
        Vec2 target, rhs, pull;
        Mat2 inverse, off_diagonal;  // of the eliminated block; the block beside it
    };
    // Slabs that are solved for together. Slabs before and behind are at rest, and their pins have no force.
    struct Run {
        std::size_t begin, end;
    };

    void set_up(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift);
    void set_up_slab(const PinnedSlab& slab, std::size_t s);
    static void set_up_end(const SlabBlock& b, SlabEnd& end, std::size_t i, const Vec2& place,
                           const Vec2& to_middle);
    void find_runs();
    bool wake_around(const Run& run);
    void wake(const Run& run, std::size_t end, int direction);
    bool is_held(std::size_t slab) const;
    void take_in_neighbours();
    Vec3 pull_on(std::size_t slab) const;
    void store_results();

    void solve_run(const Run& run);
    void start_from_pins(const Run& run);
    bool newton(const Run& run, double soft, int most_steps, bool finish);
    void find_newton_step(const Run& run, bool with_friction);
    void find_pulls(const Run& run);
    double search(const Run& run, double soft);
    double value(const Run& run, double soft, double fraction);
    double settle_laws(const Run& run, double soft);
    double retarget(const Run& run);
    // Calls f with the slabs of a run that are in each block.
    template <class F>
    void for_each_block(const Run& run, F f);

    SlabBlock& block_of(std::size_t slab) { return blocks_[slab / block_size]; }
    const SlabBlock& block_of(std::size_t slab) const { return blocks_[slab / block_size]; }

    std::span<const SlabPin> pins_;
    double drift_ = 0.0;
    std::vector<SlabStatus> status_;
    std::vector<SlabBlock> blocks_;
    std::vector<Link> links_;
    std::vector<Run> runs_;
    std::vector<Vec3> motions_, frictions_, pulls_;
    std::size_t work_ = 0;
};

}  // namespace birm3d
