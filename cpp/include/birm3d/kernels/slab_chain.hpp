// Coulomb friction of slabs that pins hold together end to end: one minimum for all of them.
//
// The convex function is that of ground_slide.hpp, summed over the slabs, with what the pins hold as conditions: where a
// chain is held, and how far it is dragged along, depends on all of it. |u| is rounded off to eta = sqrt(|u|^2 + e^2), e a
// millionth of the speed that friction can take.
//
// Newton's method for the motions and the frictions y_i together, each a share of the corner's limit c (Chan, Golub and
// Mulet, SIAM J. Sci. Comput. 20, 1999, p. 1964):
//   M (v - v0) + sum of c J_i^T y_i = impulses of the pins,   eta_i y_i = u_i.
// A step is a system in the impulses of the pins alone. It is block-tridiagonal, with 2 x 2 blocks, and is eliminated from
// one end to the other: the cost grows with the number of slabs.
//
// What rests behind a slab that is held has nothing to hold and stays out of the system. Slabs are taken in from those
// that move or are pushed until the outermost are held, which leaves the minimum as it is.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "birm3d/base/types.hpp"

namespace birm3d {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// Along the ground and about the vertical, world axes: x, y, turn.
struct PinnedSlab {
    double mass;                 // kg
    double inertia;              // about the vertical (kg m^2)
    std::array<Vec2, 4> arm;     // from the mass centre to the corners of the base, symmetric about it (m)
    double limit;                // friction coefficient times normal impulse of all corners (N s)
    Vec3 motion = Vec3::Zero();  // without friction and pins (m/s, m/s, rad/s)
    Vec3 guess = Vec3::Zero();   // of the motion with both; zero where it is thought to rest
};

// Between a slab and the next one.
struct SlabPin {
    Vec2 on_first, on_next;   // from the mass centres to the place of the pin on either slab (m)
    Vec2 gap = Vec2::Zero();  // from the place on the next slab to that on the first one (m)
};

class SlabChain {
  public:
    // One pin between each two slabs. With a `drift` (s) the pins are closed after a drift of that length. Without, the
    // places that they join move alike. A pin pushes half way between its places, so that it keeps the angular momentum.
    void solve(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift);

    std::span<const Vec3> motions() const { return motions_; }      // (slabs) with friction and pins
    std::span<const Vec3> frictions() const { return frictions_; }  // (slabs) N s, N s, N m s
    // (slabs) impulses of the pins on each of them (N s, N s, N m s).
    std::span<const Vec3> pulls() const { return pulls_; }

    // Was the slab solved for? Others rest.
    bool is_awake(std::size_t slab) const { return slab < parts_.size() && parts_[slab].awake; }

    // What the last solution cost: slabs in Newton's steps, each step counted.
    std::size_t work() const { return work_; }

  private:
    // A corner of a base: friction by the law at the motion at hand, y, and what the last step took for both.
    struct Corner {
        Vec2 arm;  // in units of k
        Vec2 law, dual, used;
        double eta;
    };
    // A slab in q = (v_x, v_y, k w), k its radius of gyration.
    struct Part {
        double mass, gyration, limit, reach;  // of one corner (N s); what friction can take (m/s)
        Vec3 start, q, way;
        std::array<Corner, 4> corners;
        Mat3 mobility;  // inverse of the curvature
        bool awake, fresh;
    };
    struct Link {
        Vec2 on_first, on_next;  // of the middle, in units of k
        Vec2 target, lack, pull;
        Mat2 inverse, beside;  // of the eliminated block; the block beside it
    };
    // Slabs that are solved for together; those before and behind rest, and their pins pull at nothing.
    struct Run {
        std::size_t begin, end;
    };

    void set_up(std::span<const PinnedSlab> slabs, std::span<const SlabPin> pins, double drift);
    void find_runs();
    bool wake_around(const Run& run);
    void wake(const Run& run, std::size_t end, int direction);
    static bool is_held(const Part& part);
    void take_in_neighbours();
    Vec3 pull_on(std::size_t slab) const;
    void hand_over();

    void solve_run(const Run& run);
    void start_from_pins(const Run& run);
    bool newton(const Run& run, double soft, int most_steps, bool finish);
    void find_way(const Run& run, bool rubs);
    void find_pulls(const Run& run);
    double search(const Run& run, double soft) const;
    double value(const Run& run, double soft, double share) const;
    void take_step(const Run& run, double share);
    double settle_laws(const Run& run, double soft);
    double retarget(const Run& run);
    Vec2 speed_between(std::size_t link, Vec3 Part::* motion) const;

    std::span<const SlabPin> pins_;
    double drift_ = 0.0;
    std::vector<Part> parts_;
    std::vector<Link> links_;
    std::vector<Run> runs_;
    std::vector<Vec3> motions_, frictions_, pulls_;
    std::size_t work_ = 0;
};

}  // namespace birm3d
