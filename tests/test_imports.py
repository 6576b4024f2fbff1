"""The floor plan, walked: who may import whom, and which rooms alone may touch graphics, MuJoCo, the clock and chance.

A file's imports are read from its syntax tree, wherever they stand: lazily in a function, for type checkers alone, or
by `importlib.import_module("name")`.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
TOPS = ("engine", "behaviours", "shaders", "demos", "tests")

# room: what of ours it may import beside itself
FLOOR_PLAN = {
    "engine.core": (),
    "engine.maths": ("engine.core.errors",),
    "engine.body": ("engine.core", "engine.maths"),
    "engine.clips": ("engine.core", "engine.maths", "engine.body"),
    "engine.physics": ("engine.core", "engine.maths", "engine.body", "engine.clips"),
    "engine.render": ("engine.core", "engine.maths", "engine.body.skeleton", "engine.body.kinematics", "shaders"),
    "behaviours": ("engine.core", "engine.maths", "engine.body", "engine.clips", "engine.physics"),
    "shaders": (),
    "demos": ("engine", "behaviours", "shaders"),
    "tests": ("engine", "behaviours", "shaders", "demos"),
}

# stage of the behaviours: the other stages that it may import
STAGES = {
    "behaviours.rules": (),
    "behaviours.stance": (),
    "behaviours.blends": (),
    "behaviours.settle": ("blends",),
    "behaviours.perceive": ("settle",),
    "behaviours.protect": ("settle", "perceive", "rules"),
    "behaviours.recover": ("blends", "settle"),
    "behaviours.respond": ("settle", "recover"),
    "behaviours.measure": ("blends", "settle"),
}

# others' packages that only these modules may import
FENCED = {
    "moderngl": ("engine.render", "tests"),
    "glfw": ("engine.render", "tests"),
    "imgui_bundle": ("engine.render", "tests"),
    "OpenGL": ("engine.render", "tests"),
    "mujoco": ("engine.physics", "tests"),
    # the wall clock: the outer loop alone
    "time": ("demos", "engine.render.loop", "engine.render.window", "tests"),
    "datetime": ("demos", "tests"),
    # chance comes from the world's named streams
    "random": ("demos", "tests"),
    "secrets": ("demos", "tests"),
    "uuid": ("demos", "tests"),
    "numpy.random": ("demos", "tests"),
}


def module_of(path: Path) -> str:
    """`engine/core/world.py` -> `engine.core.world`; a package's `__init__.py` -> the package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def is_within(module: str, room: str) -> bool:
    return module == room or module.startswith(room + ".")


def room_of(module: str) -> str | None:
    return next((room for room in FLOOR_PLAN if is_within(module, room)), None)


def imports_of(tree: ast.AST, module: str, is_package: bool) -> Iterator[tuple[int, str]]:
    """(line, full dotted name) of everything imported, names taken from modules included."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = _base(node, module, is_package)
            yield from ((node.lineno, f"{base}.{alias.name}") for alias in node.names)
        elif isinstance(node, ast.Call) and _calls_import(node) and isinstance(node.args[0], ast.Constant):
            yield node.lineno, str(node.args[0].value)
        elif isinstance(node, ast.Attribute) and ast.unparse(node) in ("np.random", "numpy.random"):
            yield node.lineno, "numpy.random"


def _base(node: ast.ImportFrom, module: str, is_package: bool) -> str:
    """The absolute module that names are taken from, relative imports resolved."""
    if not node.level:
        return node.module or ""
    package = module.split(".") if is_package else module.split(".")[:-1]
    above = package[: len(package) - node.level + 1]
    return ".".join([*above, node.module] if node.module else above)


def _calls_import(node: ast.Call) -> bool:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    return name in ("import_module", "__import__") and bool(node.args)


def faults_of(source: str, module: str, is_package: bool = False) -> list[str]:
    """Every arrow of one file that the plan does not have, as `line: reason`."""
    room, imports = room_of(module), list(imports_of(ast.parse(source), module, is_package))
    if room is None:  # the bare package `engine` only holds the rooms together
        return [] if module == "engine" and not imports else [f"1: {module} lies in no room of the floor plan"]
    faults = []
    for line, name in imports:
        if name.split(".")[0] in TOPS and not any(is_within(name, allowed) for allowed in (room, *FLOOR_PLAN[room])):
            faults.append(f"{line}: {room} may not import {name}")
        for fenced, allowed_in in FENCED.items():
            if is_within(name, fenced) and not any(module.startswith(place) for place in allowed_in):
                faults.append(f"{line}: only {', '.join(allowed_in)} may import {fenced}")
    return faults


def strays_of(source: str, module: str, is_package: bool = False) -> list[str]:
    """Every import by one stage of the behaviours from another that does not come before it, as `line: reason`."""
    stage = next((stage for stage in STAGES if is_within(module, stage)), None)
    if stage is None:
        return []
    allowed = (stage, *(f"behaviours.{name}" for name in STAGES[stage]))
    others = [other for other in STAGES if other not in allowed]
    imports = imports_of(ast.parse(source), module, is_package)
    return [
        f"{line}: {stage} may not import {name}" for line, name in imports if any(is_within(name, o) for o in others)
    ]


def our_files() -> list[Path]:
    return sorted(path for top in TOPS for path in (ROOT / top).rglob("*.py"))


def top_imports(path: Path, module: str, known: Collection[str]) -> set[str]:
    """The other modules of ours that must be loaded before this one."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    top = ast.Module([node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)], [])
    names = [name for _, name in imports_of(top, module, path.name == "__init__.py")]
    found = {name if name in known else name.rpartition(".")[0] for name in names}
    return {name for name in found if name in known and name != module}


