"""The tables behind a body: de Leva's segments and builds, and what shares of stature anatomy gives to the rest.

De Leva 1996, Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J. Biomechanics 29(9), Tables 2 and 4.
"""

from __future__ import annotations

from typing import NamedTuple


class Segment(NamedTuple):
    """One row of de Leva's Table 4, as fractions: of body mass, and of the segment's length."""

    mass: float
    com: float  # from the segment's upper (proximal, cranial, heel) end
    gyration: tuple[float, float, float]  # about the sagittal (front-back), transverse (left-right) and long axis


# head VERT-CERV; trunk SUPR-XYPH, XYPH-OMPH, OMPH-MIDH; hand WJC-DAC3; foot HEEL-TTIP; else joint centre to joint
# centre
DE_LEVA = {
    "male": {
        "head": Segment(0.0694, 0.5002, (0.303, 0.315, 0.261)),
        "upper_trunk": Segment(0.1596, 0.2999, (0.716, 0.454, 0.659)),
        "middle_trunk": Segment(0.1633, 0.4502, (0.482, 0.383, 0.468)),
        "lower_trunk": Segment(0.1117, 0.6115, (0.615, 0.551, 0.587)),
        "upper_arm": Segment(0.0271, 0.5772, (0.285, 0.269, 0.158)),
        "forearm": Segment(0.0162, 0.4574, (0.276, 0.265, 0.121)),
        "hand": Segment(0.0061, 0.3624, (0.288, 0.235, 0.184)),
        "thigh": Segment(0.1416, 0.4095, (0.329, 0.329, 0.149)),
        "shank": Segment(0.0433, 0.4395, (0.251, 0.246, 0.102)),
        "foot": Segment(0.0137, 0.4415, (0.257, 0.245, 0.124)),
    },
    "female": {
        "head": Segment(0.0668, 0.4841, (0.271, 0.295, 0.261)),
        "upper_trunk": Segment(0.1545, 0.2077, (0.746, 0.502, 0.718)),
        "middle_trunk": Segment(0.1465, 0.4512, (0.433, 0.354, 0.415)),
        "lower_trunk": Segment(0.1247, 0.4920, (0.433, 0.402, 0.444)),
        "upper_arm": Segment(0.0255, 0.5754, (0.278, 0.260, 0.148)),
        "forearm": Segment(0.0138, 0.4559, (0.261, 0.257, 0.094)),
        "hand": Segment(0.0056, 0.3427, (0.244, 0.208, 0.154)),
        "thigh": Segment(0.1478, 0.3612, (0.369, 0.364, 0.162)),
        "shank": Segment(0.0481, 0.4352, (0.267, 0.263, 0.092)),
        "foot": Segment(0.0129, 0.4014, (0.299, 0.279, 0.139)),
    },
}


class Build(NamedTuple):
    """Lengths of de Leva's mean subject as fractions of stature (1.741 m, 73.0 kg and 1.735 m, 61.9 kg)."""

    body_mass_index: float
    trunk: float  # MIDH to MIDS, mid-hip to mid-shoulder
    omphalion: float  # the landmarks' heights as fractions of that trunk
    xiphion: float
    suprasternale: float
    cervicale: float
    head: float  # CERV to VERT
    upper_arm: float
    forearm: float
    hand: float  # WJC to DAC3, the tip of the third finger
    thigh: float
    shank: float
    foot: float  # heel to toe tip


BUILD = {
    "male": Build(24.08, 0.2961, 0.2826, 0.7007, 1.0318, 1.1703, 0.1395, 0.1618, 0.1545, 0.108, 0.2425, 0.2529, 0.1482),
    "female": Build(
        20.56, 0.2870, 0.3645, 0.7769, 1.0631, 1.2348, 0.1405, 0.1586, 0.1523, 0.105, 0.2124, 0.2528, 0.1316
    ),
}

# Shares of stature after Drillis and Contini 1966 (Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1)
ANKLE_HEIGHT = 0.039
HALF_SHOULDERS = 0.105
HALF_HIPS = 0.05
CROWN_OVER_HEAD_JOINT = 0.0845  # vertex over the skull's lowest joint: most of CERV-VERT, the neck being the rest
TOE_JOINT_HEIGHT = 0.012
# Of a foot's length: heel contact behind the ankle, ball and toe contacts ahead of ankle and ball, half widths
HEEL_BEHIND, BALL_AHEAD, TOE_AHEAD = 0.20, 0.47, 0.22
HALF_WIDTHS = (0.12, 0.18, 0.14)

# Of the parts cut off: the head without neck weighs 4.2 kg of a man's 5.07 kg (Yoganandan et al. 2009); the others by
# volume
NECK_OF_HEAD, CLAVICLE_OF_UPPER_TRUNK, TOES_OF_FOOT = 0.17, 0.08, 0.15
