"""A real window through glfw: the same interface as `context.Offscreen`, events as plain data."""

from __future__ import annotations

import ctypes
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import glfw
import moderngl

from engine.core.errors import EnvironmentTrouble
from engine.render import events as ev
from engine.render.context import INSTALL_HINT, create_gl

DOUBLE_CLICK_S, DOUBLE_CLICK_PX = 0.35, 6.0

# names that glfw does not give because they print nothing, or that are better as words
_KEY_NAMES = {
    glfw.KEY_SPACE: "space", glfw.KEY_ESCAPE: "escape", glfw.KEY_ENTER: "enter", glfw.KEY_TAB: "tab",
    glfw.KEY_BACKSPACE: "backspace", glfw.KEY_INSERT: "insert", glfw.KEY_DELETE: "delete", glfw.KEY_RIGHT: "right",
    glfw.KEY_LEFT: "left", glfw.KEY_DOWN: "down", glfw.KEY_UP: "up", glfw.KEY_PAGE_UP: "page_up",
    glfw.KEY_PAGE_DOWN: "page_down", glfw.KEY_HOME: "home", glfw.KEY_END: "end",
    glfw.KEY_LEFT_SHIFT: "shift", glfw.KEY_RIGHT_SHIFT: "shift", glfw.KEY_LEFT_CONTROL: "ctrl",
    glfw.KEY_RIGHT_CONTROL: "ctrl", glfw.KEY_LEFT_ALT: "alt", glfw.KEY_RIGHT_ALT: "alt",
    **{glfw.KEY_F1 + k: f"f{k + 1}" for k in range(12)},
}  # fmt: skip
_ACTIONS = {glfw.PRESS: "press", glfw.RELEASE: "release", glfw.REPEAT: "repeat"}
_MODIFIERS = glfw.MOD_SHIFT | glfw.MOD_CONTROL | glfw.MOD_ALT | glfw.MOD_SUPER  # the same bits as in events.py


class Window:
    """One window with a GL 3.3 core context. Only one at a time: glfw is global."""

    def __init__(self, size: tuple[int, int], title: str):
        self._handle = _open(size, title)
        self._waiting: list[ev.Event] = []
        self.when_lost: Callable[[], None] = lambda: None
        _watch_display(self)
        self._last_press: tuple[float, int, float, float] = (-1.0, -1, 0.0, 0.0)
        try:
            glfw.make_context_current(self._handle)
            self.gl = create_gl()
        except BaseException:
            glfw.terminate()
            raise
        glfw.swap_interval(1)
        self._cursor_px = self._in_pixels(*glfw.get_cursor_pos(self._handle))
        self._listen()

    @property
    def size_px(self) -> tuple[int, int]:
        """The framebuffer; (0, 0) while minimised, whatever the system says then."""
        if glfw.get_window_attrib(self._handle, glfw.ICONIFIED):
            return (0, 0)
        return glfw.get_framebuffer_size(self._handle)

    @property
    def scale(self) -> float:
        """Framebuffer pixels for one of an ordinary screen: 2 on most high-DPI screens."""
        return max(glfw.get_window_content_scale(self._handle)[0], 0.5)

    @property
    def closing(self) -> bool:
        return bool(glfw.window_should_close(self._handle))

    def poll(self) -> list[ev.Event]:
        """Everything since the last call, oldest first. A minimised window waits a little instead of spinning."""
        if self.size_px == (0, 0):
            glfw.wait_events_timeout(0.1)
        else:
            glfw.poll_events()
        events, self._waiting = self._waiting, []
        return events

    def present(self, framebuffer: moderngl.Framebuffer) -> None:
        """Shows a picture; one of another size (just resized) is shown as far as it fits."""
        if self.size_px == (0, 0):
            return
        screen = self.gl.detect_framebuffer(0)
        self.gl.copy_framebuffer(screen, framebuffer)
        glfw.swap_buffers(self._handle)

    def set_title(self, title: str) -> None:
        glfw.set_window_title(self._handle, title)

    def close(self) -> None:
        """Closes the window and lets glfw go."""
        self.gl.release()
        glfw.destroy_window(self._handle)
        glfw.terminate()

    def __enter__(self) -> Window:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def _listen(self) -> None:
        handle, push = self._handle, self._waiting_push
        glfw.set_key_callback(handle, self._on_key)
        glfw.set_char_callback(handle, lambda _, code: push(ev.Text(chr(code))))
        glfw.set_cursor_pos_callback(handle, self._on_move)
        glfw.set_mouse_button_callback(handle, self._on_button)
        glfw.set_scroll_callback(handle, lambda _, x, y: push(ev.Scroll(x, y, *self._cursor_px)))
        glfw.set_framebuffer_size_callback(handle, lambda _, width, height: push(ev.Resize(width, height)))
        glfw.set_drop_callback(handle, self._on_drop)  # type: ignore[arg-type]
        glfw.set_window_close_callback(handle, lambda _: push(ev.Close()))

    def _waiting_push(self, event: ev.Event) -> None:
        self._waiting.append(event)

    def _on_key(self, _, key: int, scancode: int, action: int, modifiers: int) -> None:
        name = _KEY_NAMES.get(key) or glfw.get_key_name(key, scancode)
        if name:
            self._waiting_push(ev.Key(name.lower(), _ACTIONS[action], modifiers & _MODIFIERS))

    def _on_drop(self, _, paths) -> None:
        self._waiting_push(ev.Drop(tuple(paths)))

    def _on_move(self, _, x: float, y: float) -> None:
        place = self._in_pixels(x, y)
        self._waiting_push(ev.MouseMove(*place, place[0] - self._cursor_px[0], place[1] - self._cursor_px[1]))
        self._cursor_px = place

    def _on_button(self, _, button: int, action: int, modifiers: int) -> None:
        x, y = self._cursor_px  # where it was then: asked now, glfw would tell where it is by now
        clicks = self._clicks(button, x, y) if action == glfw.PRESS else 1
        self._waiting_push(ev.MouseButton(button, action == glfw.PRESS, x, y, modifiers & _MODIFIERS, clicks))

    def _clicks(self, button: int, x: float, y: float) -> int:
        """2 where this press makes a double click with the last."""
        now = time.monotonic()
        then, last_button, last_x, last_y = self._last_press
        near = abs(x - last_x) + abs(y - last_y) < DOUBLE_CLICK_PX * self.scale
        double = button == last_button and near and now - then < DOUBLE_CLICK_S
        self._last_press = (-1.0, -1, 0.0, 0.0) if double else (now, button, x, y)
        return 2 if double else 1

    def _in_pixels(self, x: float, y: float) -> tuple[float, float]:
        """Window units to framebuffer pixels: they differ on some systems with high-DPI screens."""
        window, pixels = glfw.get_window_size(self._handle), glfw.get_framebuffer_size(self._handle)
        return (x * pixels[0] / max(window[0], 1), y * pixels[1] / max(window[1], 1))


