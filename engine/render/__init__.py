"""The one room that knows OpenGL: a window or none behind one interface, passes, figures, camera, pictures and films.

Begin with `scene` (what can be drawn) and `renderer`.
"""
