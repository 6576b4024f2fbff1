"""The window that `brace demo` opens: panels, timeline, plots, throwing. `demos.play` puts them together.

Everything here is drawn with the few widgets of `engine.render.ui` and acts on one `Session` (session.py). To add a
panel, copy one of the `*_panel.py` files and add its class to `PANELS` in panels.py, whose head says what a panel is.
"""
