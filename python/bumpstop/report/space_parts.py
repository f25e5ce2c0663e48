"""The parts of a structure in space as lines and points of plotly, frame by frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.palette import LIGHT

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray

__all__ = ["SpaceDrawing"]

ARROW = 0.16
"""Length of the largest force, relative to the size of what is drawn."""
PLATE = 0.035
"""Half the width of a plate, and of a coil."""
BEHIND = 0.12
"""Length of a spring that stands on the ground."""
COILS = 6
GAP = np.full((1, 3), np.nan)
"""Between two lines of one trace."""


class SpaceDrawing:
    """A motion at one scale.

    Parameters
    ----------
    scene
        As `bumpstop.report.scene.motion_scene` gives it, in global axes.
    scale
        By how much motions and gaps are larger than they are.
    """

    def __init__(self, scene: dict[str, Any], scale: float) -> None:
        self.scene = scene
        self.scale = scale
        self.rest: FloatArray = scene["points"]
        moved = np.einsum("pam,fm->fpa", scene["shapes"], scene["modal"])
        self.places: FloatArray = self.rest + scale * moved
        obstacles = [self._farthest(law) for law in scene["laws"]]
        self.known = np.concatenate([self.rest, self.places.reshape(-1, 3), *obstacles])
        self.size = float(np.ptp(self.known, axis=0).max()) or 1.0
        self.largest = max(
            (float(np.abs(law["forces"]).max()) for law in scene["laws"]), default=0.0
        )

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest coordinates that are drawn, (3,) each, in m."""
        margin = (BEHIND + 2.0 * PLATE) * self.size
        return self.known.min(axis=0) - margin, self.known.max(axis=0) + margin

    @property
    def moving_traces(self) -> list[int]:
        """Which traces change from frame to frame: all but the first."""
        return [1, 2, 3, 4, 5, 6]

    def traces(self, frame: int) -> list[dict[str, Any]]:
        """Return all traces, the moving ones as they are in a frame."""
        still = self._line(self._beams(self.rest), "axis", 2, "dash")
        return [still, *self.moving(frame)]

    def moving(self, frame: int) -> list[dict[str, Any]]:
        """Return beams, nodes, laws at rest, laws in contact, forces and sliders in a frame."""
        places = self.places[frame]
        at_rest: list[FloatArray] = []
        pressed: list[FloatArray] = []
        forces: list[FloatArray] = []
        for law in [*self.scene["springs"], *self.scene["laws"]]:
            line = self._law(law, frame)
            force = self._force(law, frame)
            forces.append(force)
            closed = law.get("kind") != "link" and len(force) > 1
            (pressed if closed else at_rest).append(line)
        return [
            self._line(self._beams(places), "ink", 6),
            self._nodes(places),
            self._line(_joined(at_rest), "muted", 3),
            self._line(_joined(pressed), "contact", 4),
            self._line(_joined(forces), "contact", 5),
            self._line(_joined(self._sliders(frame)), "stored", 5),
        ]

    def _beams(self, places: FloatArray) -> FloatArray:
        return _joined([places[first : first + count] for first, count in self.scene["lines"]])

    def _nodes(self, places: FloatArray) -> dict[str, Any]:
        nodes = self.scene["nodes"]
        points = [node["point"] for node in nodes]
        bodies = set(self.scene["bodies"])
        x, y, z = places[points].astype(np.float32).T
        return {
            "type": "scatter3d",
            "mode": "markers+text",
            "x": x,
            "y": y,
            "z": z,
            "text": [node["name"] for node in nodes],
            "textposition": "top center",
            "hovertemplate": "%{text}<extra></extra>",
            "marker": {
                "size": [11 if point in bodies else 4 for point in points],
                "color": LIGHT["computed"],
            },
        }

    def _line(self, points: FloatArray, role: str, width: int, dash: str = "solid") -> Any:
        x, y, z = points.astype(np.float32).T
        return {
            "type": "scatter3d",
            "mode": "lines",
            "x": x,
            "y": y,
            "z": z,
            "line": {"color": LIGHT[role], "width": width, "dash": dash},
            "hoverinfo": "skip",
        }

    def _farthest(self, law: dict[str, Any]) -> FloatArray:
        rest: FloatArray = self.rest[law["point"]]
        if law["kind"] == "round":
            return np.asarray(rest + self.scale * law["outline"])
        if law["kind"] == "plane":
            return np.asarray(rest + self.scale * law["lowest"] * law["normal"])[np.newaxis]
        return rest[np.newaxis]

    def _law(self, law: dict[str, Any], frame: int) -> FloatArray:
        """Return the line (n, 3) that stands for a law, or for a spring of the structure."""
        rest, here = self.rest[law["point"]], self.places[frame, law["point"]]
        other = self.places[frame, law["other"]] if law["other"] >= 0 else None
        kind = law.get("kind", "link")
        if kind == "round":
            carried = law["slides"][frame] * law["axis"]
            shift = np.asarray(self.scale * carried)
            if other is not None:
                shift = shift + other - self.rest[law["other"]]
            return np.asarray(rest + self.scale * law["outline"] + shift)
        if kind == "link":
            foot = rest - (BEHIND * self.size) * law["normal"] if other is None else other
            return self._coil(here, foot)
        plate = rest + self.scale * self._surface(law, frame) * law["normal"]
        if other is None:
            ground = rest + self.scale * law["lowest"] * law["normal"]
            other = ground - (BEHIND * self.size) * law["normal"]
        face = self._plate(plate, law["normal"])
        return face if law["symbol"] == "rigid" else _joined([face, self._coil(plate, other)])

    def _sliders(self, frame: int) -> list[FloatArray]:
        """Return a small diamond (5, 3) on each obstacle where the slider of friction stands."""
        drawn = []
        for law in self.scene["laws"]:
            slider = law.get("slider")
            if slider is None or not np.isfinite(slider["places"][frame]):
                continue
            shift = slider["places"][frame] * slider["direction"]
            shift = shift + self._surface(law, frame) * law["normal"]
            centre = self.rest[law["point"]] + self.scale * shift
            if law["other"] >= 0:
                centre = centre + self.places[frame, law["other"]] - self.rest[law["other"]]
            along = slider["direction"]
            across = np.cross(law["normal"], along)
            half = 0.5 * PLATE * self.size
            drawn.append(centre + half * np.array([along, across, -along, -across, along]))
        return drawn

    def _surface(self, law: dict[str, Any], frame: int) -> float:
        """Return where the face of a plane obstacle is along its normal, pressed as it is."""
        surface = law["surfaces"][frame] if "surfaces" in law else law["surface"]
        depth = max(0.0, -float(law["gaps"][frame])) if law["symbol"] != "rigid" else 0.0
        return float(surface - depth)

    def _plate(self, centre: FloatArray, normal: FloatArray) -> FloatArray:
        first, second = _across(normal)
        half = PLATE * self.size
        corners = [(1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1)]
        return np.array([centre + half * (a * first + b * second) for a, b in corners])

    def _coil(self, start: FloatArray, end: FloatArray) -> FloatArray:
        along = end - start
        length = float(np.linalg.norm(along))
        if length < 1e-9 * self.size:
            return np.array([start, end])
        first, second = _across(along / length)
        way = np.linspace(0.0, 1.0, 12 * COILS + 1)
        turn = 2.0 * np.pi * COILS * way
        # Straight at both ends, so that it is seen to be fastened there.
        wide = 0.5 * PLATE * self.size * np.minimum(1.0, 8.0 * np.minimum(way, 1.0 - way))
        round_ = np.outer(wide * np.cos(turn), first) + np.outer(wide * np.sin(turn), second)
        return np.asarray(start + np.outer(way, along) + round_)

    def _force(self, law: dict[str, Any], frame: int) -> FloatArray:
        """Return the arrow (n, 3) of a force on the structure; one point where there is none."""
        here: FloatArray = self.places[frame, law["point"]]
        if "forces" not in law or self.largest == 0.0:
            return here[np.newaxis]
        vector = law["forces"][frame] * law["normal"]
        if law["kind"] == "round":
            vector = law["vectors"][frame]
        arrow = ARROW * self.size * vector / self.largest
        length = float(np.linalg.norm(arrow))
        if length < 1e-9 * self.size:
            return here[np.newaxis]
        tip, head = here + arrow, 0.25 * min(length, 0.1 * self.size) * _across(arrow / length)[0]
        back = tip - 0.25 * arrow
        return np.array([here, tip, back + head, tip, back - head])


def _joined(lines: list[FloatArray]) -> FloatArray:
    """Return lines as one, with gaps between them; nothing to see where there are none."""
    parts = [part for line in lines for part in (line, GAP)]
    return np.asarray(np.concatenate(parts[:-1])) if parts else GAP


def _across(along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two unit vectors at right angles to a unit vector and to each other."""
    first = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    first /= np.linalg.norm(first)
    return first, np.cross(along, first)
