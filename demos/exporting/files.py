"""Which file an ending asks for, and the bytes of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from demos.exporting.footage import PHASE_NAMES, Footage, Person
from engine.core.errors import BadInput

# what each kind keeps a second: every tick where numbers are wanted, what a screen shows where pictures are
USUAL_FPS = {".bvh": 120.0, ".npz": 120.0, ".glb": 60.0, ".html": 60.0}


def ending_of(path: str | Path) -> str:
    """The ending, if it is one of ours. BadInput otherwise."""
    ending = Path(path).suffix.lower()
    if ending not in USUAL_FPS:
        found = f"unknown ending {ending}" if ending else "no ending"
        raise BadInput("output", f"{found}, expected {', '.join(USUAL_FPS)}", str(path))
    return ending


def export_bytes(ending: str, footage: Footage, character: int, camera: tuple[float, float, float]) -> bytes:
    """The whole file. `character` (0-based): whose motion a .bvh or .npz is; the others hold everybody."""
    if ending == ".glb":
        from demos.exporting.glb import glb_bytes

        return glb_bytes(footage)
    if ending == ".html":
        from demos.exporting.html import html_bytes

        return html_bytes(footage, camera)
    person = footage.people[character]
    if ending == ".bvh":
        from engine.clips.write_bvh import bvh_text

        return bvh_text(person.body, person.pose, footage.fps).encode("ascii")
    from engine.clips.own_npz import npz_bytes

    return npz_bytes(run_arrays(footage, person))


def run_arrays(footage: Footage, person: Person) -> dict[str, np.ndarray]:
    """The arrays that `engine.clips.own_npz` documents, those of the run among them."""
    from engine.clips.own_npz import motion_arrays

    balls, frames = footage.balls, len(footage.time_s)
    return motion_arrays(person.body, person.pose, footage.fps, person.sex) | {
        "time_s": footage.time_s,
        "phase": person.phase,
        "phase_names": np.array(PHASE_NAMES),
        "planted": person.planted,
        "ball_radius_m": np.array([ball.radius_m for ball in balls], float),
        "ball_mass_kg": np.array([ball.mass_kg for ball in balls], float),
        "ball_seen": np.array([ball.seen for ball in balls], bool).reshape(-1, frames),
        "ball_m": np.array([ball.position_m for ball in balls], float).reshape(-1, frames, 3),
        "ball_wxyz": np.array([ball.turned for ball in balls], float).reshape(-1, frames, 4),
    }
