"""A picture that is partly covered: what is looked at stands in the middle of the rest."""

import pytest

from engine.render.camera import Camera, off_centre, project


@pytest.mark.parametrize("aside", [(0, 0), (150, 0), (150, 40), (-80, 30)])
def test_the_target_stands_that_much_aside(aside):
    camera, size = Camera(eye=(4.0, 1.0, 1.5), target=(0.2, 0.0, 0.9)), (1280, 720)
    (place,), _ = project(off_centre(camera, *aside, size), camera.target, size)
    assert place == pytest.approx((640 - aside[0], 360 - aside[1]), abs=1e-6)
