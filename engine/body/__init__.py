"""The one skeleton that every clip is mapped on: masses, kinematics, limb IK, joint limits, capsules, support polygon.

Begin with `skeleton`, which numbers the joints and says in which frame each stands.
"""
