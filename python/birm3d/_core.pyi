"""
The BIRM3D core: SI units, angles in radians. Use the birm3d package, which wraps it.
"""
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
__all__: list[str] = ['Approach', 'Balances', 'Barrier', 'BusyError', 'ContactModel', 'Departure', 'Element', 'EndReason', 'Event', 'ExtremeAttitude', 'ExtremeElementLoads', 'ExtremeEnergy', 'ExtremeFilteredForce', 'ExtremeGroups', 'ExtremeJointLoads', 'ExtremeMotion', 'ExtremeNormalForce', 'ExtremeSegments', 'Extremes', 'FreeStanding', 'History', 'Joint', 'JointHistory', 'JointKind', 'MassProperties', 'ObstacleHistory', 'Outcome', 'Run', 'Runner', 'Scene', 'Segment', 'SegmentJoint', 'Settings', 'Simulation', 'Snapshot', 'StepStatistics', 'Stop', 'TireModel', 'TrussCurve', 'TrussMesh', 'Unit', 'UnitHistory', 'UnstableError', 'Vehicle', 'YieldingPosts', 'along_line', 'coasting_speed', 'collide', 'from_roll_pitch_yaw', 'knee_curve', 'mass_properties', 'point_curve', 'roll_pitch_yaw', 'solid_volumes', 'tail_duration', 'tumble']
class Approach:
    """
    How the vehicle comes (SI, rad). Immutable.
    """
    def __init__(self, *, speed: typing.SupportsFloat | typing.SupportsIndex, angle: typing.SupportsFloat | typing.SupportsIndex, offset: typing.SupportsFloat | typing.SupportsIndex, standoff: typing.SupportsFloat | typing.SupportsIndex, yaw: typing.SupportsFloat | typing.SupportsIndex, roll: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
class Balances:
    """
    How far the balances of energy and momentum are from closing.
    """
    @property
    def at_disposal(self) -> float:
        """
        J, kinetic at the start and the most that the weight has done
        """
    @property
    def energy(self) -> Departure:
        """
        departure of the sum of all energies from that at the start
        """
    @property
    def falls(self) -> dict[str, Departure]:
        """
        by name, the greatest fall of each dissipated energy below its highest value so far
        """
    @property
    def kinetic(self) -> float:
        """
        J, kinetic energy at the start
        """
    @property
    def largest_momentum(self) -> float:
        """
        N s, largest momentum of a unit, or impulse in a step
        """
    @property
    def momentum(self) -> Departure:
        """
        departure of a unit's change of momentum in a step from the sum of all impulses on it
        """
    @property
    def sizes(self) -> tuple[float, float, float, float, float]:
        """
        sizes of energy and momentum, the largest fall of any dissipated term (J), at_disposal, largest_momentum
        """
class Barrier:
    """
    Elements that stand on the ground. Immutable.
    """
    def __init__(self, *, elements: collections.abc.Sequence[Element], friction: typing.SupportsFloat | typing.SupportsIndex, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], heading: typing.SupportsFloat | typing.SupportsIndex, free_standing: collections.abc.Sequence[FreeStanding], yielding: collections.abc.Sequence[YieldingPosts] = []) -> None:
        """
        friction: Coulomb coefficient; origin (3,) m on the barrier's line; heading of it about z, rad; free_standing, yielding: one, or none where the elements do not slide, or do not yield.
        """
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) of the barrier's line, towards the traffic, world axes
        """
    @property
    def segments(self) -> list[Segment]:
        """
        The elements where they are free-standing, else none.
        """
    @property
    def top(self) -> float:
        """
        greatest height above the ground (m); infinite for half-spaces and endless posts
        """
    @property
    def yielding_posts(self) -> list[Segment]:
        """
        The elements where they are posts that yield, else none.
        """
class BusyError(RuntimeError):
    """
    Another thread uses the simulation.
    """
class ContactModel:
    """
    Direction of a truss's force on the vehicle.
    
    Members:
    
      projected : along the surface's normal, by projection
    
      along_truss : along the truss: the paper's rule
    """
    __members__: typing.ClassVar[dict[str, ContactModel]]  # value = {'projected': <ContactModel.projected: 0>, 'along_truss': <ContactModel.along_truss: 1>}
    along_truss: typing.ClassVar[ContactModel]  # value = <ContactModel.along_truss: 1>
    projected: typing.ClassVar[ContactModel]  # value = <ContactModel.projected: 0>
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __int__(self) -> int:
        ...
    def __ne__(self, other: typing.Any) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class Departure:
    """
    The greatest departure of a balance so far, when and where.
    """
    @property
    def place(self) -> tuple[float, float, float]:
        """
        m, mass centre of unit 0 then, world
        """
    @property
    def size(self) -> float:
        """
        J of energy, N s of momentum
        """
    @property
    def time(self) -> float:
        """
        s, end of the step in which it was greatest
        """
class Element:
    """
    A piece of a barrier: own axes at position, turned by heading (rad).
    """
    @staticmethod
    def mesh(*, vertices: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], faces: collections.abc.Sequence[typing.Annotated[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"]], position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], heading: typing.SupportsFloat | typing.SupportsIndex) -> Element:
        """
        vertices (n, 3) m, faces (m, 3), counter-clockwise seen from outside.
        """
    @staticmethod
    def plane(*, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], heading: typing.SupportsFloat | typing.SupportsIndex) -> Element:
        """
        A flat face without end; at heading 0 it looks to -x.
        """
    @staticmethod
    def post(*, radius: typing.SupportsFloat | typing.SupportsIndex, height: typing.SupportsFloat | typing.SupportsIndex, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], heading: typing.SupportsFloat | typing.SupportsIndex, part_of: typing.SupportsInt | typing.SupportsIndex | None = None, opens: typing.SupportsFloat | typing.SupportsIndex | None = None) -> Element:
        """
        Upright and round, foot of the axis at position; m. part_of: index of the element whose loads its own are added to. opens: of the edge of a wall, direction of the open space about it (rad).
        """
    @staticmethod
    def prism(*, profile: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], y_low: typing.SupportsFloat | typing.SupportsIndex, y_high: typing.SupportsFloat | typing.SupportsIndex, covered_low_end: bool, covered_high_end: bool, position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], heading: typing.SupportsFloat | typing.SupportsIndex, part_of: typing.SupportsInt | typing.SupportsIndex | None = None, upright: bool = False, draws_in_above: bool = False) -> Element:
        """
        profile: (n, 2) x and z of the corners (m), drawn along y from y_low to y_high; covered ends are no surface. part_of: as of a post. upright: own y points up, own z to lower y. draws_in_above: the skin above its vertical face towards -x is drawn in.
        """
    @property
    def part_of(self) -> int | None:
        """
        index of the element that it is a part of, or None
        """
class EndReason:
    """
    Why a run ended.
    
    Members:
    
      running : it has not ended
    
      duration : the time that was asked for is over
    
      separated : the vehicle has left the barrier for good
    
      stopped : the vehicle rests
    
      sliding : it slides along a straight barrier, and nothing changes any more
    
      longest : the longest run is over, with an open outcome
    """
    __members__: typing.ClassVar[dict[str, EndReason]]  # value = {'running': <EndReason.running: 0>, 'duration': <EndReason.duration: 1>, 'separated': <EndReason.separated: 2>, 'stopped': <EndReason.stopped: 3>, 'sliding': <EndReason.sliding: 4>, 'longest': <EndReason.longest: 5>}
    duration: typing.ClassVar[EndReason]  # value = <EndReason.duration: 1>
    longest: typing.ClassVar[EndReason]  # value = <EndReason.longest: 5>
    running: typing.ClassVar[EndReason]  # value = <EndReason.running: 0>
    separated: typing.ClassVar[EndReason]  # value = <EndReason.separated: 2>
    sliding: typing.ClassVar[EndReason]  # value = <EndReason.sliding: 4>
    stopped: typing.ClassVar[EndReason]  # value = <EndReason.stopped: 3>
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __int__(self) -> int:
        ...
    def __ne__(self, other: typing.Any) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class Event:
    """
    What became of the vehicle at the barrier. Immutable.
    """
    @property
    def exit_deflection(self) -> float | None:
        """
        m, greatest deflection of all trusses when it had left, less their springback
        """
    @property
    def exit_velocity(self) -> tuple[float, float, float] | None:
        """
        m/s, velocity of unit 0 at the separation, world; None where there was none
        """
    @property
    def later_contacts(self) -> int:
        """
        contacts with the barrier that began after it had left
        """
    @property
    def manner(self) -> str:
        """
        how it came to that
        """
    @property
    def outcome(self) -> str:
        """
        undecided, stopped, redirected, passed, overridden or rolled_over
        """
    @property
    def rolled_over(self) -> bool:
        """
        did a vehicle that stood upright ever have an up axis beyond the horizontal?
        """
    @property
    def time_of_separation(self) -> float | None:
        """
        s: the last loss of contact before the vehicle had left for good; None where it had not
        """
    @property
    def touching(self) -> bool:
        """
        does the vehicle touch the barrier now?
        """
class ExtremeAttitude:
    """
    Greatest magnitudes of the angles of unit 0, counted on beyond half a turn.
    """
    @property
    def pitch(self) -> float:
        """
        rad, greatest magnitude of the pitch
        """
    @property
    def roll(self) -> float:
        """
        rad, greatest magnitude of the roll
        """
    @property
    def yaw(self) -> float:
        """
        rad, greatest magnitude of the yaw since the start, until separation
        """
class ExtremeElementLoads:
    """
    Greatest loads on any element of the barrier; moments about its foot, of walls about their lines.
    """
    @property
    def force(self) -> float:
        """
        N, greatest force
        """
    @property
    def force_50ms(self) -> float:
        """
        N, greatest mean over 50 ms
        """
    @property
    def moment(self) -> float:
        """
        N m, greatest moment
        """
    @property
    def moment_50ms(self) -> float:
        """
        N m, greatest mean over 50 ms
        """
class ExtremeEnergy:
    """
    How well the energy balance of the run closes.
    """
    @property
    def residual(self) -> float:
        """
        J, greatest departure of the sum of all energies from that at the start
        """
    @property
    def start(self) -> float:
        """
        J, kinetic energy at the start
        """
class ExtremeFilteredForce:
    """
    Force of the barrier on all units along its normal, filtered.
    """
    @property
    def cfc60(self) -> float | None:
        """
        N, greatest with CFC 60; None where the rows are too far apart for the filter
        """
    @property
    def mean_50ms(self) -> float:
        """
        N, greatest mean over 50 ms
        """
class ExtremeGroups:
    """
    Which groups of extremes are wanted.
    """
    def __init__(self, *, normal_force: bool = False, motion: bool = False, attitude: bool = False, energy: bool = False, filtered_force: bool = False, filtered_deceleration: bool = False, penetration: bool = False, wheel_climb: bool = False, element_loads: bool = False, momentum: bool = False, joint: bool = False, segments: bool = False) -> None:
        ...
class ExtremeJointLoads:
    """
    Articulation and force of the first joint.
    """
    @property
    def angle(self) -> float:
        """
        rad, greatest magnitude of the articulation
        """
    @property
    def force_50ms(self) -> float:
        """
        N, greatest mean over 50 ms of the force on the leading unit
        """
    @property
    def slip(self) -> float:
        """
        m, greatest slip of a sliding joint
        """
class ExtremeMotion:
    """
    Greatest speeds and displacements of unit 0.
    """
    @property
    def approach_speed(self) -> float:
        """
        m/s, speed towards the barrier at the start
        """
    @property
    def deceleration(self) -> float:
        """
        m/s^2, greatest mean of any interval along r, body axes
        """
    @property
    def reversal_time(self) -> float | None:
        """
        s, when that speed has come down to zero; None where it never has
        """
    @property
    def towards(self) -> tuple[float, float, float]:
        """
        unit vector towards the barrier, world; of a path along its line that of the path
        """
    @property
    def travel(self) -> float:
        """
        m, greatest displacement towards the barrier
        """
    @property
    def velocity_change(self) -> float:
        """
        m/s, greatest magnitude of the change since the start
        """
class ExtremeNormalForce:
    """
    Force of the barrier on all units along its normal, as means over the output intervals.
    """
    @property
    def last(self) -> float:
        """
        N, the mean of the last interval
        """
    @property
    def peak(self) -> float:
        """
        N, the greatest mean of any interval
        """
class ExtremeSegments:
    """
    How far the elements of a barrier move.
    """
    @property
    def deflection(self) -> float:
        """
        m, of the furthest corner of any base, square to the line, away from the traffic
        """
    @property
    def overturning(self) -> float:
        """
        m/s^2, overturning moment over mass and half the base, 50-ms means
        """
    @property
    def residual_deflection(self) -> float:
        """
        m, the same at the end
        """
    @property
    def residual_tilt(self) -> float:
        """
        rad, the same at the end
        """
    @property
    def tilt(self) -> float:
        """
        rad, greatest tilt of any post that yields
        """
class Extremes:
    """
    Extremes of a history over its output instants; a group that was not wanted raises.
    """
    @property
    def attitude(self) -> ExtremeAttitude:
        """
        rad, greatest roll, pitch and yaw of unit 0
        """
    @property
    def element_loads(self) -> ExtremeElementLoads:
        """
        N and N m, greatest loads on any element of the barrier
        """
    @property
    def end_time(self) -> float:
        """
        s, the last output instant
        """
    @property
    def energy(self) -> ExtremeEnergy:
        """
        J, kinetic energy at the start and the residual of the balance
        """
    @property
    def filtered_deceleration(self) -> float | None:
        """
        m/s^2, along r, CFC 60; None where the rows are too far apart for the filter
        """
    @property
    def filtered_force(self) -> ExtremeFilteredForce:
        """
        N, of the barrier on all units along its normal, filtered
        """
    @property
    def groups(self) -> dict[str, typing.Any]:
        """
        by name, the groups of several numbers that were found
        """
    @property
    def joint(self) -> ExtremeJointLoads:
        """
        rad and N, articulation and force of the first joint
        """
    @property
    def momentum_residual(self) -> float:
        """
        max |m a - sum of forces| / max |force|
        """
    @property
    def motion(self) -> ExtremeMotion:
        """
        speeds and displacements of unit 0 towards the barrier (SI)
        """
    @property
    def normal_force(self) -> ExtremeNormalForce:
        """
        N, of the barrier on all units along its normal
        """
    @property
    def penetration(self) -> float:
        """
        m, greatest distance of an anchor past the barrier's line, at least 0
        """
    @property
    def rows(self) -> int:
        """
        number of output instants
        """
    @property
    def segments(self) -> ExtremeSegments:
        """
        m and m/s^2, movement of free-standing segments or of posts that yield
        """
    @property
    def wheel_climb(self) -> float:
        """
        m, greatest height of any wheel's lowest point, at least 0
        """
class FreeStanding:
    """
    Segments that slide on the ground.
    """
    def __init__(self, *, density: typing.SupportsFloat | typing.SupportsIndex, ground_friction: typing.SupportsFloat | typing.SupportsIndex, joint: SegmentJoint) -> None:
        """
        density: kg/m^3; ground_friction: Coulomb coefficient.
        """
class History:
    """
    Evenly spaced output of a run; read-only views.
    """
    def extremes(self, wanted: ExtremeGroups, event: Event, vehicle: Vehicle, barriers: collections.abc.Sequence[Barrier]) -> Extremes:
        """
        Extremes of a run of this vehicle into this barrier, or into none.
        """
    def joint(self, index: typing.SupportsInt | typing.SupportsIndex) -> JointHistory:
        """
        What one joint of the vehicle carries.
        """
    def unit(self, index: typing.SupportsInt | typing.SupportsIndex) -> UnitHistory:
        """
        Motion of one unit of the vehicle and the forces on it.
        """
    @property
    def barrier_friction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost to friction on the barrier
        """
    @property
    def barrier_ground_friction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost to friction of free-standing segments on the ground
        """
    @property
    def crushed(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, plastic work in trusses
        """
    @property
    def dampers(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost in the dampers of wheels
        """
    @property
    def elements(self) -> list[ObstacleHistory]:
        """
        Loads on the elements of the barrier that were touched, in their order.
        """
    @property
    def ground_friction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost to friction of the skin on the ground
        """
    @property
    def impacts(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost in rigid contacts
        """
    @property
    def joints(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, that joints took: zero but for the error of the steps
        """
    @property
    def kinetic(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, kinetic energy of all bodies
        """
    @property
    def momentum_residual(self) -> float:
        """
        max |m a - sum of forces| / max |force|
        """
    @property
    def post_axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, k, 3) unit vectors along posts that yield, upwards, world; k = 0 where none does
        """
    @property
    def potential(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, of the weight, zero at the start
        """
    @property
    def segment_position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, k, 2) m, foot of the axis of each free-standing segment, world
        """
    @property
    def segment_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, k, 2) m/s, mass centre of each segment, world
        """
    @property
    def segment_yaw(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, k) rad, yaw of each segment since the start
        """
    @property
    def segment_yaw_rate(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, k) rad/s, yaw rate of each segment
        """
    @property
    def sliding(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost where a unit slides on another one
        """
    @property
    def springs(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, in the springs of wheels, less that at rest
        """
    @property
    def stored(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, elastic energy in trusses
        """
    @property
    def time(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) s, output instants
        """
    @property
    def tire_friction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, lost to friction of tyres on the ground
        """
    @property
    def yielding(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) J, plastic work of posts that yield
        """
class Joint:
    """
    Two units joined at a point. Immutable.
    """
    def __init__(self, *, kind: JointKind, leading: typing.SupportsInt | typing.SupportsIndex, trailing: typing.SupportsInt | typing.SupportsIndex, place_on_leading: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], place_on_trailing: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], roll_limit: typing.SupportsFloat | typing.SupportsIndex, slide: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        """
        leading, trailing: numbers of the units; places (3,) m, body axes of each; roll_limit rad; slide (n, 2): force (N) that a sliding joint holds against slip (m), rows of (slip, force).
        """
class JointHistory:
    """
    What a joint carries, and the angles between its units.
    """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N on the leading unit, interval means, world
        """
    @property
    def moment(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N m on the leading unit about the joint, world
        """
    @property
    def roll_pitch_yaw(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) rad, of the trailing unit from the leading one
        """
    @property
    def slip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) m, how far the trailing unit has slid forwards on the leading one
        """
class JointKind:
    """
    What a joint between two units holds.
    
    Members:
    
      fifth_wheel : a point of both, and the roll beyond its limit
    
      welded : a point of both and the whole orientation
    
      sliding : as welded, but the trailing unit slides lengthwise beyond a force
    """
    __members__: typing.ClassVar[dict[str, JointKind]]  # value = {'fifth_wheel': <JointKind.fifth_wheel: 0>, 'welded': <JointKind.welded: 1>, 'sliding': <JointKind.sliding: 2>}
    fifth_wheel: typing.ClassVar[JointKind]  # value = <JointKind.fifth_wheel: 0>
    sliding: typing.ClassVar[JointKind]  # value = <JointKind.sliding: 2>
    welded: typing.ClassVar[JointKind]  # value = <JointKind.welded: 1>
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __int__(self) -> int:
        ...
    def __ne__(self, other: typing.Any) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class MassProperties:
    """
    Mass, mass centre and inertia about it (paper Eq. 2-7).
    """
    @property
    def center_of_mass(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) m
        """
    @property
    def inertia(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3, 3) kg m^2
        """
    @property
    def mass(self) -> float:
        """
        kg
        """
class ObstacleHistory:
    """
    What an element of the barrier feels.
    """
    @property
    def element(self) -> int:
        """
        place among the barrier's elements
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N, interval means, world
        """
    @property
    def moment(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N m about the element's foot, interval means, world
        """
class Outcome:
    """
    What a run came to (SI).
    """
    @property
    def balances(self) -> Balances:
        """
        J and N s, departures of the energy and momentum balances
        """
    @property
    def deflection(self) -> float:
        """
        m, greatest deflection of the skin at the end
        """
    @property
    def end_reason(self) -> EndReason:
        """
        why the run ended
        """
    @property
    def event(self) -> Event:
        """
        what became of the vehicle at the barrier
        """
    @property
    def extremes(self) -> Extremes:
        """
        the groups of extremes that were wanted, over the output instants
        """
    @property
    def final_velocity(self) -> tuple[float, float, float]:
        """
        m/s, velocity of unit 0 at the end, world
        """
    @property
    def peak_deflection(self) -> float:
        """
        m, greatest deflection of the skin during the run
        """
    @property
    def run_time(self) -> float:
        """
        s, wall time of the stepping
        """
    @property
    def state_hash(self) -> int:
        """
        hash of all bits of the state at the end
        """
    @property
    def statistics(self) -> StepStatistics:
        """
        counts and lengths of the steps
        """
class Run:
    """
    A run that is over.
    """
    def outcome(self) -> Outcome:
        """
        What it came to; raises what went wrong.
        """
class Runner:
    """
    Runs one after the other in the same memory, of which no histories are kept.
    """
    def __init__(self) -> None:
        ...
    def run(self, jobs: collections.abc.Sequence[tuple[Scene, Approach]], wanted: ExtremeGroups, stop: Stop) -> list[Run]:
        """
        Run scenes from their starts, each with an approach of its own. Returns those that
        were run before `stop` was set.
        """
class Scene:
    """
    What a run is about (SI, rad): checked, but for its start. Immutable.
    """
    def __init__(self, *, vehicle: Vehicle, barriers: collections.abc.Sequence[Barrier], approach: Approach, settings: Settings, duration: typing.SupportsFloat | typing.SupportsIndex | None) -> None:
        ...
class Segment:
    """
    A free-standing segment of a barrier, or a post that yields.
    """
    @property
    def half_base(self) -> float:
        """
        m
        """
    @property
    def half_length(self) -> float:
        """
        m
        """
    @property
    def mass(self) -> float:
        """
        kg
        """
    @property
    def mass_center_height(self) -> float:
        """
        m
        """
    @property
    def plastic_moment(self) -> float:
        """
        N m, of a post that yields; else infinite
        """
    @property
    def yaw_inertia(self) -> float:
        """
        kg m^2, about the vertical through the mass centre
        """
class SegmentJoint:
    """
    What holds neighbouring free-standing segments together.
    
    Members:
    
      pinned : a pin at the middle of their ends; they turn freely about it
    
      loose : nothing
    """
    __members__: typing.ClassVar[dict[str, SegmentJoint]]  # value = {'pinned': <SegmentJoint.pinned: 0>, 'loose': <SegmentJoint.loose: 1>}
    loose: typing.ClassVar[SegmentJoint]  # value = <SegmentJoint.loose: 1>
    pinned: typing.ClassVar[SegmentJoint]  # value = <SegmentJoint.pinned: 0>
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __int__(self) -> int:
        ...
    def __ne__(self, other: typing.Any) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class Settings:
    """
    How a scene is computed (SI). Immutable.
    """
    @typing.overload
    def __init__(self, values: dict[str, typing.Any]) -> None:
        """
        What is not among the values has the default of a car.
        """
    @typing.overload
    def __init__(self, values: dict[str, typing.Any], vehicle: Vehicle, barriers: collections.abc.Sequence[Barrier]) -> None:
        """
        What is not among the values is the vehicle's. barriers: one or none, as of a Scene.
        """
    @property
    def cornering_stiffness(self) -> float:
        """
        1/rad
        """
    @property
    def edge_flank_factor(self) -> float:
        """
        pure number
        """
    @property
    def mu_tire_barrier(self) -> float:
        """
        friction coefficient
        """
class Simulation:
    """
    A run of one scene (SI, rad). One user at a time: any other gets a BusyError. `with simulation:` keeps others out
    between several calls.
    """
    def __enter__(self) -> None:
        ...
    def __exit__(self, arg0: typing.Any, arg1: typing.Any, arg2: typing.Any) -> None:
        ...
    def __init__(self, scene: Scene) -> None:
        ...
    def deflection(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) m: truss deflections now
        """
    def history(self) -> History:
        """
        Evenly spaced output so far.
        """
    def nodes(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) m: shell nodes now, body axes
        """
    def peak_deflection(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) m: greatest truss deflections so far
        """
    def pose(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Now: mass centre, (3,) m, world; rotation from body axes to the world's, (3, 3)
        """
    def reset(self) -> None:
        """
        Go back to the start of the scene.
        """
    def restore(self, snapshot: Snapshot) -> None:
        """
        Go back to a snapshot of the same scene.
        """
    def run(self, tick: collections.abc.Callable[[typing.SupportsFloat | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex], None] | None = None) -> None:
        """
        From the present state to the end; Ctrl-C stops it. `tick` is called now and then with the time (s) and the number of steps.
        """
    def skin_load(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], float]:
        """
        Now: force of all that nodes push on, without friction, (3,) N, world; friction, (3,) N; sum of the nodes' normal forces, N
        """
    def snapshot(self) -> Snapshot:
        """
        A checkpoint of the present state and record.
        """
    def step(self) -> bool:
        """
        One accepted step; False when the run is over.
        """
    def truss_force(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N: truss forces now
        """
    def velocity(self, unit: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) m/s, world, now
        """
    @property
    def balances(self) -> Balances:
        """
        Departures of the energy and momentum balances so far (J, N s).
        """
    @property
    def deepest_anchor(self) -> float:
        """
        m: depth of the deepest truss anchor inside the barrier now, 0 if none is
        """
    @property
    def deepest_node(self) -> float:
        """
        m: depth of the deepest shell node inside the barrier now, 0 if none is
        """
    @property
    def end_reason(self) -> EndReason:
        """
        Why the run ended; `running` before it does.
        """
    @property
    def event(self) -> Event:
        """
        What became of the vehicle at the barrier, so far.
        """
    @property
    def failed(self) -> bool:
        """
        Did the last step fail half way? Then only reset and restore are of use.
        """
    @property
    def replays(self) -> bool:
        """
        Do as many steps from the start lead to this state?
        """
    @property
    def state_hash(self) -> int:
        """
        Hash of all bits of the present state.
        """
    @property
    def statistics(self) -> StepStatistics:
        """
        Counts and lengths of the steps so far.
        """
    @property
    def time(self) -> float:
        """
        s, time of the present state
        """
    @property
    def touched(self) -> bool:
        """
        Has the vehicle touched the barrier so far?
        """
class Snapshot:
    """
    A checkpoint: state and record. It lives in memory only.
    """
    def __reduce__(self) -> typing.Any:
        ...
    @property
    def time(self) -> float:
        """
        s, time of the state
        """
class StepStatistics:
    """
    Counts and lengths of the steps of a run, and what they met.
    """
    @property
    def body_steps(self) -> int:
        """
        steps in which the rigid body stood against the barrier or the ground
        """
    @property
    def core_contact_force(self) -> float:
        """
        N, greatest mean over 50 ms of the barrier's force on the rigid core
        """
    @property
    def core_contact_time(self) -> float:
        """
        s, time of that greatest mean
        """
    @property
    def deepest_point(self) -> float:
        """
        m, greatest depth of an anchor of a bottomed-out truss inside a barrier
        """
    @property
    def fastest_rise(self) -> float:
        """
        m/s, greatest upward speed of a unit's mass centre after the barrier was touched
        """
    @property
    def free_steps(self) -> int:
        """
        steps in which no node was within reach of anything
        """
    @property
    def free_time(self) -> float:
        """
        s, sum of these steps
        """
    @property
    def greatest_overlap(self) -> float:
        """
        m, greatest overlap of the rigid body's boxes and an element of the barrier
        """
    @property
    def greatest_overlap_element(self) -> int:
        """
        number of the barrier's element in that overlap
        """
    @property
    def greatest_overlap_time(self) -> float:
        """
        s, time of that overlap
        """
    @property
    def greatest_tilt(self) -> float:
        """
        rad, greatest tilt of a post that yields, from the vertical
        """
    @property
    def least_critical_step(self) -> float:
        """
        s, least sqrt(3)/omega of the trusses in contact
        """
    @property
    def longest_step(self) -> float:
        """
        s, the longest accepted step
        """
    @property
    def near_elements(self) -> int:
        """
        elements of the barrier that any node was within reach of, or the rigid body met
        """
    @property
    def node_evaluations(self) -> int:
        """
        nodes whose contact was computed, summed over all steps, those rejected too
        """
    @property
    def rejected(self) -> int:
        """
        steps that were tried and found too long
        """
    @property
    def shortest_step(self) -> float:
        """
        s, the shortest accepted step
        """
    @property
    def skin_nodes(self) -> int:
        """
        nodes of the skin in blocks that anything came into in any step
        """
    @property
    def steps(self) -> int:
        """
        accepted steps
        """
    @property
    def tread_nodes(self) -> int:
        """
        the same of tyres
        """
    @property
    def wheels_given_way(self) -> int:
        """
        wheels that were loaded beyond what they carry, and have given way
        """
    @property
    def wheels_on_ground(self) -> int:
        """
        wheels that carried load, summed over the steps
        """
class Stop:
    """
    Ends runs from another thread.
    """
    def __init__(self) -> None:
        ...
    def is_set(self) -> bool:
        """
        Was `set` called?
        """
    def set(self) -> None:
        """
        Ask all runs that look at this stop to end.
        """
class TireModel:
    """
    Rule of the friction of tyres on the ground.
    
    Members:
    
      slip : continuous in the slip angle of each wheel: the brush model
    
      skid : full unless the mass centre moves along r: the paper's rule
    """
    __members__: typing.ClassVar[dict[str, TireModel]]  # value = {'slip': <TireModel.slip: 0>, 'skid': <TireModel.skid: 1>}
    skid: typing.ClassVar[TireModel]  # value = <TireModel.skid: 1>
    slip: typing.ClassVar[TireModel]  # value = <TireModel.slip: 0>
    def __eq__(self, other: typing.Any) -> bool:
        ...
    def __getstate__(self) -> int:
        ...
    def __hash__(self) -> int:
        ...
    def __index__(self) -> int:
        ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __int__(self) -> int:
        ...
    def __ne__(self, other: typing.Any) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __str__(self) -> str:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def value(self) -> int:
        ...
class TrussCurve:
    """
    Piecewise-linear loading envelope with an unloading slope (paper Fig. 3).
    """
    def envelope(self, deflection: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Force of the loading envelope at a deflection (m); its unit is that of the slopes times m.
        """
    def follow(self, path: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Forces (n,) along a path of deflections (n,) that starts uncrushed.
        """
    @property
    def deflection(self) -> list[float]:
        """
        m, where the slope changes
        """
    @property
    def elastic_recovery(self) -> float:
        """
        m, infinite where the slope is constant
        """
    @property
    def friction_share(self) -> float:
        """
        of the barrier's friction
        """
    @property
    def k_unloading(self) -> float:
        """
        slope of unloading, or the least one
        """
    @property
    def slope(self) -> list[float]:
        """
        slope from there on
        """
    @property
    def springback(self) -> float:
        """
        m, without force
        """
class TrussMesh:
    """
    The crushable skin of one rigid body. Immutable.
    """
    def __init__(self, *, nodes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], anchors: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], curves: collections.abc.Sequence[TrussCurve], curve_of: typing.Annotated[numpy.typing.ArrayLike, numpy.int64], scale: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wheels: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], rate_sensitivity: typing.SupportsFloat | typing.SupportsIndex, indentation_length: typing.SupportsFloat | typing.SupportsIndex, wheel_of: typing.Annotated[numpy.typing.ArrayLike, numpy.int64], along_of: typing.Annotated[numpy.typing.ArrayLike, numpy.int64]) -> None:
        """
        nodes, anchors: shape (n, 3), m. curves: laws of the trusses, of which truss i has number curve_of[i] times scale[i].
        wheels: shape (w, 4), centre and radius, m. rate_sensitivity: s/m.
        indentation_length: how far an indentation reaches beyond its post, m; 0: no indentation.
        wheel_of: number of the wheel whose tread the node is on, -1 for the skin; empty: all skin.
        along_of: number of the node of the skin whose second truss this is, -1 for others; empty: none.
        """
class Unit:
    """
    A rigid body with its crushable skin and wheels; body axes r, s, t, origin at the mass centre.
    """
    def __init__(self, *, mass: typing.SupportsFloat | typing.SupportsIndex, inertia: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], trusses: TrussMesh, origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wheels: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], breakaway: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], suspension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], tires: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], mass_center_height: typing.SupportsFloat | typing.SupportsIndex, offset: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], core: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None:
        """
        mass: kg. inertia: shape (3, 3), kg m^2. wheels: shape (w, 4), centre and radius, m.
        breakaway: shape (w, 2), load at which each wheel gives way, N, and how far it is then pushed up, m.
        suspension: shape (w, 5), stiffness, N/m (0: fixed to the body), damping, N s/m, compression at rest, m, travel from there to the bump stop, m, stiffness against roll over that of springs at the wheels.
        tires: shape (w, 4), time in which a wheel with free steering follows its direction of travel, s (inf: it does not steer), radius of the tread's cross-section, m, slip angle per tilt, rolling resistance per load.
        origin: shape (3,), m, of the body axes in those of the trusses; copies share what does not move.
        mass_center_height: m above the ground. offset: shape (3,), m, of the mass centre from the vehicle's reference point along the ground.
        core: shape (k, 6), middles and half edges of the boxes that the rigid body fills, body axes, m.
        """
    @property
    def input_index(self) -> list[int]:
        """
        The caller's number of each truss in the order of the state's columns.
        """
    @property
    def n_trusses(self) -> int:
        """
        number of trusses, and so of nodes of the skin and of tyres
        """
