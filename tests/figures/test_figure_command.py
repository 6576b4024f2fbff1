"""`brace figure`: its list, its files, its refusals."""

from __future__ import annotations

import pytest
from PIL import Image

from demos.cli import main
from demos.figures import FIGURES
from demos.figures.sheet import Sheet
from tests.house.conftest import brace as brace


def error_of(capsys) -> str:
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    return err


def test_the_list_names_every_figure(capsys):
    assert main(["figure", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [entry.name for entry in FIGURES]


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (["figure", "3.99", "-o", "a.png"], 2, "unknown figure '3.99'; expected one of 3.9"),
        (["figure", "4.1"], 2, "needs -o FILE.png"),
        (["figure", "all"], 2, "needs -o FOLDER"),
        (["figure", "4.1", "-o", "a.bmp"], 2, ".png, .pdf, .svg"),
        (["figure", "4.1", "-o", "no/such/folder/a.png"], 3, "no folder"),
        (["figure", "4.1", "-o", "a.png", "--scale", "99"], 2, "0.2 to 8"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_line(capsys, monkeypatch, tmp_path, words, code, told):
    monkeypatch.chdir(tmp_path)
    assert main(words) == code
    assert told in error_of(capsys)
    assert list(tmp_path.iterdir()) == []


def test_a_file_where_the_folder_of_all_should_be_is_refused(capsys, tmp_path):
    (tmp_path / "taken").write_text("mine")
    assert main(["figure", "all", "-o", str(tmp_path / "taken")]) == 3
    assert "folder" in error_of(capsys)


@pytest.mark.parametrize(("ending", "begins"), [("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_a_sheet_is_saved_in_the_format_of_its_name(tmp_path, ending, begins):
    path = tmp_path / f"sheet.{ending}"
    sheet = Sheet(60.0, 0.5)
    sheet.text(10, 10, "time to contact")
    sheet.save(path)
    data = path.read_bytes()
    assert data.startswith(begins)
    assert (b"time to contact" in data) == (ending == "svg")  # letters stay letters
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


def test_a_figure_is_drawn_and_the_embedded_clip_owned_up_to(brace, tmp_path):
    done = brace("figure", "5.1", "-o", "a.png", "--scale", "0.3", BRACE_CACHE=str(tmp_path / "empty"))
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == "figure 5.1: `sway` stands in for walk, which `brace clips fetch` brings\n"
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size[0] == 300
