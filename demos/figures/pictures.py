"""The small pictures of behaviours/README.md, drawn anew: `python -m demos.figures.pictures`."""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

from demos.cli import guarded
from demos.figures import draw_figure
from demos.figures.press import Press
from demos.filming import studio
from engine.core.files import whole_file

FOLDER = Path(__file__).resolve().parents[2] / "behaviours" / "pictures"
SHOWN = ("1.1", "1.2", "2.1", "3.2", "3.9", "4.1", "5.2")
SCALE, SHARE, COLOURS = 2.0, 0.6, 255  # drawn large and made small: smooth edges; a palette keeps the repository small


def main() -> None:
    """Draws them all from the clips that are here."""
    FOLDER.mkdir(exist_ok=True)
    with studio() as renderer:
        for name in SHOWN:
            picture = Image.fromarray(draw_figure(name, Press(renderer, SCALE)).pixels()).convert("RGB")
            size = (round(SHARE * picture.width), round(SHARE * picture.height))
            small = picture.resize(size, Image.Resampling.LANCZOS).quantize(COLOURS, dither=Image.Dither.NONE)
            with whole_file(FOLDER / f"{name}.png") as part:
                small.save(part, format="PNG", optimize=True)


if __name__ == "__main__":
    sys.exit(guarded(main))
