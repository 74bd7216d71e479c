"""Test data from files, as channels: tables with units, the NHTSA vehicle database, ISO MME.

Reading changes nothing but the format: no sign is turned, no bias removed, no time shifted. What looks wrong
is what :func:`birm3d.check_channel` says.
"""

from __future__ import annotations

from .csv_channels import read_csv_channels
from .iso_mme import IsoMmeTest, read_iso_mme
from .nhtsa import NhtsaCurve, NhtsaTest, read_nhtsa

__all__ = ["IsoMmeTest", "NhtsaCurve", "NhtsaTest", "read_csv_channels", "read_iso_mme", "read_nhtsa"]
