"""Copying against numpy's own assignment."""

import numpy as np

from engine.maths.copying import copy_into


def test_every_number_arrives_and_the_source_stays():
    source, target = np.arange(5.0), np.full(5, np.nan)
    copy_into(target, source)
    assert target.tolist() == source.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_a_view_writes_through_to_its_array():
    rows = np.zeros((3, 2))
    copy_into(rows[1], np.array([7.0, 8.0]))
    assert rows.tolist() == [[0.0, 0.0], [7.0, 8.0], [0.0, 0.0]]
