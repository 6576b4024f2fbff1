"""Every failure's code stands in one table, and everything in the table can happen."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import pytest

from engine.core.errors import CODES
from tests.conftest import ROOT

RAISED = ("BadInput", "EnvironmentTrouble", "ReplayDiverged")


def codes_of(source: str) -> Iterator[str]:
    """The codes of all errors that a source text makes; `code if this else that` has two."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in RAISED:
            said = node.args[0]
            for part in (said.body, said.orelse) if isinstance(said, ast.IfExp) else (said,):
                if isinstance(part, ast.Attribute) and part.attr == "code":
                    continue  # another error's, passed on with its place
                assert isinstance(part, ast.Constant), f"a code that only the run knows: {ast.unparse(node)}"
                yield part.value


def all_codes() -> set[str]:
    sources = [path for room in ("engine", "behaviours", "demos") for path in (ROOT / room).rglob("*.py")]
    said = {code for path in sources for code in codes_of(path.read_text(encoding="utf-8"))}
    return said | set(re.findall(r"\bfail \d (\S+)", (ROOT / "run").read_text(encoding="utf-8")))


def test_a_walk_finds_both_codes_of_an_alternative_and_none_that_is_passed_on():
    source = "raise BadInput('asf' if skeleton else 'amc', 'text')\nraise EnvironmentTrouble('no-gl', 'text')"
    assert list(codes_of(source + "\nraise BadInput(trouble.code, 'text', 'file')")) == ["asf", "amc", "no-gl"]


def test_what_is_raised_is_what_the_table_lists():
    assert all_codes() == set(CODES)


@pytest.mark.parametrize("code", CODES)
def test_codes_are_words_with_hyphens(code):
    assert re.fullmatch(r"[a-z]+(-[a-z]+)*", code)
