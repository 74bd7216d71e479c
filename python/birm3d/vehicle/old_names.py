"""Names of earlier versions that vehicles and their files are still read by."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..base.arguments import checked
from ..base.deprecated import warn_deprecated, warn_renamed
from ..units import Quantity
from .variants import VehicleVariants

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["OldVehicleNames"]


@checked
class OldVehicleNames(VehicleVariants):
    """Methods and fields of a :class:`birm3d.Vehicle` by old names; each warns and says what to write."""

    @property
    def dent_reach(self) -> float:
        """Old name of ``indentation_length`` [m]."""
        warn_renamed("dent_reach", "indentation_length")
        return self.indentation_length

    def with_dent_reach(self, dent_reach: Quantity) -> Self:
        """Return ``with_indentation_length(dent_reach)``: an old name."""
        warn_renamed("with_dent_reach()", "with_indentation_length()")
        return self.with_indentation_length(dent_reach)

    def draft(self) -> Self:
        """Return the vehicle itself: the name of an earlier version."""
        return self._needs_no_draft("draft")

    def finished(self) -> Self:
        """Return the vehicle itself: the name of an earlier version."""
        return self._needs_no_draft("finished")

    def _needs_no_draft(self, name: str) -> Self:
        warn_deprecated(f"{name}() is not needed any more: every change of a vehicle is one of its recipe")
        return self
