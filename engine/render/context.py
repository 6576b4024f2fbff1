"""A place to draw: a real window, or the same thing without a screen. Nobody else asks which of the two it is.

    with make_context(headless=True, size=(1280, 720)) as context:
        renderer = Renderer(context)

Both have: `gl` (the moderngl context), `size_px` (the framebuffer, 0 x 0 while minimised), `scale` (framebuffer pixels
per window unit), `poll() -> list[Event]`, `present(framebuffer)`, `closing`, `set_title(text)`, `close()`; and
`when_lost`, called where the display goes away, before the process ends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import moderngl

from engine.core.errors import EnvironmentTrouble
from engine.render.events import Close, Event, Resize

GL_VERSION_CODE = 330  # GLSL 3.30 core, of 2010: every driver that still gets updates has it
INSTALL_HINT = "install the graphics libraries: apt-get install libegl1 libgl1"


class Context(Protocol):
    """What `make_context` gives back, with or without a screen."""

    gl: moderngl.Context
    when_lost: Callable[[], None]

    @property
    def size_px(self) -> tuple[int, int]: ...
    @property
    def scale(self) -> float: ...
    @property
    def closing(self) -> bool: ...
    def poll(self) -> list[Event]: ...
    def present(self, framebuffer: moderngl.Framebuffer) -> None: ...
    def set_title(self, title: str) -> None: ...
    def close(self) -> None: ...
    def __enter__(self) -> Context: ...
    def __exit__(self, *failure) -> None: ...


def make_context(headless: bool, size: tuple[int, int] = (1280, 720), title: str = "Brace") -> Context:
    """A window of that size in screen units, or an EGL context without any display.

    EnvironmentTrouble where the machine has no GL 3.3 or, for a window, no display.
    """
    if headless:
        return Offscreen(size)
    from engine.render.window import Window  # glfw is only needed by those who want to see something

    return Window(size, title)


class Offscreen:
    """EGL without a surface: needs neither display nor X. Events are whatever `push` was given, so tests drive it."""

    def __init__(self, size: tuple[int, int]):
        self.gl = create_gl(backend="egl")
        self.size_px = (int(size[0]), int(size[1]))
        self.scale = 1.0
        self.closing = False
        self.when_lost: Callable[[], None] = lambda: None
        self._waiting: list[Event] = []

    def push(self, *events: Event) -> None:
        """Queues events as if a user had caused them."""
        self._waiting.extend(events)

    def poll(self) -> list[Event]:
        """Everything since the last call, oldest first."""
        events, self._waiting = self._waiting, []
        for event in events:
            if isinstance(event, Resize):
                self.size_px = (event.width_px, event.height_px)
            self.closing = self.closing or isinstance(event, Close)
        return events

    def present(self, framebuffer: moderngl.Framebuffer) -> None:
        """There is no screen: the finished picture stays in the framebuffer, for read_rgb."""

    def set_title(self, title: str) -> None:
        """There is no title bar either."""

    def close(self) -> None:
        """Gives the GL context back; nothing made from it may be used afterwards."""
        self.closing = True
        self.gl.release()

    def __enter__(self) -> Offscreen:
        return self

    def __exit__(self, *failure) -> None:
        self.close()


def create_gl(backend: str | None = None) -> moderngl.Context:
    """A moderngl context on EGL (`backend="egl"`) or the current window; EnvironmentTrouble says what to install."""
    try:
        options: dict[str, Any] = {"standalone": True, "backend": backend} if backend else {}
        gl = moderngl.create_context(require=GL_VERSION_CODE, **options)
    except (
        Exception
    ) as trouble:  # moderngl raises bare Exception for a missing library, no device, or a version too old
        raise EnvironmentTrouble("no-gl", f"no OpenGL 3.3 here ({trouble}); {INSTALL_HINT}") from trouble
    gl.gc_mode = "auto"
    return gl


def check_gl(gl: moderngl.Context, doing: str) -> None:
    """moderngl keeps quiet about GL errors: after each frame this does not."""
    error = gl.error
    if error != "GL_NO_ERROR":
        raise EnvironmentTrouble(
            "gl-error", f"{error} while {doing} with {gl.info['GL_RENDERER']}; update the graphics driver"
        )
