"""`brace bench --motion` as a user runs it: several processes, filmstrips of the worst, and numbers for programs."""

import json

import pytest

from demos.benchmarks import motion
from demos.benchmarks.motion_table import figures_of


def test_it_measures_films_and_reports(brace, tmp_path, library_clip):
    library_clip("walk")
    done = brace("bench", "--motion", "--cases", "2", "--seed", "3", "--out", "films", "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert (report["cases"], report["knock_downs"]) == (2, 1)
    films = sorted(path.name for path in (tmp_path / "films").glob("case_*.png"))
    assert films
    words = (tmp_path / "films" / "worst.txt").read_text(encoding="utf-8")
    assert all(name in words for name in films)
    # one process, here, comes to the same
    found = motion.bench(2, 3, processes=1)
    alone = {one.name: one for one in figures_of(found.rows, found.poses)}
    assert [one["name"] for one in report["figures"]] == list(alone)
    for one in report["figures"]:
        if "tick of protection" not in one["name"]:
            assert one["value"] == pytest.approx(alone[one["name"]].value, rel=1e-12, abs=1e-12, nan_ok=True), one[
                "name"
            ]


def test_no_cases_are_refused(brace):
    done = brace("bench", "--motion", "--cases", "0")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("error[usage]: argument --cases: found '0', expected a whole number from 1")
