"""Motion capture: files read, mapped onto the one skeleton, put on the floor, looked up by name, sampled.

Begin with `importing` (a file becomes a clip) and `playback` (a clip's pose at a time).
"""
