"""Every failure that a user can meet, as one line and an exit code. Nothing here ever reaches them as a traceback."""

from __future__ import annotations

EXIT_GOOD = 0
EXIT_BAD_INPUT = 2
EXIT_ENVIRONMENT = 3
EXIT_DIVERGED = 4
EXIT_INTERRUPTED = 130


class BraceError(Exception):
    """Base of the errors that end a command: `code` names the kind, `where` is a file and, if known, its line."""

    exit_code = EXIT_BAD_INPUT

    def __init__(self, code: str, message: str, where: str | None = None):
        super().__init__(message)
        self.code = code
        self.message = message
        self.where = where

    def line(self) -> str:
        """`error[CODE] file:line: what was found, what was expected`, always a single line."""
        place = f" {self.where}" if self.where else ""
        return f"error[{self.code}]{place}: {' '.join(self.message.split())}"


class BadInput(BraceError):
    """The user's file, key, name or number cannot be used."""


class EnvironmentTrouble(BraceError):
    """The machine lacks something: GL, ffmpeg, room on the disk, leave to write."""

    exit_code = EXIT_ENVIRONMENT


class ReplayDiverged(BraceError):
    """A recording, simulated again, did not give the same bits."""

    exit_code = EXIT_DIVERGED
