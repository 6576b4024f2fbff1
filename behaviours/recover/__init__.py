"""Recovery (thesis 4.1.3): back to a meaningful motion, of the same clip or of one that a search finds; getting up.

Begin with `recovery.begin_recovery` and `search.choose_return`.
"""
