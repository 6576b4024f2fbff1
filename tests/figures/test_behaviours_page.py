"""The page about the behaviours tells the truth: its links lead somewhere, its functions are where it says."""

from __future__ import annotations

import re

import pytest
from PIL import Image

from demos.figures import FIGURES
from demos.figures.pictures import FOLDER, SHOWN
from tests.conftest import ROOT

PAGE = ROOT / "behaviours" / "README.md"
TEXT = PAGE.read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in TEXT.splitlines() if line.startswith("| ")]
TABLES = [row for row in ROWS if re.search(r"\]\(\S+\.py\)", " ".join(row))]
MOST_BYTES = 600_000
MOST_BYTES_OF_A_FILM = 3_000_000


def test_links_lead_somewhere():
    targets = re.findall(r"\]\(([^)]+)\)", TEXT)
    assert len(targets) > 60
    assert [target for target in targets if not (PAGE.parent / target).exists()] == []


@pytest.mark.parametrize("row", TABLES, ids=lambda row: row[0][:40])
def test_functions_are_where_the_page_says(row):
    (file,) = re.findall(r"\]\((\S+\.py)\)", " ".join(row))
    source = (PAGE.parent / file).read_text(encoding="utf-8")
    names = re.findall(r"`(\w+)`", row[3])
    assert names
    for name in names:
        assert re.search(rf"^(?:def|class) {name}\b", source, re.MULTILINE), f"{name} in {file}"


def test_figures_of_the_table_exist():
    known = {entry.name for entry in FIGURES}
    named = {name for row in TABLES if len(row) == 5 for name in row[4].split(", ") if name}
    assert named <= known
    # all figures but those of the introduction and of the skeleton belong to a part of the behaviours
    assert known - named == {"2.1", "3.1"}


def test_the_pictures_are_whole_and_small():
    shown = re.findall(r"\]\(pictures/(\S+)\.png\)", TEXT)
    drawn = sorted(FOLDER.glob("*.png"))
    assert sorted(shown) == sorted(SHOWN) == sorted(path.stem for path in drawn)
    for name in shown:
        with Image.open(FOLDER / f"{name}.png") as picture:
            picture.load()
            assert picture.width >= 500
    assert sum(path.stat().st_size for path in drawn) < MOST_BYTES


def test_the_film_of_the_front_page_moves_and_is_the_only_other_picture():
    (film,) = [path for path in FOLDER.iterdir() if path.suffix != ".png"]
    assert f"behaviours/pictures/{film.name}" in (ROOT / "README.md").read_text(encoding="utf-8")
    assert film.stat().st_size < MOST_BYTES_OF_A_FILM
    with Image.open(film) as frames:
        assert frames.n_frames > 20
        first = frames.convert("RGB").tobytes()
        frames.seek(frames.n_frames // 2)
        assert frames.convert("RGB").tobytes() != first
