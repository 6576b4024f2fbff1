"""`brace demo`, ended at its first picture: prints the seconds of work from the start of the process until then."""

from __future__ import annotations

import sys
import time


def main() -> int:
    from demos.cli import main as brace
    from demos.window import layer

    def stop(*_) -> None:
        # the thread that does everything; the rasteriser's helpers run beside it
        print(f"{time.thread_time():.2f}")
        raise SystemExit(0)

    layer.PanelLayer.paint = stop  # type: ignore[method-assign]
    return brace(["demo", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
