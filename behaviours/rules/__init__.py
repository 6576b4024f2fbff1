"""The rules (thesis 3.2): one a file, each a pure function of the threat and of a control between 0 and 1.

`behaviours.protect.apply_rules` calls them in their order.
"""
