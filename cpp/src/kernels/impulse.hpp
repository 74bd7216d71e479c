// Rigid contacts and joints solved together (paper Eq. 1 for many rows at once): tyres, bottomed-out trusses, bodies.
//
// Each row has a Jacobian J: force and torque of a unit impulse on each of its two bodies. With A = J M^-1 J^T
// and v the separation velocities without impulses, the impulses j and the separation velocities w obey
//   w = A j + v >= target,   j >= 0,   (w - target) . j = 0    for rows that push only,
//   w = target                                                  for rows that are held.
// For one contact this is Eq. 1: j = -(1 + xi) v / (1/M_a + 1/M_b + n.[I_a^-1 (r_a x n) x r_a] + ...), with
// target = -xi v. (The paper's v_rel^-1 is v_rel^-, the velocity before the impact.)
// A small compliance C on the diagonal makes the shares of redundant rows unique. Its give is taken out again by
// the proximal-point method (Rockafellar, SIAM J. Control Optim. 14, 1976, p. 877), each time with the target
// moved on by the last give: (A + C) j_new + v >= target + C j_old. What can not be met by all is then met as far
// as bodies of these compliances would.
//
// Solved exactly by the active-set method of Lawson and Hanson (Solving Least Squares Problems, ch. 23). The row
// that lacks most joins first, then all that lack join together while that helps, then one by one again; held
// rows are in from the start and stay. Many active rows are solved for through the bodies' velocity changes u:
//   (A + C) j = b   is   (M + J^T C^-1 J) u = J^T C^-1 b,   j = C^-1 (b - J u),
// so that a hundred points of one body cost a 6 x 6 system. Iterative refinement gives back the digits that a
// small C takes.
#pragma once

#include <Eigen/Cholesky>
#include <span>
#include <vector>

#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

// A body as the solver sees it, world axes. Zero inverses: it can not be moved.
struct ContactBody {
    double inverse_mass = 0.0;
    Mat3 inverse_inertia = Mat3::Zero();
    Twist motion;
    bool level =
        false;  // moves along the ground and turns about the vertical only: the ground takes the rest
};

// Velocity of the contact's point along its normal, or turning about its axis, relative to the other body;
// negative = approaching.
double separation_velocity(const RigidContact& contact, std::span<const ContactBody> bodies);

// Denominator of Eq. 1: velocity along the normal caused by a unit impulse (1/kg).
double inverse_effective_mass(const RigidContact& contact, std::span<const ContactBody> bodies);

// Solves for the same contacts once or several times, between which only the bodies' motions change.
class ImpulseSolver {
  public:
    // Takes places and compliances of the contacts, and masses. `speed_scale`: of the scene (m/s), for the tolerance. In
    // the memory of what was prepared before.
    void prepare(std::span<const RigidContact> contacts, std::span<const ContactBody> bodies,
                 double speed_scale);

    // Sets each contact's impulse so that from the bodies' motions its separation velocity reaches at least its
    // target, exactly where it is held; brings the motions up to date.
    void solve(std::span<RigidContact> contacts, std::span<ContactBody> bodies);

  private:
    using Vec6 = Eigen::Matrix<double, 6, 1>;

    // A row in coordinates in which every body has unit mass and unit inertia: A_ij = sum of g_i . g_j.
    struct Row {
        std::size_t body;
        int other;
        Vec6 g, g_other;
        double own = 0.0;     // A_ii
        double give = 0.0;    // C_ii
        double lack = 0.0;    // target less separation velocity without impulses
        double wanted = 0.0;  // the same with the give of the impulses before
        bool held = false;
        bool active = false;
        bool settled = false;  // joined and left at once, or over and over: at its target but for rounding
        int joined = 0;        // how often, alone
        double impulse = 0.0;
        double before = 0.0;    // impulse whose give is in `wanted`
        double next = 0.0;      // what the active rows alone would take
        double residual = 0.0;  // working space
    };

    Vec6 in_unit_mass(const Wrench& wrench, std::size_t body) const;
    static double along(const Row& row, const Eigen::VectorXd& motion);
    static void push(const Row& row, double impulse, Eigen::VectorXd& motion);
    static double influence(const Row& i, const Row& j);
    double shortfall(const Row& row) const { return row.wanted - along(row, motion_); }
    void activate(std::size_t row);
    void find_impulses();
    void settle_active();
    void solve_active();
    void factorise();
    void add_solution(double Row::* impulses);
    void move_by(double Row::* impulses, Eigen::VectorXd& motion) const;

    // Of one body: r^2 = inverse mass, L L^T = inverse inertia.
    struct Root {
        double mass;
        Mat3 inertia;
        bool level;
    };

    double tolerance_ = 0.0;   // of velocities (m/s)
    std::vector<Root> roots_;  // (bodies)
    std::vector<Row> rows_;    // (contacts)
    std::vector<std::size_t> active_, kept_;
    bool by_bodies_ = false;   // are the factors those of the bodies' system, or of the rows'?
    bool factorised_ = false;  // are they those of the active rows?
    Eigen::LLT<Eigen::MatrixXd> factors_;
    Eigen::MatrixXd system_;
    Eigen::VectorXd motion_;  // (6 bodies) by the present impulses
    Eigen::VectorXd working_, unknown_;
};

// The same for contacts that are solved for once.
void solve_impulses(std::span<RigidContact> contacts, std::span<ContactBody> bodies, double speed_scale);

}  // namespace birm3d
