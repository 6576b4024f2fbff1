"""The worst cases of `brace bench --motion` to look at: filmstrips, drawn as `brace capture` draws them.

Each is the whole reaction; where a figure is worst at one moment, a second strip shows that moment tick by tick.
"""

from __future__ import annotations

from pathlib import Path

from behaviours.measure.measures import Worst, greatest
from behaviours.timing import TICK_S
from demos.benchmarks.motion_cases import Case, scenario_of
from demos.benchmarks.motion_figure import Figure
from engine.clips.clip import Clip
from engine.clips.library import find_clip

FRAMES, COLUMNS = 16, 8
SIZE_PX, DISTANCE_M = (300, 400), 3.7
MOMENT_TICKS, MOMENT_DISTANCE_M = 4, 2.6  # before and after, from nearer


def write_worst(figures: list[Figure], clips: dict[str, Clip], folder: Path) -> list[Path]:
    """The worst case of every figure, one picture a case, named after the figures; and a list of them, `worst.txt`."""
    from demos.filming import studio

    named: dict[Case, list[Figure]] = {}
    for figure in figures:
        if figure.worst is not None:
            named.setdefault(figure.worst["case"], []).append(figure)
    written, words = [], []
    with studio() as renderer:
        for case, worst_of in named.items():
            stem = f"case_{case.number:03d}_{_slug(worst_of[0].name)}"
            written.append(_draw(renderer, folder / f"{stem}.png", case, clips))
            words.append(f"{stem}.png: {case}")
            for figure in worst_of:
                words.append(f"    {figure.name}: {figure.value:.4g}")
                if worst := moment_of(figure):
                    path = folder / f"case_{case.number:03d}_moment_{_slug(figure.name)}.png"
                    written.append(_draw(renderer, path, case, clips, worst.tick))
                    words.append(f"        {worst.what} at {worst.tick * TICK_S:.3f} s: {path.name}")
    (folder / "worst.txt").write_text("\n".join(words) + "\n", encoding="utf-8")
    return written


def moment_of(figure: Figure) -> Worst | None:
    """When and where a figure's worst case is worst; None where that is no one moment, or nothing is wrong."""
    if figure.worst is None or figure.met:
        return None
    if figure.name.startswith("change of velocity"):
        return figure.worst["snap"]
    by_phase = {"beyond": "limit_by_phase", "arms": "overlap_by_phase"}.get(figure.name.split()[0])
    return greatest(figure.worst[by_phase]) if by_phase else None


def _draw(renderer, path: Path, case: Case, clips: dict[str, Clip], tick: int | None = None) -> Path:
    """The whole reaction, or the ticks about one of them."""
    from behaviours.simulation import Simulation
    from demos.commands.capture import write_strip
    from demos.filming import Shot, placed_for

    scenario = scenario_of(case)
    simulation = Simulation(scenario, lambda spec: clips.get(spec.clip) or find_clip(spec.clip))
    shot = placed_for(Shot(size_px=SIZE_PX), scenario)
    near = shot._replace(camera=(*shot.camera[:2], DISTANCE_M if tick is None else MOMENT_DISTANCE_M))
    if tick is None:
        write_strip(renderer, path, simulation, near, FRAMES, COLUMNS)
    else:
        first, last = (tick + 1 + k * MOMENT_TICKS for k in (-1, 1))
        span = max(0.0, (first - 0.5) * TICK_S), min((last + 0.5) * TICK_S, scenario.duration_s)
        write_strip(renderer, path, simulation, near, 2 * MOMENT_TICKS + 1, 2 * MOMENT_TICKS + 1, *span)
    return path


def _slug(name: str) -> str:
    return "_".join("".join(c if c.isalnum() else " " for c in name.split(",")[0]).split())