def test_every_import_follows_the_floor_plan():
    faults = []
    for path in our_files():
        found = faults_of(path.read_text(encoding="utf-8"), module_of(path), path.name == "__init__.py")
        faults += [f"{path.relative_to(ROOT)}:{fault}" for fault in found]
    assert not faults, "\n".join(faults)


def test_the_stages_of_the_behaviours_build_on_each_other_one_way():
    strays = []
    for path in our_files():
        found = strays_of(path.read_text(encoding="utf-8"), module_of(path), path.name == "__init__.py")
        strays += [f"{path.relative_to(ROOT)}:{stray}" for stray in found]
    assert not strays, "\n".join(strays)
    TopologicalSorter({stage: [f"behaviours.{name}" for name in STAGES[stage]] for stage in STAGES}).prepare()
    folders = {path.parent.name for path in (ROOT / "behaviours").glob("*/__init__.py")}
    assert {f"behaviours.{name}" for name in folders} == set(STAGES)


def test_a_stray_between_stages_is_seen():
    assert strays_of("from behaviours.protect.task import Task", "behaviours.blends.lying")
    assert not strays_of("from behaviours.blends import lying", "behaviours.settle.sources")
    assert not strays_of("from behaviours.protect.task import Task", "behaviours.reaction")


def test_the_walk_reaches_every_room():
    rooms = {room_of(module_of(path)) for path in our_files()}
    assert rooms - {None} == set(FLOOR_PLAN)


def test_no_two_modules_need_each_other():
    """Imports at the top of files, those for type checkers aside: the graph of modules has no loop."""
    modules = {module_of(path): path for path in our_files()}
    graph = {module: top_imports(path, module, modules.keys()) for module, path in modules.items()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as loop:
        pytest.fail(" <- ".join(loop.args[1]))


@pytest.mark.parametrize(
    ("module", "line", "fault"),
    [
        ("engine.core.world", "from engine.maths import vector", "engine.core may not import engine.maths.vector"),
        ("engine.core.world", "from .. import maths", "engine.core may not import engine.maths"),
        ("engine.maths.vector", "import engine.core.world", "engine.maths may not import engine.core.world"),
        ("engine.maths.vector", "from engine.core import world", "engine.maths may not import engine.core.world"),
        ("engine.body.support", "from engine.clips.tracks import Clip", "may not import engine.clips.tracks.Clip"),
        ("engine.render.camera", "from engine.body import limits", "may not import engine.body.limits"),
        ("engine.render.camera", "import behaviours", "engine.render may not import behaviours"),
        ("behaviours.perceive.senses", "from engine import render", "behaviours may not import engine.render"),
        ("behaviours.perceive.senses", "def f():\n    import demos.cli", "behaviours may not import demos.cli"),
        ("demos.cli", "from tests import conftest", "demos may not import tests.conftest"),
        ("demos.cli", "import moderngl", "only engine.render, tests may import moderngl"),
        ("demos.cli", "import importlib\nimportlib.import_module('mujoco')", "only engine.physics, tests"),
        (
            "engine.core.clock",
            "from time import perf_counter",
            "only demos, engine.render.loop, engine.render.window, tests",
        ),
        ("engine.render.camera", "import time", "tests may import time"),
        ("behaviours.perceive.senses", "import numpy as np\nx = np.random.rand()", "may import numpy.random"),
        ("engine.stray", "import os", "engine.stray lies in no room"),
    ],
)
def test_a_wrong_arrow_is_seen(module, line, fault):
    assert any(fault in found for found in faults_of(line, module))


def test_a_loop_is_seen(tmp_path):
    """Only what must be loaded first counts; what a type checker alone reads makes no loop."""
    (tmp_path / "one.py").write_text("from engine.core import two\n")
    (tmp_path / "two.py").write_text("from engine.core.one import f\nif TYPE_CHECKING:\n    import engine.core.three\n")
    known = ("engine.core.one", "engine.core.two", "engine.core.three")
    assert top_imports(tmp_path / "one.py", "engine.core.one", known) == {"engine.core.two"}
    assert top_imports(tmp_path / "two.py", "engine.core.two", known) == {"engine.core.one"}


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("engine.maths.vector", "from engine.core.errors import BadInput"),
        ("engine.core.world", "from engine.core.random import Stream"),
        ("engine.core.world", "from .random import Stream"),
        ("engine.render.window", "import time"),
        ("engine.render.window_input", "import time, glfw"),
        ("engine.physics.model", "import mujoco"),
        ("demos.cli", "from behaviours.reaction import react"),
    ],
)
def test_a_right_arrow_is_let_through(module, line):
    assert faults_of(line, module) == []
