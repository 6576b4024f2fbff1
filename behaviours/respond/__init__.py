"""The dynamic response (thesis 4.1.2): the blow, the body under physics, and the fall when it is too hard.

Begin with `contact.meet_balls`, then `response.step_bodies`.
"""