class UnitHistory:
    """
    Motion of one unit and the forces on it; read-only views.
    """
    @property
    def acceleration(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) m/s^2, of the mass centre, interval means, body axes
        """
    @property
    def angular_velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) rad/s, body axes
        """
    @property
    def barrier_force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N, of the barrier on the unit, interval means, world
        """
    @property
    def barrier_normal_force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N, component of barrier_force along the barrier's normal, interval means
        """
    @property
    def ground_force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N, of the ground on the skin, interval means, world
        """
    @property
    def joint_force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N, of all joints, interval means, world
        """
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) m, mass centre, world
        """
    @property
    def roll_pitch_yaw(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) rad, roll, pitch and yaw of the body axes
        """
    @property
    def sum_of_contact_forces(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) N, magnitudes of the nodes' normal forces on the barrier, interval means
        """
    @property
    def tire_friction_force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) N, of the ground on the tyres, along the ground, interval means, world
        """
    @property
    def tire_reaction(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, wheels) N, normal force of the ground on each wheel, interval means
        """
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) m/s, velocity of the mass centre, world
        """
class UnstableError(ValueError):
    """
    A fixed time step is longer than the stable one, or a scene is too stiff for any step.
    """
class Vehicle:
    """
    One or more units and the joints between them. Immutable.
    """
    def __init__(self, units: collections.abc.Sequence[Unit], joints: collections.abc.Sequence[Joint], *, cornering_stiffness: typing.SupportsFloat | typing.SupportsIndex, edge_flank_factor: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        cornering_stiffness (1/rad), edge_flank_factor: of runs whose settings ask for none.
        """
    def springback(self, unit: typing.SupportsInt | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) m: what each node of a unit comes back by without force
        """
    @property
    def stands_on_wheels(self) -> list[bool]:
        """
        Of each unit: has it wheels, with all of its skin above the ground at rest? Else its skin does not meet the ground.
        """
class YieldingPosts:
    """
    Posts that tilt about their centre of rotation against a plastic moment.
    """
    def __init__(self, *, mass: typing.SupportsFloat | typing.SupportsIndex, inertia: typing.SupportsFloat | typing.SupportsIndex, plastic_moment: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        mass: kg; inertia: about a horizontal axis through the centre of rotation, kg m^2; plastic_moment: N m.
        """
    @property
    def plastic_moment(self) -> float:
        """
        N m
        """
def collide(mass_a: typing.SupportsFloat | typing.SupportsIndex, inertia_a: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity_a: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], spin_a: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], mass_b: typing.SupportsFloat | typing.SupportsIndex, inertia_b: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity_b: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], spin_b: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arm_a: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arm_b: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], restitution: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Eq. 1 for two free bodies: impulse and the velocities and spins afterwards; normal from b to a.
    """
def from_roll_pitch_yaw(roll: typing.SupportsFloat | typing.SupportsIndex, pitch: typing.SupportsFloat | typing.SupportsIndex, yaw: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, float, float, float]:
    """
    Quaternion (w, x, y, z) of ISO 8855 angles in rad.
    """
def knee_curve(k_initial: typing.SupportsFloat | typing.SupportsIndex, knee: typing.SupportsFloat | typing.SupportsIndex, k_hardening: typing.SupportsFloat | typing.SupportsIndex, f_max: typing.SupportsFloat | typing.SupportsIndex, k_unloading: typing.SupportsFloat | typing.SupportsIndex, elastic_recovery: typing.SupportsFloat | typing.SupportsIndex = ..., tail_depth: typing.SupportsFloat | typing.SupportsIndex = ..., tail_slope: typing.SupportsFloat | typing.SupportsIndex = 0.0, friction_share: typing.SupportsFloat | typing.SupportsIndex = 1.0, springback: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> TrussCurve:
    """
    The paper's curve: k_initial to the knee, k_hardening to f_max, then the plateau; beyond tail_depth steeper by tail_slope.
    """
def mass_properties(solids: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], densities: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> MassProperties:
    """
    Mass properties of 8-node solids (n, 8, 3) in m with densities (n,) in kg/m^3.
    """
def point_curve(deflection: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], force: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], k_unloading: typing.SupportsFloat | typing.SupportsIndex, elastic_recovery: typing.SupportsFloat | typing.SupportsIndex = ..., tail_depth: typing.SupportsFloat | typing.SupportsIndex = ..., tail_slope: typing.SupportsFloat | typing.SupportsIndex = 0.0, friction_share: typing.SupportsFloat | typing.SupportsIndex = 1.0, springback: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> TrussCurve:
    """
    A curve through points, flat after the last; beyond tail_depth steeper by tail_slope.
    """
def roll_pitch_yaw(w: typing.SupportsFloat | typing.SupportsIndex, x: typing.SupportsFloat | typing.SupportsIndex, y: typing.SupportsFloat | typing.SupportsIndex, z: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, float, float]:
    """
    ISO 8855 angles in rad of a quaternion.
    """
def solid_volumes(solids: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    """
    Volumes (n,) in m^3 of 8-node solids (n, 8, 3).
    """
def tumble(inertia: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], angular_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex, steps: typing.SupportsInt | typing.SupportsIndex) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Free motion from the identity orientation: energy (n,) J, angular momentum (n, 3), quaternion (n, 4) w x y z.
    """
along_line: float = 1e-09
coasting_speed: float = 0.25
tail_duration: float = 0.02
