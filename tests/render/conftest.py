"""One GL context and one renderer for all picture tests; GL errors must be absent before and after each."""

from __future__ import annotations

import pytest

from engine.render.context import make_context
from engine.render.renderer import Renderer


@pytest.fixture(scope="session")
def _shared_renderer():
    with make_context(headless=True, size=(320, 240)) as context:
        yield Renderer(context)


@pytest.fixture
def renderer(_shared_renderer):
    assert _shared_renderer.gl.error == "GL_NO_ERROR"
    yield _shared_renderer
    assert _shared_renderer.gl.error == "GL_NO_ERROR"
