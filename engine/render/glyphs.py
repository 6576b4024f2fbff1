"""Letters as a picture: the font that Pillow carries, so every machine writes the same."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from engine.core.errors import EnvironmentTrouble

# what Pillow's own font can draw, and the nearest to what it cannot
LETTERS = "".join(chr(code) for code in range(32, 127)) + "°"
REPLACED = str.maketrans(
    {"–": "-", "—": "-", "−": "-", "×": "x", "·": ".", "’": "'", "…": "...", "µ": "u", "→": ">", "±": "~"}
)
_COLUMNS = 16


class GlyphAtlas:
    """All letters at one size. `picture` is (H, W, 2) uint8: the letters, and the letters with a halo."""

    def __init__(self, font_px: int):
        self.font = ImageFont.load_default(max(int(font_px), 6))
        if not isinstance(self.font, ImageFont.FreeTypeFont):
            raise EnvironmentTrouble("no-font", "Pillow was built without FreeType, so it cannot write labels")
        ascent, descent = self.font.getmetrics()
        self.halo_px = max(1, round(font_px / 7))
        self.line_px = ascent + descent
        self.advance_px = {letter: self.font.getlength(letter) for letter in LETTERS}
        self.cell_px = (int(np.ceil(max(self.advance_px.values()))) + 4 * self.halo_px, self.line_px + 2 * self.halo_px)
        self.picture = self._rasterised()

    def width_px(self, text: str) -> float:
        """How wide a line of text becomes."""
        return sum(self.advance_px[letter] for letter in drawable(text))

    def laid_out(self, text: str, x_px: float, y_px: float, colour) -> np.ndarray:
        """(N, 12): each letter's box on the picture, its box in the atlas (0..1), its colour. x, y: its top left."""
        rows, pen = [], float(round(x_px))
        height, width = self.picture.shape[:2]
        cell_width, cell_height = self.cell_px
        for letter in drawable(text):
            column, row = LETTERS.index(letter) % _COLUMNS, LETTERS.index(letter) // _COLUMNS
            box = (pen - 2 * self.halo_px, round(y_px) - self.halo_px, cell_width, cell_height)
            place = (column * cell_width / width, row * cell_height / height, cell_width / width, cell_height / height)
            if letter != " ":
                rows.append((*box, *place, *colour))
            pen += self.advance_px[letter]
        return np.array(rows, float).reshape(-1, 12)

    def _rasterised(self) -> np.ndarray:
        cell_width, cell_height = self.cell_px
        size = (cell_width * _COLUMNS, cell_height * -(-len(LETTERS) // _COLUMNS))
        plain, haloed = Image.new("L", size), Image.new("L", size)
        for count, letter in enumerate(LETTERS):
            corner = (count % _COLUMNS * cell_width + 2 * self.halo_px, count // _COLUMNS * cell_height + self.halo_px)
            ImageDraw.Draw(plain).text(corner, letter, fill=255, font=self.font)
            ImageDraw.Draw(haloed).text(
                corner, letter, fill=255, font=self.font, stroke_width=self.halo_px, stroke_fill=255
            )
        return np.stack([np.asarray(plain), np.asarray(haloed)], axis=-1)


def drawable(text: str) -> str:
    """The text in letters that the font has; what has no near neighbour becomes a question mark."""
    return "".join(letter if letter in LETTERS else "?" for letter in text.translate(REPLACED))
