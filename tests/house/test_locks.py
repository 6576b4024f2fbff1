"""The locks are what the distribution declares, whole, and bound to no place."""

import re
import tomllib

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.version import Version

from tests.conftest import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RUN, DEV = "requirements.lock", "requirements-dev.lock"


def locked(name: str) -> dict[str, tuple[str, str]]:
    """Package -> (version, the entry's whole text) of a lock file."""
    text = (ROOT / name).read_text(encoding="utf-8").replace("\\\n", " ")
    entries = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return {entry.split("==")[0]: (re.split(r"[\s;]", entry.split("==")[1])[0], entry) for entry in entries}


def hashes(entry: str) -> set[str]:
    return set(re.findall("sha256:[0-9a-f]+", entry))


@pytest.mark.parametrize("name", [RUN, DEV])
def test_every_entry_has_hashes_and_no_place(name):
    for package, (_, entry) in locked(name).items():
        assert re.search(r"--hash=sha256:[0-9a-f]{64}\b", entry), package
        assert "://" not in entry, package
        assert " @ " not in entry, package


@pytest.mark.parametrize(
    ("name", "declared"),
    [(RUN, PROJECT["project"]["dependencies"]), (DEV, PROJECT["dependency-groups"]["dev"])],
)
def test_what_is_declared_is_locked_within_its_bounds(name, declared):
    versions = locked(name)
    for line in declared:
        wanted = Requirement(line.split("#")[0])
        assert Version(versions[wanted.name][0]) in wanted.specifier, line


def test_tests_run_on_the_very_versions_that_are_shipped():
    run, dev = locked(RUN), locked(DEV)
    assert run.keys() <= dev.keys()
    for package, (version, entry) in run.items():
        assert dev[package][0] == version, package
        assert hashes(entry) == hashes(dev[package][1]), package


def test_the_set_up_script_accepts_the_pythons_that_are_declared():
    bounds = SpecifierSet(PROJECT["project"]["requires-python"])
    accepted = re.search(r"^\s*((?:3\.\d+ \| )*3\.\d+)\)$", (ROOT / "run").read_text(encoding="utf-8"), re.MULTILINE)
    listed = set(accepted[1].split(" | "))
    assert listed == {f"3.{minor}" for minor in range(30) if bounds.contains(f"3.{minor}.0")}
