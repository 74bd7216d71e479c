"""Runs for other programs: glTF for Blender and browsers, VTK for ParaView."""

from __future__ import annotations

from .gltf import write_gltf
from .vtk_series import write_vtk

__all__ = ["write_gltf", "write_vtk"]
