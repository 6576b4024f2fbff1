"""How large the physics' state of one character is: a column of the world has to know before any model is made."""

from engine.body.capsules import CAPSULES
from engine.body.skeleton import SOLE_POINTS

# time, 87 positions, 66 velocities, and as many warm-start accelerations and applied forces as mjSTATE_INTEGRATION
# keeps for 21 ball joints and a free root; `engine.physics.model` holds every model against it
STATE_SIZE = 418
SUB_STEPS = 4  # physics steps in a tick of 1 / 120 s
SHAPES = len(CAPSULES) + 2 * len(SOLE_POINTS)  # of a body, that meet the floor
