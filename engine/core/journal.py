"""The journal of a run: what it started from, every command that came in from outside, and the digest of every tick.

A world that starts the same and is given the same commands at the same ticks goes through the same states, bit for bit,
so this little is the whole recording; the digests prove it.
"""

from __future__ import annotations

import json
import platform
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from engine.core.errors import ReplayDiverged
from engine.core.snapshot import DIGEST_BYTES, Snapshot

Command = dict[str, Any]


@dataclass
class Journal:
    """`digests` holds one digest for `first_tick` and each tick after it: of the state before that tick's commands."""

    header: dict[str, Any]  # whatever the world is rebuilt from: scenario, keys of the assets
    first_tick: int = 0
    start: Snapshot | None = None  # the state at `first_tick`, where that is not the world as built
    inputs: dict[int, list[Command]] = field(default_factory=dict)  # commands by the tick that they came before
    digests: bytearray = field(default_factory=bytearray)

    @property
    def last_tick(self) -> int:
        """The latest tick whose digest is known; one less than the first in an empty journal."""
        return self.first_tick + len(self.digests) // DIGEST_BYTES - 1

    def digest_at(self, tick: int) -> str:
        """IndexError outside the recording."""
        if not self.first_tick <= tick <= self.last_tick:
            raise IndexError(f"tick {tick} is outside the recording, {self.first_tick} to {self.last_tick}")
        at = (tick - self.first_tick) * DIGEST_BYTES
        return self.digests[at : at + DIGEST_BYTES].hex()

    def commands_at(self, tick: int) -> list[Command]:
        return self.inputs.get(tick, [])

    def command(self, tick: int, command: Command) -> None:
        """Note a command that comes before this tick is run, and with it a new future: what was recorded after is gone.

        Kept as JSON keeps it, so that it reads the same when it is loaded. TypeError or ValueError if JSON cannot.
        """
        kept = plain_json(command)
        self.inputs = {at: commands for at, commands in self.inputs.items() if at <= tick}
        self.inputs.setdefault(tick, []).append(kept)
        del self.digests[max(tick - self.first_tick + 1, 0) * DIGEST_BYTES :]

    def witness(self, tick: int, digest: str) -> None:
        """Note the digest of the next tick, or hold that of a known tick against the record.

        ReplayDiverged where they differ: the same commands did not give the same bits.
        """
        if tick == self.last_tick + 1:
            self.digests += bytes.fromhex(digest)
        elif self.digest_at(tick) != digest:
            recorded = self.digest_at(tick)
            raise ReplayDiverged(
                "diverged", f"tick {tick} gave {digest}, recorded was {recorded}{self._changed_since()}"
            )

    def _changed_since(self) -> str:
        """In words, what of the machinery is not as it was at the recording; nothing, if nothing is."""
        now, then = made_with(), self.header.get("made_with", {})
        changed = [f"{name} {then[name]}, now {now[name]}" for name in now if name in then and then[name] != now[name]]
        return f" (recorded with {'; '.join(changed)})" if changed else ""


def plain_json(value: Any) -> Any:
    """A value after a journey through JSON. TypeError or ValueError where it does not survive one."""
    return json.loads(json.dumps(value, allow_nan=False))


def made_with() -> dict[str, str]:
    """What can change the last bits of a number: the interpreter, the libraries that compute, the processor."""
    return {
        "python": platform.python_version(),
        "processor": platform.machine(),
        **{name: _version(name) for name in ("numpy", "numba", "mujoco-core")},
    }


def _version(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "absent"
