"""The account of a run: its events, its phases and its measures, as `brace react --json` prints them."""

from __future__ import annotations

from typing import Any

from behaviours.components import Phase
from behaviours.measure import head_measures, measures
from behaviours.measure.observing import Track
from behaviours.timing import TICK_S

REACTED = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD, Phase.RESPOND, Phase.DOWN)  # the way back comes after these


def event_rows(world) -> list[dict[str, Any]]:
    """Every event as plain data, in order; `character`: which of the scenario's it happened to, or was meant for."""
    numbers = {world.entity(row): number for number, row in enumerate(world.assets.character_rows)}
    return [
        {
            "t_s": event.tick * TICK_S,
            "kind": event.kind,
            "entity": event.entity,
            "character": numbers.get(event.entity, numbers.get(event.data.get("at"))),
            **event.data,
        }
        for event in world.events
    ]


def phase_rows(track: Track) -> list[dict[str, Any]]:
    """The phases one after the other: name, from_s, to_s."""
    rows: list[dict[str, Any]] = []
    for tick, phase in zip(track.tick, track.phase, strict=True):
        name = Phase(phase).name.lower()
        if not rows or rows[-1]["name"] != name:
            rows.append({"name": name, "from_s": tick * TICK_S, "to_s": tick * TICK_S})
        rows[-1]["to_s"] = (tick + 1) * TICK_S
    return rows


def metrics_of(world, row: int, track: Track) -> dict[str, Any]:
    """The measures of one character's run; None where nothing happened that could be measured."""
    who = world.entity(row)
    mine = [event for event in world.events if event.entity == who]
    perceived = [event.data for event in mine if event.kind == "perceived"]
    contacts = [event.data for event in mine if event.kind == "contact"]
    head_g = head_measures.head_acceleration_g(track)
    place, speed = measures.seam_jumps(track)
    limit, overlap = (measures.greatest(found(track)) for found in (measures.joint_limit_excess, measures.overlap))
    return {
        "ttc_s": perceived[0]["ttc_s"] if perceived else None,
        "contact_error_s": contacts[0]["late_s"] if contacts else None,
        "first_contact": contacts[0]["part"] if contacts else None,
        "head_peak_g": float(head_g.max()) if len(head_g) else None,
        "hic15": head_measures.hic15(head_g) if len(head_g) else None,
        "foot_slide_max_m": measures.foot_slide_max_m(track),
        "hand_line_deviation_max_m": measures.hand_line_deviation_max_m(track.lines),
        "com_line_deviation_max_m": measures.com_line_deviation_max_m(track.lines),
        "com_margin_min_m": measures.com_margin_min_m(track),
        "joint_limit_excess_max_rad": limit.value,
        "joint_limit_excess_of": limit.what if limit.value > 0.0 else None,
        "overlap_max_m": overlap.value,
        "overlap_between": overlap.what if overlap.value > 0.0 else None,
        "seam_position_jump_max_m": place,
        "seam_velocity_jump_max_mps": speed,
        "stopped": sum(event.kind == "stopped" for event in mine),
        "recovered_to": recovered_to(track, world.assets.clips),
    }


def recovered_to(track: Track, clips) -> str | None:
    """The clip taken up after the last reaction; None if there was none or it is not over; "down" after a fall."""
    last = max((k for k, phase in enumerate(track.phase) if phase in REACTED), default=None)
    if last is None:
        return None
    if last == len(track.phase) - 1:
        return "down" if track.phase[last] == Phase.DOWN else None
    played = [clip for clip, phase in zip(track.clip[last:], track.phase[last:], strict=True) if phase == Phase.PLAY]
    return clips[played[0]].name if played else None


def report_of(world, tracks: dict[int, Track]) -> dict[str, Any]:
    """The whole report. The first character's phases and metrics at the top level; all of them in `characters` if
    there are more.
    """
    accounts = [
        {"phases": phase_rows(track), "metrics": metrics_of(world, row, track)} for row, track in tracks.items()
    ]
    report = {"events": event_rows(world), **accounts[0], "digest": world.digest(), "ticks": world.tick}
    if len(accounts) > 1:
        report["characters"] = accounts
    return report
