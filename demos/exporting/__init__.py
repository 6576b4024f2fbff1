"""A run as files for other programs. Here and not in the engine: only `demos` may know both a run and its pictures.

`footage` gathers a run as plain arrays; each other module makes the bytes of one kind of file from it.
"""
