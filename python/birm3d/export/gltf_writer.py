"""Builds a glTF 2.0 file of meshes, nodes and animations with pygltflib."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["GltfWriter"]

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_FLOAT, _WHOLE = 5126, 5125  # component types of glTF: 32-bit float, 32-bit unsigned
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}


class GltfWriter:
    """Collects the parts of one file; :meth:`write` writes it.

    Raises
    ------
    ImportError
        If pygltflib is not installed.
    """

    def __init__(self, generator: str) -> None:
        try:
            import pygltflib
        except ImportError as error:
            raise ImportError("write_gltf() needs pygltflib: pip install 'birm3d[export]'") from error
        self._kinds: Any = pygltflib
        self._file = pygltflib.GLTF2()
        self._file.asset = pygltflib.Asset(version="2.0", generator=generator)
        self._file.scenes = [pygltflib.Scene(nodes=[])]
        self._file.scene = 0
        self._animation = pygltflib.Animation(name="crash", channels=[], samplers=[])
        self._file.animations = [self._animation]
        self._data = bytearray()
        self._materials: dict[tuple[float, ...], int] = {}

    def node(
        self,
        name: str,
        parent: int | None = None,
        mesh: int | None = None,
        translation: npt.ArrayLike | None = None,
        rotation: npt.ArrayLike | None = None,
    ) -> int:
        """Add a node; without a parent it is a root. rotation: quaternion x, y, z, w."""
        node = self._kinds.Node(name=name, mesh=mesh)
        if translation is not None:
            node.translation = np.asarray(translation, float).tolist()
        if rotation is not None:
            node.rotation = np.asarray(rotation, float).tolist()
        self._file.nodes.append(node)
        number = len(self._file.nodes) - 1
        if parent is None:
            self._file.scenes[0].nodes.append(number)
        else:
            above = self._file.nodes[parent]
            above.children = [*(above.children or []), number]
        return number

    def mesh(
        self,
        name: str,
        points: Floats,
        faces: Ints,
        color: tuple[float, float, float, float],
        colors: Floats | None = None,
        targets: Floats | None = None,
    ) -> int:
        """Add a mesh: points (n, 3), triangles (m, 3), factors (n, 3) of its colour, targets (k, n, 3)."""
        kinds = self._kinds
        attributes = kinds.Attributes(POSITION=self._accessor(points, limits=True))
        if colors is not None:
            attributes.COLOR_0 = self._accessor(colors)
        primitive = kinds.Primitive(attributes=attributes, material=self._material(color))
        primitive.indices = self._accessor(faces.reshape(-1), whole=True)
        mesh = kinds.Mesh(name=name, primitives=[primitive])
        if targets is not None:
            primitive.targets = [{"POSITION": self._accessor(one, limits=True)} for one in targets]
            mesh.weights = [0.0] * len(targets)
        self._file.meshes.append(mesh)
        return len(self._file.meshes) - 1

    def times(self, seconds: Floats) -> int:
        """Add the instants of animations, from 0 on [s]; returns what :meth:`animate` asks for."""
        return self._accessor(seconds, limits=True)

    def animate(self, node: int, path: str, time: int, values: Floats) -> None:
        """Move a node: values (k, 3) of "translation", (k, 4) of "rotation" or (k, targets) of "weights"."""
        flat = values.reshape(-1) if path == "weights" else values
        kinds = self._kinds
        sampler = kinds.AnimationSampler(input=time, output=self._accessor(flat), interpolation="LINEAR")
        self._animation.samplers.append(sampler)
        target = kinds.AnimationChannelTarget(node=node, path=path)
        number = len(self._animation.samplers) - 1
        self._animation.channels.append(kinds.AnimationChannel(sampler=number, target=target))

    def write(self, path: Path, binary: bool) -> None:
        """Write the file: binary, or text with the data as base64 in it."""
        self._file.buffers = [self._kinds.Buffer(byteLength=len(self._data))]
        self._file.set_binary_blob(bytes(self._data))
        if binary:
            path.write_bytes(b"".join(self._file.save_to_bytes()))
            return
        self._file.convert_buffers(self._kinds.BufferFormat.DATAURI)
        path.write_text(self._file.to_json(), encoding="utf-8")

    def _accessor(self, values: npt.NDArray[Any], *, whole: bool = False, limits: bool = False) -> int:
        array = np.ascontiguousarray(values, np.uint32 if whole else np.float32)
        start = len(self._data)
        self._data += array.tobytes()
        kinds = self._kinds
        view = kinds.BufferView(buffer=0, byteOffset=start, byteLength=array.nbytes)
        self._file.bufferViews.append(view)
        columns = 1 if array.ndim == 1 else array.shape[1]
        accessor = kinds.Accessor(
            bufferView=len(self._file.bufferViews) - 1,
            componentType=_WHOLE if whole else _FLOAT,
            count=len(array),
            type=_TYPES[columns],
        )
        if limits:
            accessor.min = np.atleast_1d(array.min(axis=0)).astype(float).tolist()
            accessor.max = np.atleast_1d(array.max(axis=0)).astype(float).tolist()
        self._file.accessors.append(accessor)
        return len(self._file.accessors) - 1

    def _material(self, color: tuple[float, float, float, float]) -> int:
        if color not in self._materials:
            look = self._kinds.PbrMetallicRoughness(
                baseColorFactor=list(color), metallicFactor=0.0, roughnessFactor=0.8
            )
            material = self._kinds.Material(pbrMetallicRoughness=look, doubleSided=True)
            material.alphaCutoff = None  # has a meaning for masks only
            self._file.materials.append(material)
            self._materials[color] = len(self._file.materials) - 1
        return self._materials[color]
