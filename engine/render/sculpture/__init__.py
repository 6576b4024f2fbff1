"""The parts of the mannequin, as solids in the frame of the joint that carries them: X forward, Y left, Z up.

All in *reference metres*: the subject is scaled to a stature of 1.75 m first and back afterwards, so that a number here
is a length on an average adult. Along the bones everything follows the subject; across them proportions are those of
Loomis, *Figure Drawing for All It's Worth*, and the breadths of ISO 7250.
"""