def _watch_display(window: Window) -> None:
    """Where the X server goes away the process ends in one line and the code for it: Xlib would end it anyway, and its
    connection, and with it the GL context, can no longer be used for anything. What needs neither is done before, by
    the window's `when_lost`. Does nothing without X11.
    """

    def end(_) -> int:
        try:
            window.when_lost()
        finally:  # nothing may go back into Xlib
            trouble = EnvironmentTrouble("display-lost", "the display has gone away, and the window with it")
            print(trouble.line(), file=sys.stderr, flush=True)
            os._exit(trouble.exit_code)

    try:
        ended = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(end)
        ctypes.CDLL("libX11.so.6").XSetIOErrorHandler(ended)
    except (OSError, AttributeError):
        return
    _kept_for_xlib.append(ended)


_kept_for_xlib: list[Any] = []  # callbacks that C may call for as long as the process lives


def _open(size: tuple[int, int], title: str):
    """A glfw window, or EnvironmentTrouble: no display, or no GL 3.3 on it."""
    glfw.ERROR_REPORTING = "ignore"  # we ask and say it ourselves, in one line
    if not glfw.init():
        raise EnvironmentTrouble(
            "no-display", f"no window can be opened here ({_why()}); without a display use: brace capture"
        )
    glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, 3)
    glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, 3)
    glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
    glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
    glfw.window_hint(glfw.SAMPLES, 0)  # the renderer has its own samples
    glfw.window_hint(glfw.SCALE_TO_MONITOR, True)
    handle = glfw.create_window(int(size[0]), int(size[1]), title, None, None)
    if not handle:
        why = _why()
        glfw.terminate()
        raise EnvironmentTrouble("no-gl", f"no window with OpenGL 3.3 ({why}); {INSTALL_HINT}")
    glfw.set_window_size_limits(handle, 160, 120, glfw.DONT_CARE, glfw.DONT_CARE)
    return handle


def _why() -> str:
    """glfw's own last words."""
    code, said = glfw.get_error()  # bytes, whatever its stub says
    text = said.decode("utf-8", "replace") if said else ""  # type: ignore[attr-defined]
    return text or f"glfw error {code}"
