"""A whole reaction and a picture, without a window: compiles the kernels and sculpts the body that windows need."""

from __future__ import annotations

from pathlib import Path

from demos.filming import studio
from demos.running import open_scenario
from demos.set_up import compile_what_changed
from demos.stage import scene_of
from demos.window.session import Session
from engine.render.camera import Camera


def main() -> None:
    compile_what_changed()
    session = Session(*open_scenario("sway"), Path(), lambda: 0.0)
    for _ in range(3):
        session.advance(1.0)
    with studio() as renderer:
        renderer.draw(scene_of(session.world), Camera(), (64, 64))


if __name__ == "__main__":
    main()
