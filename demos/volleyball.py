"""The shortest whole program: run a scenario, say what happened, make a web page that plays it.

`python -m demos.volleyball [SCENARIO] [PAGE.html]`
"""

import sys

from demos.cli import guarded
from demos.exporting.footage import PHASE_NAMES, film
from demos.exporting.html import html_bytes
from demos.running import open_scenario, start
from engine.core.files import write_atomically

CAMERA = (-55.0, 9.0, 4.4)  # azimuth and elevation in degrees, distance in metres


def main(name: str = "volleyball", page: str = "volleyball.html") -> None:
    scenario, folder = open_scenario(name)
    # a scenario's world, and the systems that carry it from tick to tick
    simulation = start(scenario, folder)
    # runs it to its end and keeps what there is to see, 60 times a second
    footage = film(simulation, 60.0, name)

    before = None
    for time_s, phase in zip(footage.time_s, footage.people[0].phase, strict=True):
        if phase != before:
            print(f"{time_s:6.2f} s  {PHASE_NAMES[phase].replace('_', ' ')}")
        before = phase
    for time_s, kind in footage.marks:
        print(f"{time_s:6.2f} s  {kind}")

    write_atomically(page, html_bytes(footage, CAMERA))
    print(f"{page} plays it in any browser")


if __name__ == "__main__":
    sys.exit(guarded(lambda: main(*sys.argv[1:])))
