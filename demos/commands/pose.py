"""`brace pose`: one protective pose, for one threat at one moment of a clip; nothing moves."""

from __future__ import annotations

import argparse
import math
import time
from typing import Any

from demos.commands.arguments import seconds
from demos.output import print_json, say

REPEATS = 5  # the time reported is the best of these
MOST_INTENSITY = 2.0  # of a stance, as in a scenario


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "pose",
        help="one protective pose: a clip at a time, a threat, what comes of it",
        description="Works out the pose in which somebody meets a threat: the rules, then balance and bracing.",
        epilog="example: brace pose --clip walk --at 1.0 --azimuth 30 --elevation 5 --speed 26 -o pose.png",
    )
    parser.add_argument("--clip", default="walk", metavar="C", help="library name or file (walk)")
    parser.add_argument("--at", type=seconds, default=1.0, metavar="S", help="seconds into the clip (1)")
    parser.add_argument("--azimuth", type=float, default=30.0, metavar="D", help="where it comes from: 90 is left (30)")
    parser.add_argument("--elevation", type=float, default=10.0, metavar="D", help="degrees above the horizon (10)")
    parser.add_argument("--speed", type=float, default=26.0, metavar="V", help="metres a second at contact (26)")
    parser.add_argument("--size", type=float, default=0.5, metavar="X", help="0 to 1, as the rules see it (0.5)")
    parser.add_argument("--target", default="head", metavar="T", help="head, torso, pelvis or a joint (head)")
    parser.add_argument("--kind", default="volleyball", metavar="K", help="what is thrown (volleyball)")
    parser.add_argument("--stance", metavar="SET:X", help="a shape set and its intensity, worn under the clip")
    parser.add_argument("--boldness", type=float, default=0.0, metavar="B", help="-1 timid to +1 bold (0)")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE",
        help="changes a constant of the model, such as balance.brace_m=0.05; may be repeated",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="the report for programs")
    parser.add_argument("-o", "--output", metavar="FILE.png", help="a picture: clip, rules and sustained pose")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    from behaviours.protect.pose_report import pose_case, pose_report
    from demos.kernels import get_kernels_ready

    _check_output(args.output)
    case, settings = _wanted(args)
    stance = _stance(args.stance)
    clip = _clip(args)
    get_kernels_ready()
    posed = pose_case(clip, case._replace(worn=_worn(clip.body, stance)), settings)
    report = pose_report(posed, _solve_ms(posed, settings))
    report |= {"stance": stance and stance._asdict(), "boldness": args.boldness}
    if args.output:
        _draw(posed, args.output)
        say(f"wrote {args.output}")
    if args.json:
        print_json(report)
    else:
        print("\n".join(report_lines(report)))


def _check_output(output: str | None) -> None:
    from engine.core.errors import BadInput

    if output is None:
        return
    from engine.render.capture import check_output

    if not output.lower().endswith(".png"):
        raise BadInput("usage", f"-o {output}: expected a name that ends in .png")
    check_output(output)


def _wanted(args: argparse.Namespace):
    """The case and the settings that the arguments ask for; BadInput where they make no sense."""
    from behaviours.overriding import override
    from behaviours.perceive.perceived import AIMS
    from behaviours.protect.pose_report import PoseCase
    from behaviours.scenario import check_scenario
    from behaviours.settings import Settings
    from demos.cli import nearest
    from engine.core.errors import BadInput

    if args.target not in AIMS:
        raise BadInput("usage", f"--target {args.target!r}: {nearest(args.target, AIMS)}")
    threat = {
        "kind": args.kind, "target": args.target, "azimuth_deg": args.azimuth, "elevation_deg": args.elevation,
        "speed_mps": args.speed, "size": args.size,
    }  # fmt: skip
    check_scenario({"threat": [threat]}, "the threat")  # the same bounds as in a scenario
    check_scenario({"character": [{"boldness": args.boldness}]}, "the character")
    case = PoseCase(
        args.at, args.azimuth, args.elevation, args.speed, args.size, args.target, args.kind, boldness=args.boldness
    )
    return case, override(Settings(), dict(_override(text) for text in args.set))


def _stance(text: str | None):
    """`posture:-0.8` as a name and an intensity; a name alone means all of it. BadInput for anything else."""
    from behaviours.stance.shape_sets import Named, meaning_of
    from engine.core.errors import BadInput

    if text is None:
        return None
    name, colon, number = text.partition(":")
    meaning_of(name)
    try:
        intensity = float(number) if colon else 1.0
    except ValueError:
        intensity = math.nan
    if not abs(intensity) <= MOST_INTENSITY:
        most = f"{MOST_INTENSITY:g}"
        raise BadInput("usage", f"--stance {text!r}: expected SET:X with X from -{most} to {most}, as posture:-0.8")
    return Named(name, intensity)


