"""`brace clips`: the library of motions, bringing the real ones here, and what is in a file."""

from __future__ import annotations

import argparse
from collections import Counter
from typing import Any

from demos.commands.arguments import seconds
from demos.output import print_json
from engine.core.errors import BadInput

NAMED = 6  # of a list in a line for people


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "clips",
        help="the clip library: list, fetch, or show what is in a file",
        description="Lists the clips that have a name, brings the real ones here, or shows what is in a file.",
        epilog="example: brace clips show walk --json --at 1.0",
    )
    what = parser.add_subparsers(title="what", metavar="WHAT", dest="what")
    listing = what.add_parser("list", help="the clips that have a name", epilog="example: brace clips list --json")
    listing.add_argument("--json", action="store_true", help="the same for programs")
    fetching = what.add_parser("fetch", help="brings the real clips here", epilog="example: brace clips fetch --extra")
    fetching.add_argument("--extra", action="store_true", help="get-ups, a punch and a kick too (downloads 103 MB)")
    show = what.add_parser("show", help="what an import makes of a file", epilog="example: brace clips show 02_01.bvh")
    show.add_argument("file", metavar="FILE", help="a .bvh, .amc (its .asf beside it) or .npz file, or a clip's name")
    show.add_argument("--json", action="store_true", help="the report for programs, with all joints at --at")
    show.add_argument("--as-captured", action="store_true", help="leave glitches of a frame or two in")
    show.add_argument("--at", type=seconds, default=0.0, metavar="S", help="the moment whose joints to give (0)")
    parser.set_defaults(run=run, json=False)


def run(args: argparse.Namespace) -> None:
    if args.what == "fetch":
        _fetch(args.extra)
    elif args.what == "show":
        _show(args)
    else:
        _list(args)


def _list(args: argparse.Namespace) -> None:
    from engine.clips.library import list_clips

    listed = list_clips()
    if args.json:
        print_json({"clips": [{"name": c.name, "about": c.about, "ready": c.ready, "file": c.path} for c in listed]})
        return
    for clip in listed:
        how = "brace clips fetch --extra" if clip.extra else "brace clips fetch"
        print(f"{clip.name:<15} {clip.about}{'' if clip.ready else f'  (not here: {how})'}")


def _fetch(extra: bool) -> None:
    from engine.clips.library import fetch, list_clips

    fetch(lambda line: print(line, flush=True), extra)
    print(f"here: {', '.join(clip.name for clip in list_clips() if clip.ready)}")


def _show(args: argparse.Namespace) -> None:
    from engine.clips.library import find_clip

    clip = find_clip(args.file, as_captured=args.as_captured)
    if not 0.0 <= args.at <= clip.duration_s:
        raise BadInput("usage", f"--at {args.at:g}: expected 0 to {clip.duration_s:g} s, which is how long it lasts")
    report = {**clip.report.as_dict(), "joints_m": _joints(clip, args.at)}
    if args.json:
        print_json(report)
    else:
        print("\n".join(_lines(report, args.at)))


def _joints(clip, time_s: float) -> dict[str, list[float]]:
    from engine.body.kinematics import joints_of
    from engine.body.skeleton import JOINTS
    from engine.clips.playback import sample

    positions, _ = joints_of(clip.body, sample(clip, time_s))
    return dict(zip(JOINTS, positions.tolist(), strict=True))


def _lines(report: dict[str, Any], at_s: float) -> list[str]:
    """The report for people: every number with its unit, contacts as stretches of frames."""
    r = report
    lines = [
        f"{r['name']}: {r['format']}, {r['frames']} frames at {r['fps']:g} Hz, {r['duration_s']:.2f} s",
        f"{r['source_joints']} joints in the file, one of its units is {r['scale_to_m']:.6g} m, {r['up_axis']} is up",
        f"leg {r['leg_length_m']:.3f} m, stature {r['height_m']:.3f} m",
        f"floor at {r['floor_m']:.3f} m, faces {r['facing_deg']:.1f} degrees, both put right",
        f"{r['rest_frames_dropped']} frames of a rest pose dropped from its start",
    ]
    for side, stretches in r["planted"].items():
        lines.append(f"{side} foot stands in frames {', '.join(f'{a}-{b}' for a, b in stretches) or 'none'}")
    if r["glitches"]:
        lines.append(_of_glitches(r["glitches"]))
    if r["missing_joints"]:
        lines.append(f"nothing in the file moves {', '.join(r['missing_joints'])}")
    lines += [f"note: {note}" for note in r["notes"]]
    lines.append(f"joints at {at_s:g} s")
    return lines + [f"  {name:<15} {x:8.3f} {y:8.3f} {z:8.3f} m" for name, (x, y, z) in r["joints_m"].items()]


def _of_glitches(glitches: list[dict[str, Any]]) -> str:
    """How many frames were bridged, the first few, and the joints that most of them are of."""
    frames = sum(glitch["last"] - glitch["first"] + 1 for glitch in glitches)
    counted_frames = f"{frames} frame{'s' * (frames > 1)}"
    places = [f"{g['first']}-{g['last']}" if g["last"] > g["first"] else f"{g['first']}" for g in glitches]
    counted = Counter(joint for glitch in glitches for joint in glitch["joints"])
    joints = [f"{joint} {count}" for joint, count in counted.most_common()]
    return (
        f"{counted_frames} bridged, in which joints were astray and straight back: {_first_of(places)} "
        f"({_first_of(joints)}); --as-captured leaves them"
    )


def _first_of(words: list[str]) -> str:
    return ", ".join(words[:NAMED]) + (f" and {len(words) - NAMED} more" if len(words) > NAMED else "")
