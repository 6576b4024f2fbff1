"""The worst cases of `brace bench --motion` to look at: filmstrips, drawn as `brace capture` draws them."""

from __future__ import annotations

from pathlib import Path

from demos.benchmarks.motion_cases import Case, scenario_of
from demos.benchmarks.motion_run import Row
from demos.benchmarks.motion_table import Figure
from engine.clips.clip import Clip
from engine.clips.library import find_clip

FRAMES, COLUMNS = 16, 8
SIZE_PX, DISTANCE_M = (300, 400), 3.7


def write_worst(figures: list[Figure], clips: dict[str, Clip], folder: Path) -> list[Path]:
    """One picture a case that is the worst of some figure, named after the figures; and a list of them, `worst.txt`."""
    from demos.filming import studio

    named: dict[Case, list[Figure]] = {}
    for figure in figures:
        if figure.worst is not None:
            named.setdefault(figure.worst["case"], []).append(figure)
    written, words = [], []
    with studio() as renderer:
        for case, worst_of in named.items():
            path = folder / f"case_{case.number:03d}_{_slug(worst_of[0].name)}.png"
            _draw(renderer, path, case, clips)
            written.append(path)
            words.append(f"{path.name}: {case}")
            words += [f"    {figure.name}: {figure.value:.4g}{_when(figure)}" for figure in worst_of]
    (folder / "worst.txt").write_text("\n".join(words) + "\n", encoding="utf-8")
    return written


def _draw(renderer, path: Path, case: Case, clips: dict[str, Clip]) -> None:
    from behaviours.simulation import Simulation
    from demos.commands.capture import write_strip
    from demos.filming import Shot, placed_for

    scenario = scenario_of(case)
    simulation = Simulation(scenario, lambda spec: clips.get(spec.clip) or find_clip(spec.clip))
    shot = placed_for(Shot(size_px=SIZE_PX), scenario)
    near = shot._replace(camera=(*shot.camera[:2], DISTANCE_M))
    write_strip(renderer, path, simulation, near, FRAMES, COLUMNS)


def _when(figure: Figure) -> str:
    """At which second of the run, where that is one moment."""
    row: Row = figure.worst or {}
    if figure.name.startswith("change of velocity"):
        return f", {row['snap'].what} at {row['snap'].tick / 120:.2f} s"
    by_phase = {"beyond": "limit_by_phase", "arms": "overlap_by_phase"}.get(figure.name.split()[0])
    if by_phase is None:
        return ""
    worst = max(row[by_phase].values(), key=lambda one: one.value)
    return f", {worst.what} at {worst.tick / 120:.2f} s"


def _slug(name: str) -> str:
    return "_".join("".join(c if c.isalnum() else " " for c in name.split(",")[0]).split())
