"""What is shown in the end: the pose of the present phase, what is left of the last seam on top, the feet in place.

Begin with `settling.settle_poses`; `sources` says where a phase's pose comes from, `seams` what a change leaves over.
"""
