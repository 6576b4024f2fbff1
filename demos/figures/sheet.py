"""The paper that a figure is printed on: pictures, letters and lines, all in one hand.

Places are units from the top left corner, Y down, a full page being 1000 units wide; letters of size 15 are small
print. matplotlib draws, so formulas are TeX between dollars and a sheet may be saved as PDF or SVG, where letters and
lines stay sharp.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from demos.figures.stills import Still, Strip
from engine.core.errors import BadInput
from engine.core.files import whole_file
from engine.render.capture import check_output

PAGE_UNITS = 1000
UNITS_PER_INCH = 100
INK, FAINT, HAIR = "#2b3039", "#6b7380", "#b9bfc8"
TITLE, BODY, SMALL = 18, 15, 12.5  # sizes of letters, units
FORMATS = (".png", ".pdf", ".svg")
STYLE: dict[str, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "text.hinting": "none",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "svg.hashsalt": "brace",
}

Place = tuple[float, float]


class Sheet:
    """One figure, being drawn. `scale`: pixels of the saved picture for a unit."""

    def __init__(self, height: float, scale: float, width: float = PAGE_UNITS):
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        matplotlib.rcParams.update(STYLE)  # type: ignore[arg-type]
        self.width, self.height, self.scale = width, height, scale
        size_in = (width / UNITS_PER_INCH, height / UNITS_PER_INCH)
        self.figure = Figure(figsize=size_in, dpi=UNITS_PER_INCH * scale, facecolor="white")
        self.canvas = FigureCanvasAgg(self.figure)
        self.axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0), xlim=(0, width), ylim=(height, 0))
        self.axes.set_axis_off()

    def picture(self, still: Still | Strip, x: float, y: float) -> None:
        """A still with its top left corner there. Where stills overlap, the darker one shows: their paper is white."""
        width, height = still.size
        self.axes.imshow(
            _multiplied(still.pixels), extent=(x, x + width, y + height, y), interpolation="antialiased",
            aspect="auto", zorder=1,
        )  # fmt: skip
        self.axes.set(xlim=(0, self.width), ylim=(self.height, 0))

    def text(
        self, x: float, y: float, words: str, size: float = BODY, colour="ink", align: str = "left",
        valign: str = "top", bold: bool = False, italic: bool = False, halo: bool = False,
    ) -> None:  # fmt: skip
        """Words; `align` left, center or right of x, `valign` top, center, baseline or bottom of y."""
        made = self.axes.text(
            x, y, words, fontsize=_points(size), color=_colour(colour), ha=align, va=valign, linespacing=1.25,
            fontweight="bold" if bold else "normal", fontstyle="italic" if italic else "normal",
            zorder=10,
        )  # fmt: skip
        if halo:
            from matplotlib import patheffects

            made.set_path_effects([patheffects.withStroke(linewidth=_points(4), foreground="white")])

    def line(self, points: Sequence[Place], colour="ink", width: float = 1.4, dashed=False, layer: float = 5) -> None:
        xs, ys = zip(*points, strict=True)
        style = (0, (4, 3)) if dashed else "solid"
        self.axes.plot(
            xs, ys, color=_colour(colour), linewidth=_points(width), linestyle=style, zorder=layer,
            solid_capstyle="round", dash_capstyle="butt",
        )  # fmt: skip

    def arrow(
        self, tail: Place, tip: Place, colour="ink", width: float = 1.6, head: float = 7.0, both: bool = False
    ) -> None:  # fmt: skip
        """A filled arrow head on a line."""
        from matplotlib.patches import FancyArrowPatch

        style = f"{'<|-|>' if both else '-|>'},head_length={_points(head)},head_width={_points(0.42 * head)}"
        self.axes.add_patch(FancyArrowPatch(
            tail, tip, arrowstyle=style, color=_colour(colour),
            linewidth=_points(width), shrinkA=0, shrinkB=0, zorder=6, joinstyle="miter",
        ))  # fmt: skip

    def box(
        self, x: float, y: float, width: float, height: float, fill="none", edge="hair", round_by: float = 6.0,
        line: float = 1.2, layer: float = 2,
    ) -> None:  # fmt: skip
        from matplotlib.patches import FancyBboxPatch

        self.axes.add_patch(FancyBboxPatch(
            (x, y), width, height, boxstyle=f"round,pad=0,rounding_size={round_by}", linewidth=_points(line),
            facecolor=_colour(fill), edgecolor=_colour(edge), zorder=layer,
        ))  # fmt: skip

    def polygon(self, points: Any, fill="none", edge="ink", line: float = 1.4, layer: float = 4):
        from matplotlib.patches import Polygon

        self.axes.add_patch(Polygon(
            np.asarray(points, float), closed=True, facecolor=_colour(fill), edgecolor=_colour(edge),
            linewidth=_points(line), zorder=layer, joinstyle="round",
        ))  # fmt: skip

    def circle(self, centre: Place, radius: float, fill="none", edge="ink", line: float = 1.4, layer: float = 7):
        from matplotlib.patches import Circle

        self.axes.add_patch(Circle(
            centre, radius, facecolor=_colour(fill), edgecolor=_colour(edge), linewidth=_points(line),
            zorder=layer,
        ))  # fmt: skip

    def legend(
        self, x: float, y: float, entries: Sequence[tuple[Any, str]], size: float = BODY, gap: float = 26.0
    ) -> float:
        """Swatches with their words in one row from x on, its middle at y; returns where it ends."""
        for colour, words in entries:
            self.circle((x + 0.38 * size, y), 0.38 * size, fill=colour, edge="none")
            self.text(x + 1.1 * size, y, words, size, valign="center")
            x += 1.1 * size + self.width_of(words, size) + gap
        return x - gap

    def width_of(self, words: str, size: float = BODY) -> float:
        """How long a line of words becomes, units."""
        return self.size_of(words, size)[0]

    def size_of(self, words: str, size: float = BODY) -> tuple[float, float]:
        """Width and height of words, units."""
        probe = self.axes.text(0, 0, words, fontsize=_points(size))
        extent = probe.get_window_extent(self.canvas.get_renderer())
        probe.remove()
        return extent.width / self.scale, extent.height / self.scale

    @property
    def words(self) -> list[str]:
        """All that is written on the sheet."""
        return [text.get_text() for text in self.axes.texts]

    def pixels(self) -> np.ndarray:
        """(H, W, 3) uint8."""
        self.canvas.draw()
        return np.asarray(self.canvas.buffer_rgba())[..., :3].copy()

    def save(self, path) -> None:
        """Whole or not at all, in the format that the name ends in. BadInput for an unknown one."""
        kind = check_figure_output(path)
        with whole_file(path) as part:
            metadata = {".png": {"Software": None}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}[kind]
            self.figure.savefig(part, format=kind[1:], dpi=UNITS_PER_INCH * self.scale, metadata=metadata)


def check_figure_output(path) -> str:
    """The ending of a figure's file, if it can be written there."""
    kind = "." + str(path).rsplit(".", 1)[-1].lower()
    if kind not in FORMATS:
        raise BadInput("usage", f"a figure is saved as {', '.join(FORMATS)}", str(path))
    check_output(path)
    return kind


def number(value: float, digits: int = 2) -> str:
    """A number with a real minus sign, and no minus before nothing."""
    text = f"{value:.{digits}f}"
    return text.replace("-", "\N{MINUS SIGN}") if float(text) else text.lstrip("-")


def _points(units: float) -> float:
    return units * 72.0 / UNITS_PER_INCH


def _colour(name: Any) -> Any:
    return {"ink": INK, "faint": FAINT, "hair": HAIR}.get(name, name) if isinstance(name, str) else name


def _multiplied(pixels: np.ndarray) -> np.ndarray:
    """White paper as nothing at all, so that overlapping stills do not cut each other off: (H, W, 4) uint8."""
    alpha = np.where((pixels >= 254).all(axis=-1), 0, 255).astype(np.uint8)
    return np.dstack([pixels, alpha])
