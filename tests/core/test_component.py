"""Declaring components, and what a row on its way into the world may hold."""

from __future__ import annotations

import numpy as np
import pytest

from engine.core.component import Component, column, schema_text


class Limb(Component):
    length_m = column()
    orientation = column(4, fill=(1, 0, 0, 0))
    grip = column(2, dtype=bool)
    phase = column(dtype=np.uint8)


class LongLimb(Limb):
    joints_m = column(2, 3)


def test_fields_left_out_take_their_fill():
    limb = Limb(length_m=0.7)
    assert limb.length_m == 0.7
    assert limb.orientation.tolist() == [1, 0, 0, 0]
    assert limb.grip.tolist() == [False, False]
    assert limb.phase.dtype == np.uint8


def test_an_heir_has_its_parents_columns_first():
    assert list(LongLimb.columns) == ["length_m", "orientation", "grip", "phase", "joints_m"]
    assert list(Limb.columns) == ["length_m", "orientation", "grip", "phase"]


@pytest.mark.parametrize(
    ("values", "complaint"),
    [
        ({"lenght_m": 1.0}, "Limb has no column lenght_m; its columns are length_m, orientation, grip, phase"),
        ({"orientation": (1, 0, 0)}, r"Limb\.orientation has shape \(3,\), expected \(4,\)"),
        ({"length_m": [1.0]}, r"Limb\.length_m has shape \(1,\), expected \(\)"),
        ({"phase": 1.5}, "does not fit a column of uint8"),
        ({"phase": -1}, "does not fit a column of uint8"),
        ({"grip": (0, 2)}, "does not fit a column of bool"),
    ],
)
def test_a_value_that_does_not_fit_is_named(values, complaint):
    with pytest.raises(TypeError, match=complaint):
        Limb(**values)


def test_a_whole_number_fits_a_small_column_and_a_float_one():
    assert Limb(phase=3).phase == 3
    assert Limb(length_m=1).length_m.dtype == np.float64


def test_a_float_may_be_rounded_to_its_column():
    class Light(Component):
        watts = column(dtype=np.float32)

    assert Light(watts=0.1).watts == np.float32(0.1)


def test_declarations_that_cannot_be_state_are_refused():
    with pytest.raises(TypeError, match="booleans, integers or floats"):
        column(dtype=object)
    with pytest.raises(TypeError, match="cannot be called present"):
        type("Bad", (Component,), {"present": column()})


def test_the_schema_tells_apart_what_holds_different_state():
    texts = {
        schema_text((Limb,)),
        schema_text((LongLimb,)),
        schema_text((Limb, LongLimb)),
        schema_text((LongLimb, Limb)),
        schema_text((type("Limb", (Component,), {"length_m": column(1)}),)),
        schema_text((type("Limb", (Component,), {"length_m": column(dtype=np.float32)}),)),
    }
    assert len(texts) == 6
