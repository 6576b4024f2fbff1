"""Expressive stance: the whole of Neff and Fiume 2004, *Methods for Exploring Expressive Stance*, and a little beyond
it.

`solve.solve_stance` is the door. Behind it each section of the paper has its file: balance (4), lower_body (5.1,
appendix), torso and penalty and solver (5.2), arms (5.3), gaze (5.4), shape_sets (6). The paper's frame ends in
`frame`.
"""
