"""Transitional blends (thesis 4.3): from one still pose to another, balanced, feet held, hands on straight lines.

`blending.blend_into` is the door; limbs that cannot go the plain way are in the files named after what they do instead.
"""
