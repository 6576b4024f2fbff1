"""glTF files: well formed by the rules, posed where the run was, and accepted by the Khronos validator."""

import shutil
import subprocess

import numpy as np
import pytest

from demos.exporting.glb import glb_bytes
from demos.exporting.surfaces import skin_of
from engine.body.kinematics import joints_of
from engine.body.skeleton import JOINTS
from engine.maths import rotations
from tests.exporting.gltf_reader import DTYPES, Glb

VALIDATE = """
require("gltf-validator").validateBytes(new Uint8Array(require("fs").readFileSync(process.argv[1])))
  .then(({issues}) => console.log(issues.numErrors, issues.numWarnings, JSON.stringify(issues.messages)));
"""


@pytest.fixture(scope="module")
def data(footage):
    return glb_bytes(footage)


@pytest.fixture(scope="module")
def glb(data):
    return Glb(data)


def in_file_axes(positions_m):
    """X left, Y up, Z ahead; spelt out, not by the writer's own function."""
    ahead, left, up = np.moveaxis(positions_m, -1, 0)
    return np.stack([left, up, ahead], axis=-1)


def test_arrays_are_aligned_and_apart(glb):
    end = 0
    for view in glb.json["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] >= end
        end = view["byteOffset"] + view["byteLength"]
    assert end <= glb.json["buffers"][0]["byteLength"] == glb.binary_size
    for accessor in glb.json["accessors"]:
        assert accessor["componentType"] in DTYPES


def test_stated_bounds_are_those_of_the_numbers(glb):
    bounded = [number for number, accessor in enumerate(glb.json["accessors"]) if "min" in accessor]
    meshes = glb.json["meshes"]
    needed = {mesh["primitives"][0]["attributes"]["POSITION"] for mesh in meshes}
    needed |= {sampler["input"] for sampler in glb.json["animations"][0]["samplers"]}
    assert needed == set(bounded)
    for number in bounded:
        rows = glb.array(number).reshape(glb.json["accessors"][number]["count"], -1)
        assert rows.min(axis=0).tolist() == glb.json["accessors"][number]["min"]
        assert rows.max(axis=0).tolist() == glb.json["accessors"][number]["max"]


@pytest.mark.parametrize("frame", [0, 15, 23, 42])
def test_every_joint_is_where_the_run_had_it(glb, footage, frame):
    world = glb.pose_at(footage.time_s[frame])
    for skin, person in zip(glb.json["skins"], footage.people, strict=True):
        assert [glb.json["nodes"][node]["name"] for node in skin["joints"]] == list(JOINTS)
        wanted = in_file_axes(joints_of(person.body, person.pose)[0][frame])
        found = np.array([world[node][:3, 3] for node in skin["joints"]])
        assert np.abs(found - wanted).max() < 1e-5


def test_the_skin_goes_with_the_joints(glb, footage):
    """A corner that hangs on one joint alone keeps its place in that joint's frame."""
    frame, person, skin = 23, footage.people[1], glb.json["skins"][1]
    world, bind = glb.pose_at(footage.time_s[frame]), glb.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4)
    node = next(node for node in glb.json["nodes"] if node.get("skin") == 1)
    attributes = glb.json["meshes"][node["mesh"]]["primitives"][0]["attributes"]
    at, joints, weights = (glb.array(attributes[name]) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
    surface = skin_of(person.body)
    positions, orientations = (part[frame] for part in joints_of(person.body, person.pose))
    alone = np.flatnonzero(weights[:, 0] > 0.999)
    assert len(np.unique(joints[alone, 0])) > 8
    for corner in alone[:: len(alone) // 50]:
        joint = joints[corner, 0]
        matrix = world[skin["joints"][joint]] @ bind[joint].T
        moved = matrix @ [*at[corner].astype(float), 1.0]
        hung = surface.positions[corner] - surface.rest[joint]
        wanted = positions[joint] + rotations.rotate(orientations[joint], hung.astype(float))
        assert np.abs(moved[:3] - in_file_axes(wanted)).max() < 1e-5


def test_weights_are_whole_and_joints_named_once(glb):
    for mesh in glb.json["meshes"]:
        attributes = mesh["primitives"][0]["attributes"]
        corners = len(glb.array(attributes["POSITION"]))
        assert glb.array(mesh["primitives"][0]["indices"]).max() < corners
        assert np.allclose(np.linalg.norm(glb.array(attributes["NORMAL"]), axis=1), 1.0, atol=1e-4)
        if "WEIGHTS_0" in attributes:
            weights, joints = glb.array(attributes["WEIGHTS_0"]), glb.array(attributes["JOINTS_0"])
            assert np.allclose(weights.sum(axis=1), 1.0, atol=1e-5)
            assert not joints[weights == 0.0].any()


def test_faces_look_outwards(glb):
    for mesh in glb.json["meshes"]:
        primitive = mesh["primitives"][0]
        positions = glb.array(primitive["attributes"]["POSITION"]).astype(float)
        a, b, c = np.moveaxis(positions[glb.array(primitive["indices"]).reshape(-1, 3)], 1, 0)
        volume = np.sum(a * np.cross(b, c)) / 6.0
        assert volume > (3.5 if mesh["name"] == "volleyball" else 0.04)  # of the unit ball 4.19, of a person 0.07 m3


def test_the_ball_flies_and_is_not_there_before(glb, footage):
    ball = footage.balls[0]
    (number,) = [number for number, node in enumerate(glb.json["nodes"]) if node["name"] == "ball_0"]
    for frame in (0, 11, 12, 20, 42):
        matrix = glb.pose_at(footage.time_s[frame] + 1e-6)[number]
        size = np.linalg.norm(matrix[:3, 0])
        assert size == pytest.approx(0.105 if ball.seen[frame] else 0.0, abs=1e-6)
        assert np.abs(matrix[:3, 3] - in_file_axes(ball.position_m[frame])).max() < 1e-3


def test_the_same_footage_gives_the_same_bytes(footage, data):
    assert glb_bytes(footage) == data


def test_the_khronos_validator_finds_no_fault(data, tmp_path):
    """Where node and its package gltf-validator are (npm install gltf-validator; NODE_PATH tells where)."""
    node = shutil.which("node")
    words = [node or "node", "-e", VALIDATE, str(tmp_path / "a.glb")]
    if node is None or subprocess.run([node, "-e", 'require("gltf-validator")'], capture_output=True).returncode:
        pytest.skip("node with the package gltf-validator is not here (npm install gltf-validator; set NODE_PATH)")
    (tmp_path / "a.glb").write_bytes(data)
    said = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    assert said.startswith("0 0 "), said
