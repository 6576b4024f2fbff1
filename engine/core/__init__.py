"""The world of columns, its schedule, snapshots and digests, journal and rewind; and what goes wrong (`errors`).

Begin with `world` and `schedule`.
"""
