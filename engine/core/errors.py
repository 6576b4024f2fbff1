"""Every failure that a user can meet, as one line and an exit code. Nothing here ever reaches them as a traceback."""

from __future__ import annotations

# Every code there is, in words with hyphens; a test holds this table against all that is raised.
CODES = {
    # what was typed
    "usage": "words of the command line that make no sense together",
    "name": "no such benchmark",
    "figure": "no such figure, or nothing to draw in it",
    "set": "a --set that does not fit the scenario",
    "output": "a file or folder that a result must not replace, or of an unknown kind",
    # what a file says
    "toml": "a scenario that is not TOML",
    "scenario": "a scenario with a key, a value or a person that cannot be",
    "threat": "a threat that no scenario could mean",
    "setting": "no such setting, or a value that it cannot have",
    "stance": "a stance, shape or wish that cannot be",
    "command": "a recorded command that nobody knows",
    "recording": "a recording that is none, is damaged, or does not fit what is here",
    "diverged": "a recording, simulated again, gave other bits",
    "clip-missing": "no such clip or file",
    "clip-unreadable": "a clip's file cannot be read",
    "clip-format": "a file of a kind that holds no clip",
    "clip-empty": "a clip's file without anything in it",
    "clip-not-text": "binary data where a text file should be",
    "clip-number": "something other than a finite number",
    "clip-frames": "frames that are not there",
    "clip-skeleton": "a skeleton that is nobody's",
    "clip-body": "a body that cannot be",
    "bvh": "a BVH file with something unexpected in a line",
    "asf": "an ASF skeleton with something unexpected in a line",
    "asf-missing": "an AMC motion without its ASF skeleton beside it",
    "amc": "an AMC motion with something unexpected in a line",
    "npz": "an npz file without the arrays of a clip",
    "deepmimic": "a DeepMimic motion that is none",
    # pictures that the program itself made wrong
    "no-frames": "a film of nothing",
    "frame": "a picture of another size or kind than the film",
    "filmstrip": "pictures and captions of different number",
    # the machine
    "python": "no Python of a version that fits",
    "venv": "this Python cannot make an environment",
    "pip": "no pip to install with",
    "network": "packages that could not be fetched",
    "fetch": "clips that could not be fetched",
    "clip-not-fetched": "a clip of the library that is not here yet",
    "unwritable": "a place that cannot be written",
    "disk-full": "no room for a file; nothing of it is kept",
    "no-display": "no window can be opened here",
    "display-lost": "the display went away",
    "no-gl": "no OpenGL 3.3",
    "gl-memory": "no memory for a picture of that size",
    "gl-error": "the graphics driver complains",
    "shader": "the graphics driver takes no shader of ours",
    "no-font": "a Pillow that cannot write",
    "no-ffmpeg": "no ffmpeg, or one without an encoder for films",
    "ffmpeg": "ffmpeg failed",
    "bad-video": "a film that cannot be read back",
    "bad-gif": "an animated picture that cannot be read back",
    "mujoco": "a MuJoCo of another version",
}

EXIT_GOOD = 0
EXIT_BAD_INPUT = 2
EXIT_ENVIRONMENT = 3
EXIT_DIVERGED = 4
EXIT_INTERRUPTED = 130


class BraceError(Exception):
    """Base of the errors that end a command: `code` is one of CODES, `where` is a file and, if known, its line."""

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
