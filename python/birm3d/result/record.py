"""What a run recorded: histories, the end of the run, and how it came about."""

# Longer than 300 lines: one class: all that a run recorded.
from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .. import _core
from .._version import __version__
from ..base.arguments import checked
from ..base.checks import index as place
from ..base.frozen_mapping import FrozenMapping
from ..io.made_with import platform_facts
from ..scene.scene import Scene
from .frames import Frames, pose
from .stored import Stored, StoredHistory
from .unit_result import UnitResult, read_only

__all__ = ["RunRecord"]

Floats = npt.NDArray[np.float64]

_ENERGIES = (
    "kinetic",
    "potential",
    "stored",
    "crushed",
    "barrier_friction",
    "tire_friction",
    "ground_friction",
    "impacts",
)


@checked
class RunRecord:
    """Histories of n rows as the core or a file has them; :class:`birm3d.Result` says what they are.

    Metrics, loads of elements and frames are made of a record; a result is a record that has them all.
    """

    _public_name = "Result"  # what messages call it

    def __init__(
        self,
        *,
        scene: Scene,
        history: _core.History | StoredHistory,
        statistics: _core.StepStatistics | Stored,
        end_reason: str,
        state_hash: int,
        run_time: float,
        units: tuple[UnitResult, ...],
        event: _core.Event | Stored | None,
        frames: Frames | None = None,
        made_with: Mapping[str, str] | None = None,
        saved_metrics: Mapping[str, float] | None = None,
    ) -> None:
        self.scene = scene
        self.statistics = statistics
        self.end_reason = end_reason
        self.state_hash = state_hash
        self.run_time = run_time
        self.nodes = units[0].nodes
        self.deflection = units[0].deflection
        self.peak_deflection = units[0].peak_deflection
        self.final_velocity = units[0].final_velocity
        self.frames = frames
        self._history = history
        self._units = units
        self.saved_metrics = saved_metrics  # of a file, which a later version may compute in another way
        self._event = event  # None of a file of version 0.1.0
        self._made_with = made_with  # of a file; None: this process

    @cached_property
    def made_with(self) -> Mapping[str, str]:
        """Versions, source and platform that computed it; of a file, as far as that says.

        ``source`` is a hash of the sources of the package. ``commit`` is there where the build knew it.
        """
        return FrozenMapping(platform_facts() if self._made_with is None else self._made_with)

    @property
    def version(self) -> str:
        """Of the package that computed it."""
        return __version__ if self._made_with is None else self._made_with["birm3d"]

    @property
    def has_left(self) -> bool:
        """Whether the vehicle had separated from the barrier."""
        return self._event is not None and self._event.exit_deflection is not None

    @property
    def outcome(self) -> str:
        """What became of the vehicle: one of :data:`birm3d.result.event.OUTCOMES`."""
        outcome: str = "undecided" if self._event is None else self._event.outcome
        return outcome

    @property
    def time(self) -> Floats:
        """Shape (n,) [s]."""
        return self._history.time

    def unit(self, index: int) -> UnitResult:
        """Return the histories of one rigid body: 0 the leading one (or the only one), 1 the trailing one.

        Raises
        ------
        ValueError
            If the vehicle has no such unit.
        """
        return self._units[place("index", index, len(self._units), "units")]

    @property
    def position(self) -> Floats:
        """Mass centre of unit 0, world axes, shape (n, 3) [m]."""
        return self._units[0].position

    @property
    def velocity(self) -> Floats:
        """Of the mass centre of unit 0, world axes, shape (n, 3) [m/s]."""
        return self._units[0].velocity

    @property
    def acceleration(self) -> Floats:
        """Of the mass centre of unit 0, body axes r, s, t, shape (n, 3) [m/s^2]; interval means."""
        return self._units[0].acceleration

    @property
    def angular_velocity(self) -> Floats:
        """Of unit 0, body axes r, s, t, shape (n, 3) [deg/s]."""
        return self._units[0].angular_velocity

    @property
    def roll(self) -> Floats:
        """Of unit 0 about r, shape (n,) [deg]."""
        return self._units[0].roll

    @property
    def pitch(self) -> Floats:
        """Of unit 0 about s, positive nose-down, shape (n,) [deg]."""
        return self._units[0].pitch

    @property
    def yaw(self) -> Floats:
        """Of unit 0 about t, from the initial heading, positive to the left, shape (n,) [deg]."""
        return self._units[0].yaw

    @cached_property
    def barrier_force(self) -> Floats:
        """Of the barrier on the vehicle, all units, world axes, shape (n, 3) [N]; interval means."""
        return self._sum("barrier_force")

    @cached_property
    def barrier_normal_force(self) -> Floats:
        """Component of ``barrier_force`` along the barrier's normal, shape (n,) [N]; interval means.

        F_n = -F . n with n the horizontal unit vector square to the barrier's line, away from the traffic; on
        paths along the line (angles 0 and 180) n is the path's direction. Compression is positive. It is the
        load in this direction. Forces of two posts, or of two faces of one post, that oppose each other
        across n do not add to it. Friction with a component along n, as on a slope, is in it.
        """
        return self._sum("barrier_normal_force")

    @cached_property
    def sum_of_contact_forces(self) -> Floats:
        """Sum of the magnitudes of the normal forces of all nodes, all units, shape (n,) [N]; interval means.

        No load: opposed forces add up in it. It bounds the friction on the barrier, and is above zero exactly
        where there is contact.
        """
        return self._sum("sum_of_contact_forces")

    @property
    def _segments(self) -> int:
        """How many free-standing segments the barrier has."""
        barrier = self.scene.barrier
        return 0 if barrier is None else len(barrier.core.segments)

    @property
    def _pinned(self) -> bool:
        """Whether the barrier has segments that are pinned to each other."""
        barrier = self.scene.barrier
        return barrier is not None and barrier.is_pinned

    @property
    def segment_position(self) -> Floats:
        """Foot of the middle of each free-standing segment, world x and y, shape (n, k, 2) [m].

        Segments are those of ``scene.barrier.element_names``; k is 0 where the barrier is fixed.
        """
        return self._of_moving("segment_position", self._segments, (2,))

    @property
    def segment_velocity(self) -> Floats:
        """Of the mass centre of each free-standing segment, world x and y, shape (n, k, 2) [m/s]."""
        return self._of_moving("segment_velocity", self._segments, (2,))

    @cached_property
    def segment_yaw(self) -> Floats:
        """Turn of each free-standing segment since the start, positive to the left, shape (n, k) [deg]."""
        return read_only(np.degrees(self._of_moving("segment_yaw", self._segments)))

    @cached_property
    def segment_yaw_rate(self) -> Floats:
        """Of each free-standing segment, shape (n, k) [deg/s]."""
        return read_only(np.degrees(self._of_moving("segment_yaw_rate", self._segments)))

    @property
    def _posts(self) -> int:
        """How many posts that yield the barrier has."""
        barrier = self.scene.barrier
        return 0 if barrier is None else len(barrier.core.yielding_posts)

    @cached_property
    def post_axis(self) -> Floats:
        """Unit vectors along each post that yields, upwards, world axes, shape (n, k, 3).

        Posts are those of ``scene.barrier.element_names``; k is 0 where the barrier is rigid.
        """
        return self._of_moving("post_axis", self._posts, (3,))

    @cached_property
    def post_tilt(self) -> Floats:
        """Angle of each post that yields to the vertical, shape (n, k) [deg]."""
        axis = self.post_axis
        return read_only(np.degrees(np.arctan2(np.hypot(axis[..., 0], axis[..., 1]), axis[..., 2])))

    def _of_moving(self, name: str, count: int, more: tuple[int, ...] = ()) -> Floats:
        """Return a column of the history for each element that moves; ``count``: how many there are."""
        if count == 0:  # files of earlier versions have none
            return read_only(np.zeros((len(self.time), 0, *more)))
        values: Floats = getattr(self._history, name)
        return values

    @cached_property
    def tire_reaction(self) -> Floats:
        """Normal force under each wheel of all units, shape (n, wheels) [N]; interval means."""
        if len(self._units) == 1:
            return self._units[0].tire_reaction
        return read_only(np.concatenate([unit.tire_reaction for unit in self._units], axis=1))

    @cached_property
    def ground_force(self) -> Floats:
        """Of the ground on the bodies, not the tyres, world axes, shape (n, 3) [N]; interval means."""
        return self._sum("ground_force")

    @cached_property
    def tire_friction_force(self) -> Floats:
        """Of the ground on the vehicle, tangential, world axes, shape (n, 3) [N]; interval means."""
        return self._sum("tire_friction_force")

    def _sum(self, name: str) -> Floats:
        if len(self._units) == 1:
            values: Floats = getattr(self._units[0], name)
            return values
        return read_only(np.sum([getattr(unit, name) for unit in self._units], axis=0))

    @property
    def joint_force(self) -> Floats:
        """Of the joint on the leading unit, world axes, shape (n, 3) [N]; interval means."""
        return self._joint.force

    @property
    def joint_moment(self) -> Floats:
        """Of the joint on the leading unit about the joint, world axes, shape (n, 3) [N m]; means."""
        return self._joint.moment

    @property
    def articulation_angle(self) -> Floats:
        """Yaw of the trailing unit from the leading one, positive to the left, shape (n,) [deg].

        The jackknife angle: the turn of the kingpin in the fifth wheel. Pitch, roll and this yaw follow each
        other as in a Cardan joint, see ``joint_pitch`` and ``joint_roll``.
        """
        return self._joint_angles[:, 2]

    @property
    def joint_roll(self) -> Floats:
        """Roll of the trailing unit from the leading one, shape (n,) [deg]."""
        return self._joint_angles[:, 0]

    @property
    def joint_pitch(self) -> Floats:
        """Pitch of the trailing unit from the leading one, positive nose-down, shape (n,) [deg]."""
        return self._joint_angles[:, 1]

    @property
    def bed_slip(self) -> Floats:
        """How far the load bed has slid forwards along the frame, shape (n,) [m]; of a sliding joint."""
        if not self.scene.vehicle.slides:
            raise ValueError(f"bed_slip needs a vehicle with_sliding_bed(), got {self.scene.vehicle.name!r}")
        return self._joint.slip

    @property
    def _joint(self) -> _core.JointHistory | Stored:
        if self.scene.vehicle.joint is None:
            raise ValueError(f"a joint needs a vehicle of two units, got {self.scene.vehicle.name!r} of one")
        return self._history.joint(0)

    @cached_property
    def _joint_angles(self) -> Floats:
        return read_only(np.degrees(np.unwrap(self._joint.roll_pitch_yaw, axis=0)))

    @cached_property
    def energy(self) -> Mapping[str, Floats]:
        """Energy balance, name -> shape (n,) [J].

        ``kinetic`` and ``potential`` of the body, ``stored`` (elastic) and ``crushed`` (plastic) in trusses,
        ``barrier_friction``, ``tire_friction``, ``ground_friction`` (of the body on the ground) and
        ``impacts`` (lost in rigid contacts). Then their ``total``, and ``residual``: total now less total at
        the start, as no work enters from outside. ``kinetic`` is that of all bodies. Where the barrier is
        free-standing also ``barrier_ground_friction``, what its segments lost to friction on the ground.
        Where wheels have springs also ``suspension``: of springs less that at rest, and lost in dampers.
        Where units or segments are joined also ``joints``: the work of joint forces in the held directions.
        It is zero up to the error of the steps, and is separate so that this error is not mistaken for a
        loss. The loss at the stops of a fifth wheel is in ``impacts``. Where a load bed can slide also
        ``sliding``, what that lost. Where posts yield also ``yielding``, the work of their plastic moments.
        """
        terms = {name: getattr(self._history, name) for name in _ENERGIES}
        if self._segments:
            terms["barrier_ground_friction"] = self._history.barrier_ground_friction
        if self.scene.vehicle.joint is not None or self._pinned:
            terms["joints"] = self._history.joints
        if self.scene.vehicle.has_springs:
            terms["suspension"] = read_only(self._history.springs + self._history.dampers)
        if self.scene.vehicle.slides:
            terms["sliding"] = self._history.sliding
        if self._posts:
            terms["yielding"] = self._history.yielding
        total = np.sum(list(terms.values()), axis=0)
        return FrozenMapping({**terms, "total": read_only(total), "residual": read_only(total - total[0])})

    @property
    def momentum_residual(self) -> float:
        """Greatest |m a - sum of forces| over the greatest force, of all rows.

        The greatest force counts as no less than the weight, and no less than what stops the vehicle from its
        speed at the start within 1 s. That speed counts as 0.1 m/s at least. So rounding errors stay small
        relative to it where nothing pushes.
        """
        return self._history.momentum_residual

    def _extremes(self, groups: _core.ExtremeGroups) -> _core.Extremes:
        """Extremes of the histories, of a result that was not read from a file."""
        assert isinstance(self._history, _core.History)
        assert isinstance(self._event, _core.Event)
        barrier = self.scene.barrier
        return self._history.extremes(
            groups, self._event, self.scene.vehicle.core, [] if barrier is None else [barrier.core]
        )

    def final_nodes(self, unit: int = 0) -> Floats:
        """Return the shell nodes of one unit at the end, body axes, shape (k, 3) [m]."""
        return self.unit(unit).nodes

    def pose(self, time: npt.ArrayLike, unit: int = 0) -> tuple[Floats, Floats]:
        """Return mass centres (k, 3) [m] and rotation matrices body to world (k, 3, 3) at instants (k,) [s].

        Positions are linear between the rows, orientations turn at a constant rate.
        """
        rows = self._history.unit(place("unit", unit, len(self._units), "units"))
        return pose(self.time, rows.position, rows.roll_pitch_yaw, time)
