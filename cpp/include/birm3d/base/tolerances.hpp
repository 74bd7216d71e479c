// Tolerances of the core: unit, value, and what breaks when it is changed. Those that mean nothing beyond one file stand there.
#pragma once

namespace birm3d::tolerance {

// Approach speed below which a rigid contact does not rebound (m/s). Zero: a parked car vibrates, because gravity
// gives every resting tyre a small approach speed in each step. Large: light rebounds are lost.
inline constexpr double restitution_speed = 0.1;

// Compliance of each tyre, as a share of the inverse mass of its unit. Tyres on a plane then share the load as equal
// springs would; without compliance the problem has no unique solution. Large: tyres sink by a visible amount.
inline constexpr double tire_compliance = 1e-3;

// The least of any rigid contact, as a share of its own inverse effective mass: at the barrier the number of
// touching points is large, and only the resulting wrench matters. Zero: the matrix of coinciding points is singular.
inline constexpr double body_compliance = 1e-9;

// Velocity by which a solved rigid contact may still approach, relative to the scene's speed.
inline constexpr double contact_velocity = 1e-11;

// The stepping scheme is stable for an oscillator of angular frequency omega up to this over omega: the
// square root of 3, where its fastest root passes -1.
inline constexpr double critical_phase = 1.7320508;

// Share of the critical step that adaptive stepping uses at the most. 1: the edge of stability.
inline constexpr double stable_fraction = 0.65;

// Share of the critical step that is advised for fixed steps. Larger: stable, but steps pass over peaks and velocity
// reversals.
inline constexpr double advised_fraction = 0.25;

// Where the rigid body met the barrier in a fixed step, the trusses are checked in trial steps. These are halved down to this part
// of the step: ten of them. Large: a truss that is loaded shortly before the impact is not seen. Small: more trial steps.
inline constexpr double shortest_trial_part = 1e-3;

// Longest and shortest adaptive step (s). Above the longest, too few loads are known to estimate an error. A scene
// that needs steps below the shortest is refused.
inline constexpr double longest_step = 50e-3;
inline constexpr double shortest_step = 1e-9;

// Longest step at the default tolerance while tyres or bottomed-out trusses carry load, or with joints or
// free-standing segments (s). Large: a slow landing is spread over a long time.
inline constexpr double longest_resting_step = 5e-3;

// A step grows by the sixth root of allowed over estimated error. Far below the allowed error it grows by the third root
// of that ratio over the first number, and at most by the second one. Small: the step length oscillates.
inline constexpr double ample_room = 16.0;
inline constexpr double fastest_growth = 10.0;

// Part of the energy at disposal by which the energy of crush may fall within a step. A run of a dozen such steps stays
// below the fall of which it warns.
inline constexpr double greatest_fall = 3e-4;

// The instant at which a load jumps is located to within this (s). Half of the jump is missed over that time.
inline constexpr double jump_resolution = 1e-8;

// The instant at which a vehicle leaves a barrier is located to within this, see release_resolution() (s). The end of
// the run and all values taken there depend on it.
inline constexpr double release_resolution = 1e-4;

// A step ends where a sliding segment comes to rest, unless that is within this time (s). A segment that pins hold
// back slows down ever more gradually. At full friction the distance missed is 5e-8 m.
inline constexpr double shortest_stop = 1e-4;

// First step of a contact (s); the error estimate corrects it at once.
inline constexpr double first_contact_step = 2e-4;

// Without contact, a node that moves along a surface goes at most this far in a step (m): another surface may lie
// beyond. Small: steps beside a wall are short. Large: more steps are rejected.
inline constexpr double untouched_distance = 0.05;

// Local velocity error allowed in one step, relative to the reference speed and per unit of Settings::tolerance.
// Larger: the error of the metrics exceeds the tolerance that was asked for.
inline constexpr double step_error_per_tolerance = 0.01;

// Shortest time over which a divided difference of the load is taken, as a fraction of the step before. Over shorter
// times, as in the steps up to an impact, the difference shows single nodes only and predicts nothing.
inline constexpr double min_informative_step = 0.05;

// The load is smooth if its second difference changes within a step by less than this fraction of itself; then the
// scheme uses its fourth-order terms. Zero: third order throughout. Large: corners of the load are extrapolated.
inline constexpr double smooth_change = 0.6;

// Speed scale of a scene that starts at rest (m/s): errors are judged against it.
inline constexpr double slowest_reference_speed = 0.1;

// Sliding speed at which friction is fully developed, relative to the reference speed. Smaller: sticking is stiff and
// steps are short. Larger: bodies that should stick creep at up to this speed.
inline constexpr double full_friction_speed = 0.01;

// Above this many times the speed of full friction, the friction force is taken as constant within a step.
inline constexpr double fast_sliding = 10.0;

// Mass of the ground relative to the vehicle, where friction and motion are solved together. Large: rounding errors.
// Small: friction seems to lift a wheel that it only presses down.
inline constexpr double ground_mass_ratio = 1e3;

// Friction and normal impulses of rigid contacts are iterated until these change by less than this fraction of their
// sum. Large: rounding decides the number of iterations, and mirrored scenes give different results.
inline constexpr double friction_settled = 1e-9;

// Points nearer than this to a rigid surface count as touching it (m).
inline constexpr double touching_gap = 1e-6;

// A node that was nearer than this to a surface at the start of the step was on it (m). A node follows a curved surface by
// chords: one of length s leaves a gap of s^2 / (8 r), which is 1e-4 m for 9 mm and a radius of 0.1 m. Large: nodes that are
// still arriving count as sliding nodes.
inline constexpr double on_surface = 1e-4;

// Size of the gap of a node that already stands on a face (m). Only the sign has a meaning: positive, the node leaves; negative,
// the face drives it. It is far below the rounding of any position, so that it moves no node.
inline constexpr double negligible_gap = 1e-30;

// Cosine of the angle between the normals of two instants above which they are of the same face: 26 degrees. Small: the two
// sloped faces of a Jersey barrier, 29 degrees apart, count as one. Large: an obstacle that rotates within a step seems to
// show another face.
inline constexpr double same_face = 0.9;

// In a rigid impact, all points nearer to a surface than this take part (m). Otherwise rounding would decide which of
// two wheels lands first. Large: points that are still in the air are stopped.
inline constexpr double joint_impact_gap = 1e-3;

// A point that the forces of a step press onto a surface within this fraction of the step rests there without an
// impact.
inline constexpr double resting_approach = 0.01;

// The two places of a joint, one on each body, may differ by this much at rest (m): files are rounded.
inline constexpr double joint_fit = 1e-3;

// Gap of a joint at the end of a step below which its impulses are not corrected any more (m, rad): rounding.
inline constexpr double joint_gap = 1e-12;

// After the vehicle has left the barrier for good the run goes on for this long (s), so that filtered
// histories settle.
inline constexpr double tail_duration = 0.02;

// Cosine of the angle between the up axis and the vertical below which a vehicle does not stand upright any more: 46 degrees,
// halfway to its side. Large: a roll from which the vehicle comes back counts as tipping over.
inline constexpr double upright_cosine = 0.7;

// A run goes on while any wheel is higher than this above the ground and rises (m): roll and pitch may still grow.
// Small: every small hop after an impact makes the run longer.
inline constexpr double lifted_wheel = 0.1;

// It also goes on while the vehicle tilts further at more than this rate (rad/s). Small: swings on springs that die away make
// the run longer. Large: the greatest pitch is cut off.
inline constexpr double tilting_rate = 0.2;

// Below this sine of its angle a path runs along the barrier's line.
inline constexpr double along_line = 1e-9;

// A vehicle that has been slow for so long rests (s), though skin that is wedged at the barrier stores energy. Small: a vehicle
// that turns back is slow for an instant only.
inline constexpr double rest_duration = 0.25;

// A vehicle slower than this share of its approach speed is stopped, not redirected.
inline constexpr double stopped_share = 0.1;

// A vehicle that is slower than this coasts on its wheels, and counts as at rest (m/s). Ratings use it, too. Large: a vehicle
// that rolls past the end of a barrier is stopped. Small: runs end late.
inline constexpr double coasting_speed = 0.25;

// A vehicle that was turned back is clear of the barrier beyond this many times its own reach. Where it rolls then is no matter
// of the barrier. Large: unbraked cars that roll in a wide circle have passed.
inline constexpr double clear_of_barrier = 2.0;

// What moves at less than this angle to the line has neither been turned back nor is it sure to pass: sine of 6 degrees. Large:
// the path of what rebounds along the barrier is followed on. Small: a vehicle whose tyres turn it in again is held.
inline constexpr double nearly_along = 0.1;

// The instant at which the outcome of a run is decided is found to within this (s).
inline constexpr double decision_resolution = 1e-6;

// A run without a duration ends here at the latest (s). A vehicle that is undecided by then and rolls on free of the barrier is
// followed. That ends once it has passed or coasts, at the latest at the second time.
inline constexpr double longest_event = 5.0, longest_rolling = 30.0;

// Segments abut whose ends are this near to each other (m): rounding of their places.
inline constexpr double abutting = 1e-6;

// A vehicle may start this far inside a surface (m): rounding of the initial placement only.
inline constexpr double initial_overlap = 1e-9;

// Smallest length of a truss and smallest volume of a solid that are not degenerate (m, m^3).
inline constexpr double truss_length = 1e-6;
inline constexpr double solid_volume = 1e-12;

// Rounding that an inertia tensor may show, relative: of its symmetry, and of the rule that no principal
// moment is above the sum of the other two.
inline constexpr double symmetric_inertia = 1e-9;

// Solids that stick out of a plane by less than this lie behind it (m): rounding.
inline constexpr double behind_plane = 1e-9;

// Points nearer than this to an edge or a corner of a shape take the normal of one of its faces (m): the
// direction from the edge to such a point is rounding. Large: the corner's normal jumps by a visible amount.
inline constexpr double edge_radius = 1e-12;

// Squares of lengths below this have lost their digits to underflow (m^2).
inline constexpr double least_square = 1e-280;

// A point and the edges of a triangle span three areas. It lies within the triangle if they exceed the triangle's
// area by no more than this share (paper Eq. 15). Zero: points on an internal edge belong to neither of its
// triangles.
inline constexpr double triangle_area = 1e-9;

// Neighbouring triangles belong to one flat face if all corners lie this near to its plane, relative to the
// size of the mesh. Large: a curved surface is taken as flat. Zero: rounding splits flat faces.
inline constexpr double flat_face = 1e-10;

// Height of a triangle above its longest edge, relative to that edge, below which it has no normal.
inline constexpr double triangle_height = 1e-9;

// Most rows of a history: about two gigabytes.
inline constexpr double most_rows = 2e6;

}  // namespace birm3d::tolerance
