// Rigid contacts and joints solved together (paper Eq. 1 for many rows at once): tyres, bottomed-out trusses, bodies.
//
// Each row has a Jacobian J: force and torque of a unit impulse on each of its two bodies. With A = J M^-1 J^T
// and v the separation velocities without impulses, the impulses j and the separation velocities w obey
//   w = A j + v >= target,   j >= 0,   (w - target) . j = 0    for rows that push only,
// w = target for bilateral rows. For one contact this is Eq. 1 with target = -xi v:
//   j = -(1 + xi) v / (1/M_a + 1/M_b + n.[I_a^-1 (r_a x n) x r_a] + n.[I_b^-1 (r_b x n) x r_b]).
// (The paper's v_rel^-1 is v_rel^-, the velocity before the impact.)
//
// A small compliance C on the diagonal makes the impulses of redundant rows unique. The proximal-point method
// (Rockafellar, SIAM J. Control Optim. 14, 1976, p. 877) removes its effect: each iteration adds the compliance times the
// last impulses to the targets, (A + C) j_new + v >= target + C j_old. Targets that contradict each other are met as far
// as bodies of these compliances would meet them.
//
// Solved exactly by the active-set method of Lawson and Hanson (Solving Least Squares Problems, ch. 23). The most
// violated row is activated first, then all violated rows together for some rounds, then one by one again. Bilateral
// rows are always active. Many active rows are solved for through the bodies' velocity changes u:
//   (A + C) j = b   is   (M + J^T C^-1 J) u = J^T C^-1 b,   j = C^-1 (b - J u),
// so that a hundred points of one body cost a 6 x 6 system. A small C makes that system lose digits. Iterative
// refinement recovers them.
#pragma once

#include <Eigen/Cholesky>
#include <span>
#include <vector>

#include "birm3d/state/contacts.hpp"
#include "state/rigid_contact.hpp"

namespace birm3d {

enum class Freedom {
    all,
    planar,  // moves along the ground and rotates about the vertical only
    tilt,  // tilts about a fixed centre of rotation: no inverse mass, and equal inverse inertia about two axes only
};

// A body of the solver, world axes. Zero inverses: it can not be moved.
struct ContactBody {
    double inverse_mass = 0.0;
    Mat3 inverse_inertia = Mat3::Zero();
    Twist motion;
    Freedom freedom = Freedom::all;
};

// Adds what an impulse on a body changes to a motion of it.
inline void add_impulse(const ContactBody& body, const Wrench& impulse, Twist& motion) {
    Vec3 force = impulse.force;
    if (body.freedom == Freedom::planar) force.z() = 0.0;
    motion.velocity += body.inverse_mass * force;
    motion.angular_velocity += body.inverse_inertia * impulse.torque;
}

// Velocity of the contact's point along its normal, or turning about its axis, relative to the other body;
// negative = approaching.
double separation_velocity(const RigidContact& contact, std::span<const ContactBody> bodies);

// Denominator of Eq. 1: velocity along the normal caused by a unit impulse (1/kg).
double inverse_effective_mass(const RigidContact& contact, std::span<const ContactBody> bodies);

// Solves for the same contacts once or several times, between which only the bodies' motions change.
class ImpulseSolver {
  public:
    // Takes places and compliances of the contacts, and masses. `speed_scale`: of the scene (m/s), for the tolerance.
    // Reuses the memory of the last call.
    void prepare(std::span<const RigidContact> contacts, std::span<const ContactBody> bodies,
                 double speed_scale);

    // Sets each contact's impulse so that its separation velocity is at least its target, and equal to it for
    // bilateral rows. Updates the bodies' motions. Leaves out rows that slide: the motions have their impulses.
    void solve(std::span<RigidContact> contacts, std::span<ContactBody> bodies);

  private:
    using Vec6 = Eigen::Matrix<double, 6, 1>;

    // A row in coordinates in which every body has unit mass and unit inertia: A_ij = sum of g_i . g_j.
    struct ConstraintRow {
        std::size_t body;
        int other;
        Vec6 g, g_other;
        double diagonal = 0.0;     // A_ii
        double compliance = 0.0;   // C_ii
        double rhs = 0.0;          // target less separation velocity without impulses
        double shifted_rhs = 0.0;  // right-hand side of the proximal-point step: rhs + C j_old
        bool bilateral = false;
        bool slides = false;  // its impulse is known: the joint slides
        bool active = false;
        bool settled = false;  // became inactive at once, or repeatedly: at its target to rounding
        int joined = 0;        // how often activated alone
        double impulse = 0.0;
        double before = 0.0;    // impulse of the last proximal-point step, j_old
        double next = 0.0;      // solution for the active rows
        double residual = 0.0;  // working space
    };

    Vec6 in_unit_mass(const Wrench& wrench, std::size_t body) const;
    static double along(const ConstraintRow& row, const Eigen::VectorXd& motion);
    static void push(const ConstraintRow& row, double impulse, Eigen::VectorXd& motion);
    static double influence(const ConstraintRow& i, const ConstraintRow& j);
    double shortfall(const ConstraintRow& row) const { return row.shifted_rhs - along(row, motion_); }
    void activate(std::size_t row);
    void find_impulses();
    void settle_active();
    void settle_together();
    void solve_active();
    void factorise();
    void add_solution(double ConstraintRow::* impulses);
    void move_by(double ConstraintRow::* impulses, Eigen::VectorXd& motion) const;

    // Of one body: r^2 = inverse mass, L L^T = inverse inertia.
    struct Root {
        double mass;
        Mat3 inertia;
        bool planar;
    };

    double tolerance_ = 0.0;           // of velocities (m/s)
    std::vector<Root> roots_;          // (bodies)
    std::vector<ConstraintRow> rows_;  // (contacts)
    std::vector<std::size_t> active_, kept_, joined_;
    bool by_bodies_ = false;   // are the factors those of the bodies' system, or of the rows'?
    bool factorised_ = false;  // are they those of the active rows?
    // Of some matrix at first: without one, its status is not set, and must not be copied.
    Eigen::LLT<Eigen::MatrixXd> factors_{Eigen::MatrixXd::Identity(1, 1)};
    Eigen::MatrixXd system_;
    Eigen::VectorXd motion_;  // (6 bodies) by the present impulses
    Eigen::VectorXd working_, unknown_;
};

// The same for contacts that are solved for once.
void solve_impulses(std::span<RigidContact> contacts, std::span<ContactBody> bodies, double speed_scale);

}  // namespace birm3d
