"""What a figure is made with: the renderer, the scale of the print, and clips, real ones where they are here."""

from __future__ import annotations

from dataclasses import dataclass, field

from demos.figures.stills import Look, Still, Strip, film, framed, lay_over, photograph, seen_points, spans_m
from engine.clips.clip import Clip
from engine.clips.library import find_clip, list_clips
from engine.render.renderer import Renderer
from engine.render.scene import Scene

LAYERED_EDGE, LAYERED_MARGIN = 16.0, 0.045
STAND_IN = "sway"  # embedded: always there


@dataclass
class Press:
    """Everything that figures share while they are made."""

    renderer: Renderer
    scale: float = 2.0  # pixels for a unit
    missing: list[str] = field(default_factory=list)  # clips that the embedded one stood in for

    def has(self, *names: str) -> bool:
        """Whether all these library clips are ready."""
        return set(names) <= _ready()

    def clip(self, *names: str) -> Clip:
        """The first of these library clips that is ready; else the embedded one, and that is remembered."""
        ready = _ready()
        for name in names:
            if name in ready:
                return find_clip(name)
        self.missing += [names[0]] if names[0] not in self.missing else []
        return find_clip(STAND_IN)

    def still(
        self, scene: Scene, look: Look, width: float, more_m=(), margin: float = 0.02, shadows: bool = True
    ) -> Still:
        """The scene in a still of that width in units, as high as it needs to be."""
        camera, size = framed(look, seen_points([scene], more_m, shadows), width, margin)
        return photograph(self.renderer, scene, camera, size, self.scale)

    def layers(
        self,
        scenes: list[Scene],
        look: Look,
        width: float,
        more_m=(),
        cut_m: float | None = None,
        shadows: bool = False,
    ) -> Still:
        """Scenes in the same place, each painted over the ones before: so a ghost never tints what stands before it.

        `cut_m`: nothing below that height needs to be seen; `shadows`: nor the ends of shadows, unless asked for.
        """
        points = seen_points(scenes, more_m, shadows)
        if cut_m is not None:
            points = points[points[:, 2] >= cut_m]
        camera, size = framed(look, points, width, LAYERED_MARGIN)
        stills = [photograph(self.renderer, scene, camera, size, self.scale, LAYERED_EDGE) for scene in scenes]
        for still in stills[1:]:
            lay_over(stills[0].pixels, still.pixels, 0, join_shadows=True)
        return stills[0]

    def still_at(self, scene: Scene, look: Look, unit: float) -> Still:
        """The scene at a scale: so many units for a metre. For stills that must match."""
        across_m, _ = spans_m(look, seen_points([scene], (), True))
        return self.still(scene, look, 1.04 * across_m * unit)

    def strip(
        self,
        scenes: list[Scene],
        look: Look,
        width: float,
        pitch_m: float | list[float],
        more_m=(),
        shadows: bool = True,
    ) -> Strip:
        """Scenes side by side; see `stills.film`."""
        return film(self.renderer, self.scale, scenes, look, width, pitch_m, more_m, shadows)


def _ready() -> set[str]:
    return {listed.name for listed in list_clips() if listed.ready}
