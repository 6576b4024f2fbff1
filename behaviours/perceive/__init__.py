"""A threat comes and is noticed (thesis 3.1, 4.2): what kinds there are, how they fly, what a character knows of one.

Begin with `threats` (the kinds) and `senses` (who notices what, and when).
"""
