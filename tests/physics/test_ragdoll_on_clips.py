"""The ragdoll taken out of real motion: it goes on as the clip was going, and nothing bursts."""

import numpy as np
import pytest

from engine.body.skeleton import Pose
from engine.clips.importing import import_clip
from engine.physics import ragdoll
from engine.physics.model import model_for


@pytest.mark.parametrize("name", ["asfamc/02_03.amc", "asfamc/05_02.amc", "asfamc/16_01.amc"])  # run, dance, jump
def test_a_body_taken_out_of_a_clip_moves_on_as_the_clip_does_for_a_moment(name, shared_mocap):
    clip = import_clip(shared_mocap / name)
    model = model_for(clip.body)
    dt, few = 1.0 / clip.fps, 6

    def pose(k):
        return Pose(clip.pose.root_m[k], clip.pose.rotations[k])

    for k in range(10, clip.frames - 20, max(1, clip.frames // 8)):
        state = ragdoll.start(model, pose(k), pose(k - 1), dt)
        np.testing.assert_allclose(ragdoll.pose_of(model, state).root_m, pose(k).root_m, atol=1e-12)
        for step in range(1, few + 1):
            state = ragdoll.step(model, state, pose(k + step), 1.0, 1.0, dt)
        assert np.linalg.norm(ragdoll.pose_of(model, state).root_m - pose(k + few).root_m) < 0.06
        for _ in range(40):
            state = ragdoll.step(model, state, pose(k + few), 1.0, 1.0, dt)
        assert np.isfinite(state).all()
        assert np.abs(ragdoll.read(model, state)[1]).max() < 8.0
