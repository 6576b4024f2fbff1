"""Quaternions and vectors, ballistics, springs, shapes, minimisers; and how kernels are compiled and kept.

`quaternion` and `vector` are for kernels, on tuples of numbers; `rotations` is for whole arrays outside of them.
"""
