"""Dropping a file on a window, as a file manager does it: the source's side of the XDND protocol, version 5."""

from __future__ import annotations

import ctypes
import time
from pathlib import Path

VERSION = 5
CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31
Id, Long, Int, Pointer = ctypes.c_ulong, ctypes.c_long, ctypes.c_int, ctypes.c_void_p


class Message(ctypes.Structure):
    """Xlib's XClientMessageEvent."""

    _fields_ = (
        ("type", Int), ("serial", Id), ("send_event", Int), ("display", Pointer), ("window", Id),
        ("message_type", Id), ("format", Int), ("data", Long * 5),
    )  # fmt: skip


class Request(ctypes.Structure):
    """Xlib's XSelectionRequestEvent."""

    _fields_ = (
        ("type", Int), ("serial", Id), ("send_event", Int), ("display", Pointer), ("owner", Id), ("requestor", Id),
        ("selection", Id), ("target", Id), ("property", Id), ("time", Id),
    )  # fmt: skip


class Answer(ctypes.Structure):
    """Xlib's XSelectionEvent."""

    _fields_ = (
        ("type", Int), ("serial", Id), ("send_event", Int), ("display", Pointer), ("requestor", Id),
        ("selection", Id), ("target", Id), ("property", Id), ("time", Id),
    )  # fmt: skip


class AnyEvent(ctypes.Union):
    _fields_ = (("type", Int), ("message", Message), ("request", Request), ("answer", Answer), ("room", Long * 24))


def drop(display_name: str, window: int, place: tuple[int, int], path: Path, patience_s: float) -> bool:
    """Drags a file over a window at a place of the screen and lets go. Whether the window said that it took it."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = Pointer
    for name in ("XInternAtom", "XDefaultRootWindow", "XCreateSimpleWindow"):
        getattr(x, name).restype = Id
    display = Pointer(x.XOpenDisplay(display_name.encode()))
    try:
        return _drop(x, display, Id(window), place, path, time.monotonic() + patience_s)
    finally:
        x.XCloseDisplay(display)


def _drop(x, display, window: Id, place: tuple[int, int], path: Path, until_s: float) -> bool:
    def atom(name: str) -> int:
        return x.XInternAtom(display, name.encode(), 0)

    def send(name: str, *data: int) -> None:
        message = Message(CLIENT_MESSAGE, window=window.value, message_type=atom(name), format=32)
        message.data[: len(data)] = data
        x.XSendEvent(display, window, 0, Long(0), ctypes.byref(AnyEvent(message=message)))
        x.XFlush(display)

    source = Id(x.XCreateSimpleWindow(display, Id(x.XDefaultRootWindow(display)), -9, -9, 1, 1, 0, Id(0), Id(0)))
    x.XSetSelectionOwner(display, Id(atom("XdndSelection")), source, Id(0))
    send("XdndEnter", source.value, VERSION << 24, atom("text/uri-list"))
    send("XdndPosition", source.value, 0, place[0] << 16 | place[1], 0, atom("XdndActionCopy"))
    event, dropped = AnyEvent(), False
    while time.monotonic() < until_s:
        if not x.XPending(display):
            time.sleep(0.01)
            continue
        x.XNextEvent(display, ctypes.byref(event))
        if event.type == SELECTION_REQUEST:
            _hand_over(x, display, event.request, path)
        elif event.type == CLIENT_MESSAGE and event.message.message_type == atom("XdndStatus") and not dropped:
            send("XdndDrop", source.value, 0, 0)
            dropped = True
        elif event.type == CLIENT_MESSAGE and event.message.message_type == atom("XdndFinished"):
            return event.message.data[1] != 0
    return False


def _hand_over(x, display, request: Request, path: Path) -> None:
    """What was dragged, as the window has asked for it."""
    data = f"{path.as_uri()}\r\n".encode()
    x.XChangeProperty(
        display, Id(request.requestor), Id(request.property), Id(request.target), 8, 0, data, len(data)
    )  # fmt: skip
    answer = Answer(
        SELECTION_NOTIFY, requestor=request.requestor, selection=request.selection, target=request.target,
        property=request.property, time=request.time,
    )  # fmt: skip
    x.XSendEvent(display, Id(request.requestor), 0, Long(0), ctypes.byref(AnyEvent(answer=answer)))
    x.XFlush(display)
