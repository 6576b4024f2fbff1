"""What lies on the picture in a window: panels, the timeline, words. Drawn with Dear ImGui, which only this room knows.

Others import `Ui` and `Canvas` for their types and get them handed; `Overlay` is made by whoever runs the loop, after
the first picture, because importing the library takes a fifth of a second.
"""
