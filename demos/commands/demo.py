"""`brace demo`: the window; without a display, pictures of the same."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from demos.commands.arguments import add_filming, add_scenario, shot_of
from demos.output import made_folder
from engine.core.errors import BadInput, EnvironmentTrouble

OFFLINE_SCENARIO = "sway"
STRIP_SIZE = (400, 540)
USUAL_SIZE = "1280x720"  # of the window
FILM_SIZE = (960, 540)  # of the film that is drawn where there is no display


def register(subparsers) -> None:
    parser = subparsers.add_parser(
        "demo",
        help="the interactive window; without a display, pictures",
        description="Opens a window on a scenario: F1 there lists the keys. Without a display it draws a film and a "
        "filmstrip instead and says where they are.",
        epilog="example: brace demo volleyball --ghosts",
    )
    add_scenario(parser, default="volleyball")
    add_filming(parser, size=USUAL_SIZE)
    parser.add_argument("-o", "--output", metavar="FOLDER", default="out", help="where pictures go (out)")
    parser.add_argument(
        "--quality", default="auto", metavar="LEVEL",
        help="of the window: best, good, fair, fast, fastest, or auto: by measured frame times (auto)",
    )  # fmt: skip
    parser.add_argument(
        "--scale", type=float, default=0.0, metavar="N",
        help="of the window's panels and letters, 0.5 to 4; without it, as the screen asks",
    )  # fmt: skip
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> None:
    if args.scale and not 0.5 <= args.scale <= 4.0:
        raise BadInput("usage", f"--scale {args.scale:g}: expected 0.5 to 4")
    _quality(args.quality)
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        _window(args)
    else:
        _pictures(args)


def _scenario(args: argparse.Namespace):
    """The scenario asked for and its folder; the one that needs no fetching, where nothing was asked for and clips are
    missing.
    """
    from demos.running import open_scenario
    from engine.clips.library import list_clips

    scenario, folder = open_scenario(args.scenario, args.set)
    missing = {listed.name for listed in list_clips() if not listed.ready}
    if args.scenario == "volleyball" and scenario.character[0].clip in missing:
        print(f"the real clips are not here (brace clips fetch); showing {OFFLINE_SCENARIO!r} instead", flush=True)
        args.scenario = OFFLINE_SCENARIO
        scenario, folder = open_scenario(args.scenario, args.set)
    return scenario, folder


def _window(args: argparse.Namespace) -> None:
    from demos.filming import placed_for
    from demos.play import play_of
    from demos.set_up import compile_what_changed
    from demos.window.layer import PanelLayer
    from demos.window.memory import kept_size, load_memory, memory_path, save_memory
    from engine.render.camera import orbit_camera
    from engine.render.context import make_context
    from engine.render.controls import CameraHands
    from engine.render.loop import run_loop
    from engine.render.quality import Governor
    from engine.render.renderer import Renderer
    from engine.render.scene import FloorStyle

    compile_what_changed()
    scenario, folder = _scenario(args)
    shot, quality = placed_for(shot_of(args), scenario), _quality(args.quality)
    play = play_of(scenario, folder, Path.cwd())
    kept, trouble = load_memory(memory_path())
    play.remember(kept)
    if args.size == USUAL_SIZE:
        shot = shot._replace(size_px=kept_size(kept) or shot.size_px)
    if trouble:
        play.session.say(trouble, alarm=True)
    for name in shot.ghosts:
        setattr(play.session.view, f"ghost_{name}", True)
    play.floor = FloorStyle(shot.floor)
    with make_context(headless=False, size=shot.size_px, title=f"Brace: {args.scenario}") as context:
        context.when_lost = play.keeper.close
        renderer, layer = Renderer(context, quality), PanelLayer(play, args.scale)
        hands = CameraHands(orbit_camera(play.session.centre_m(), *shot.camera))
        governor = Governor() if args.quality == "auto" else None
        try:
            run_loop(
                context, renderer, play, layer=layer, hands=hands, follow=play.centre_m, framed=play.framed,
                governor=governor,
            )  # fmt: skip
        finally:
            play.keeper.close()
            layer.close()
    lost = save_memory(memory_path(), play.memory())
    if lost:
        print(lost, flush=True)


def _quality(name: str):
    """The level to begin with."""
    from engine.render.quality import BEST, NAMES, quality_named

    if name == "auto":
        return BEST
    if name not in NAMES:
        raise BadInput("usage", f"--quality {name!r}: expected auto, {', '.join(NAMES)}")
    return quality_named(name)


def _pictures(args: argparse.Namespace) -> None:
    from demos.commands.capture import write_film, write_strip
    from demos.filming import placed_for, studio
    from demos.running import start
    from engine.render.capture import capture_kind

    shot = shot_of(args)
    if args.size == USUAL_SIZE:
        shot = shot._replace(size_px=FILM_SIZE)
    scenario, folder = _scenario(args)
    simulation = start(scenario, folder)
    shot = placed_for(shot, scenario)
    stem = made_folder(args.output) / Path(args.scenario).stem
    strip, film = stem.with_suffix(".png"), stem.with_suffix(".mp4" if _has_ffmpeg() else ".gif")
    capture_kind(strip)
    capture_kind(film)
    print(f"no display here; drawing {strip} and {film}", flush=True)
    with studio() as renderer:
        write_strip(renderer, strip, simulation, shot._replace(size_px=STRIP_SIZE))
        simulation = start(scenario, folder)  # once more from the start
        write_film(renderer, film, simulation.world, simulation.step, simulation.ticks, shot)
    print(f"pictures: {strip} (a filmstrip) and {film} (a film)")


def _has_ffmpeg() -> bool:
    from engine.render.capture import find_ffmpeg

    try:
        find_ffmpeg()
    except EnvironmentTrouble:
        return False
    return True
