"""The journal as one file: eight bytes of magic, a format version, then all of it compressed (zlib checks itself)."""

from __future__ import annotations

import json
import zlib
from pathlib import Path

from engine.core.errors import BadInput
from engine.core.files import write_atomically
from engine.core.journal import Command, Journal
from engine.core.reader import Reader, block, integer
from engine.core.snapshot import DIGEST_BYTES, Snapshot

MAGIC = b"BRACEJNL"
FORMAT = 1
VERSION_BYTES = 2
LARGEST_BYTES = 1 << 30  # unpacked; a day's recording is 170 MB


def save_journal(journal: Journal, path: str | Path) -> None:
    """Write the recording, whole or not at all. EnvironmentTrouble where it cannot be written."""
    inputs = list(journal.inputs.items())
    parts = [
        block(_json(journal.header)),
        integer(journal.first_tick),
        block(journal.start.to_bytes() if journal.start else b""),
        block(_json(inputs)),
        block(bytes(journal.digests)),
    ]
    write_atomically(path, MAGIC + FORMAT.to_bytes(VERSION_BYTES, "little") + zlib.compress(b"".join(parts)))


def load_journal(path: str | Path) -> Journal:
    """Read a recording. BadInput, one line, where the file is missing, foreign, of another format, cut or damaged."""
    try:
        data = Path(path).read_bytes()
    except OSError as trouble:
        raise BadInput("recording", f"cannot read the recording: {trouble.strerror or trouble}", str(path)) from trouble
    if not data.startswith(MAGIC):
        raise BadInput("recording", "no recording, expected a file that `--record` made", str(path))
    found = int.from_bytes(data[len(MAGIC) : len(MAGIC) + VERSION_BYTES], "little")
    if found != FORMAT:
        raise BadInput("recording", f"a recording of format {found}, expected format {FORMAT}", str(path))
    try:
        return _unpack(_decompress(data[len(MAGIC) + VERSION_BYTES :]))
    except (ValueError, zlib.error) as trouble:
        raise BadInput("recording", f"a damaged recording: {trouble}", str(path)) from trouble


def _decompress(data: bytes) -> bytes:
    """ValueError or zlib.error where the stream does not end exactly here, or is far too large."""
    stream = zlib.decompressobj()
    unpacked = stream.decompress(data, LARGEST_BYTES)
    if not stream.eof:
        raise ValueError("it ends too early" if not stream.unconsumed_tail else f"more than {LARGEST_BYTES} bytes")
    if stream.unused_data:
        raise ValueError(f"{len(stream.unused_data)} bytes too many")
    return unpacked


def _unpack(payload: bytes) -> Journal:
    """ValueError where a part is missing or of the wrong kind."""
    reader = Reader(payload)
    header = json.loads(reader.block())
    first_tick = reader.integer()
    start_bytes = reader.block()
    inputs = _inputs(json.loads(reader.block()))
    digests = bytearray(reader.block())
    reader.finish()
    if not isinstance(header, dict) or not digests or len(digests) % DIGEST_BYTES:
        raise ValueError("no header, or no digests")
    start = Snapshot.from_bytes(start_bytes) if start_bytes else None
    if first_tick != (start.tick if start else 0):
        raise ValueError(f"it begins at tick {first_tick} without the state there")
    return Journal(header, first_tick, start, inputs, digests)


def _inputs(rows: object) -> dict[int, list[Command]]:
    try:
        inputs = {int(tick): list(commands) for tick, commands in rows}  # type: ignore[attr-defined]
    except TypeError as trouble:
        raise ValueError(f"no list of commands: {trouble}") from trouble
    if not all(isinstance(command, dict) for commands in inputs.values() for command in commands):
        raise ValueError("a command that is no table")
    return inputs


def _json(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()
