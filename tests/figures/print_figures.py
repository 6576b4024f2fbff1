"""Draws figures into a folder, in a process of its own: `python print_figures.py FOLDER NAME ...`.

Beside each picture NAME.png goes what is written on it, NAME.json; `stills.json` says where stills believe points of
the world to be, and where they are on the picture; `again.png` is the first figure once more.
"""

import json
import sys
from pathlib import Path

import numpy as np

from demos.figures import draw_figure
from demos.figures.press import Press
from demos.figures.stills import Look
from demos.filming import studio
from engine.core.debug_draw import DebugDraw
from engine.render.scene import Scene

SCALE = 0.4


def main(folder: Path, names: list[str]) -> None:
    with studio() as renderer:
        (folder / "stills.json").write_text(json.dumps(probe_stills(Press(renderer, 1.5))))
        for name in names:
            press = Press(renderer, SCALE)
            sheet = draw_figure(name, press)
            sheet.save(folder / f"{name}.png")
            if name == names[0]:
                draw_figure(name, press).save(folder / "again.png")
            (folder / f"{name}.json").write_text(json.dumps({"words": sheet.words, "missing": press.missing}))


def probe_stills(press: Press) -> dict:
    """A red dot of the world in a still and at both ends of a strip; and how white the paper is."""
    dot, around = (0.3, -0.2, 1.1), [(-0.6, -0.6, 0.0), (0.6, 0.6, 1.9)]
    marks, look = DebugDraw(), Look(-40.0, 20.0)
    marks.point(dot, 0.05, (1.0, 0.0, 0.0))
    still = press.still(Scene(draw=marks), look, 200.0, around)
    strip = press.strip([Scene(draw=marks), Scene(), Scene(draw=marks)], look, 400.0, 1.0, around)
    half = strip.pixels.shape[1] // 2
    first, last = red_at(strip.pixels[:, :half]), red_at(strip.pixels[:, half:])
    return {
        "paper": int(still.pixels[:20].min()),
        "seen": [(c / press.scale).tolist() for c in (red_at(still.pixels), first, last + (half, 0))],
        "said": [still.at(dot), strip.at(0, dot), strip.at(2, dot)],
    }


def red_at(pixels: np.ndarray) -> np.ndarray:
    """The middle of what is red (2,), pixels."""
    rows, columns = np.nonzero((pixels[..., 0] > 180) & (pixels[..., 1] < 120))
    return np.array([columns.mean() + 0.5, rows.mean() + 0.5])


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
