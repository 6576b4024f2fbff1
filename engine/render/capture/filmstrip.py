"""A film on one sheet: pictures side by side with their captions, for papers, READMEs and reviews."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from engine.core.errors import BadInput
from engine.render.capture.pictures import write_png
from engine.render.capture.video import checked_frames
from engine.render.glyphs import drawable

PAPER, INK, FAINT = (250, 250, 251), (52, 58, 68), (112, 119, 130)
_FINE = 4  # rounded corners are drawn this many times finer, then averaged


def write_filmstrip(
    path, pictures: Sequence[np.ndarray], captions: Sequence[str], *, columns: int | None = None, title: str = ""
) -> None:
    """Composes and writes one PNG; see `compose_filmstrip`."""
    write_png(path, compose_filmstrip(pictures, captions, columns=columns, title=title))


def compose_filmstrip(
    pictures: Sequence[np.ndarray], captions: Sequence[str], *, columns: int | None = None, title: str = ""
) -> np.ndarray:
    """(H, W, 3) uint8: the pictures in reading order, all in one row unless told, each over its caption.

    A caption's first line is ink, further lines are fainter. BadInput where sizes or numbers differ.
    """
    pictures = list(checked_frames(pictures, "filmstrip"))
    if len(captions) != len(pictures):
        raise BadInput("filmstrip", f"{len(captions)} captions for {len(pictures)} pictures")
    columns = min(columns or len(pictures), len(pictures))
    rows = -(-len(pictures) // columns)
    height, width = pictures[0].shape[:2]
    font_px = int(np.clip(round(height / 17), 11, 26))
    gap, margin, line = max(6, height // 40), max(14, height // 18), round(1.4 * font_px)
    lines = max((caption.count("\n") + 1 for caption in captions if caption), default=0)
    pitch = (width + gap, height + gap + (line * lines + gap if lines else 0))
    top = margin + (2 * line if title else 0)
    sheet = Image.new("RGB", (2 * margin + columns * pitch[0] - gap, top + rows * pitch[1] - gap + margin), PAPER)
    draw = ImageDraw.Draw(sheet)
    if title:
        draw.text((margin, margin - line // 4), drawable(title), INK, ImageFont.load_default(round(1.25 * font_px)))
    window, font = _rounded(width, height, max(3, height // 60)), ImageFont.load_default(font_px)
    for number, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        corner = (margin + number % columns * pitch[0], top + number // columns * pitch[1])
        sheet.paste(Image.fromarray(picture), corner, window)
        for row, text in enumerate(caption.split("\n")):
            place = (corner[0] + 1, corner[1] + height + gap // 2 + row * line)
            draw.text(place, _fitting(drawable(text), font, width), INK if row == 0 else FAINT, font)
    return np.asarray(sheet)


def _rounded(width: int, height: int, radius: int) -> Image.Image:
    """A mask with smooth round corners."""
    mask = Image.new("L", (width * _FINE, height * _FINE))
    ImageDraw.Draw(mask).rounded_rectangle((0, 0, width * _FINE - 1, height * _FINE - 1), radius * _FINE, fill=255)
    return mask.resize((width, height), Image.Resampling.BOX)


def _fitting(text: str, font, width: int) -> str:
    """The text, shortened at its end until it fits."""
    if font.getlength(text) <= width:
        return text
    while text and font.getlength(text + "...") > width:
        text = text[:-1]
    return text.rstrip() + "..."