def _worn(body, stance):
    """What the stance puts under the clip of this body."""
    from behaviours.wearing import worn_by

    return worn_by(body, stance.set_name, stance.intensity) if stance and stance.intensity else None


def _override(text: str) -> tuple[str, Any]:
    """`balance.brace_m=0.05`, the value read as TOML."""
    import tomllib

    from engine.core.errors import BadInput

    name, equals, value = text.partition("=")
    if not (name.strip() and equals):
        raise BadInput("set", f"{text!r} is not of the form key=value, for instance balance.brace_m=0.05")
    constant = name.strip().removeprefix("settings.")  # as a scenario calls it
    try:
        return constant, tomllib.loads(f"v = {value}")["v"]
    except tomllib.TOMLDecodeError:
        return constant, value.strip()


def _clip(args: argparse.Namespace):
    from engine.clips.library import find_clip
    from engine.core.errors import BadInput

    clip = find_clip(args.clip)
    if args.at < 0.0 or (args.at > clip.duration_s and not clip.loops):
        raise BadInput("usage", f"--at {args.at:g}: expected 0 to {clip.duration_s:g} s, the length of the clip")
    return clip


def _solve_ms(posed, settings) -> float:
    """How long the pose takes to work out, milliseconds: the best of a few, with kernels compiled."""
    from behaviours.protect.sustained import solve_protection

    taken = []
    for _ in range(REPEATS):
        begun = time.perf_counter()
        solve_protection(posed.body, posed.protection.task, settings)
        taken.append(time.perf_counter() - begun)
    return 1e3 * min(taken)


def report_lines(report: dict[str, Any]) -> list[str]:
    """The report for people: the case, every term of the error before and after, the controls, the solver."""
    solver, case = report["solver"], report["case"].replace("_", " ")
    away_m = math.dist(report["com_m"]["sustained"][:2], report["com_wanted_m"])
    lines = [f"{case}; the centre of mass ends {100 * away_m:.2f} cm from where it is wanted"]
    lines.append(f"{'error':<16} {'rules alone':>12} {'sustained':>12}")
    initial = report["error_initial"]
    lines += [f"  {name:<14} {initial[name]:>12.5f} {value:>12.5f}" for name, value in report["error"].items()]
    lines.append(f"{'control':<16} {'rules alone':>12} {'sustained':>12}")
    initial = report["controls_initial"]
    lines += [f"  {name:<14} {initial[name]:>12.3f} {value:>12.3f}" for name, value in report["controls"].items()]
    lines.append(
        f"{solver['name']}: {solver['iterations']} iterations, {solver['evaluations']} evaluations, "
        f"{solver['milliseconds']:.2f} ms, {solver['stop']}"
    )
    return lines


def _draw(posed, output: str) -> None:
    """The sustained pose with the clip's and the rules' as ghosts, the ball about to arrive."""
    import numpy as np

    from behaviours.protect.pose_report import picture_of
    from demos.filming import CAMERAS, studio
    from demos.stage import GHOST_ALPHA
    from engine.body.kinematics import joints_of
    from engine.core.debug_draw import DebugDraw
    from engine.render import scene as look
    from engine.render.camera import frame_all, orbit_camera
    from engine.render.capture import write_png

    seen, size_px = picture_of(posed), (1200, 900)
    ghosts = [(seen.clip, look.CLIP_BLUE), (seen.rules, look.RULES_YELLOW)]
    figures = [look.Figure(seen.body, *joints_of(seen.body, seen.sustained), look.SUSTAINED_ORANGE)]
    figures += [look.Figure(seen.body, *joints_of(seen.body, pose), colour, GHOST_ALPHA) for pose, colour in ghosts]
    marks = DebugDraw()
    marks.line(seen.line_m[0], seen.line_m[1], look.SUSTAINED_ORANGE)
    scene = look.Scene(
        figures,
        [look.Ball(seen.ball_m, seen.ball_radius_m)],
        [look.Balance(seen.support_m, seen.com_m, seen.com_wanted_m, look.SUSTAINED_ORANGE)],
        marks,
    )
    comes_from_deg = np.degrees(np.arctan2(-posed.threat.direction[1], -posed.threat.direction[0]))
    azimuth, elevation, distance = CAMERAS["quarter"]
    camera = orbit_camera(seen.clip.root_m, comes_from_deg - azimuth, elevation, distance)
    with studio() as renderer:
        renderer.draw(scene, frame_all(camera, look.extent_points(scene), size_px), size_px)
        write_png(output, renderer.read_rgb())
