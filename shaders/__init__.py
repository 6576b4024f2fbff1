"""GLSL sources, read by `engine.render.shader_source`."""
