"""Files of animations: GIF, and a page with controls that loads nothing."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.film import Film

if TYPE_CHECKING:
    from matplotlib.artist import Artist

#: Colours of a GIF.
PALETTE = 128


def write_gif(film: Film, path: Path | BytesIO) -> None:
    """All frames in one GIF that begins again at its end."""
    from PIL import Image

    images = []
    for frame in range(len(film.history)):
        film.show(frame)
        film.figure.canvas.draw()
        pixels = np.asarray(film.figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]
        images.append(Image.fromarray(pixels.copy()).quantize(PALETTE))
    look: dict[str, Any] = {"duration": 1e3 / film.rate, "loop": 0, "optimize": True}
    images[0].save(path, format="GIF", save_all=True, append_images=images[1:], **look)


def _write_html(film: Film, path: Path) -> None:
    """A page with all frames and their controls in it; it loads nothing."""
    from matplotlib import rc_context
    from matplotlib.animation import FuncAnimation

    def update(frame: int) -> list[Artist]:
        film.show(frame)
        return []

    count = len(film.history)
    moved = FuncAnimation(film.figure, update, frames=count, init_func=lambda: [])
    with rc_context({"animation.embed_limit": 1e3}):
        page = moved.to_jshtml(fps=round(film.rate), embed_frames=True, default_mode="loop")
    head, _, rest = page.partition("<link")
    body = head + rest.partition(">")[2]
    path.write_text(PAGE.format(style=_glyphs(), body=body), encoding="utf-8", newline="\n")


PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>saleg</title>
<style>
body {{ text-align: center; font-family: sans-serif; }}
.fa {{ font-style: normal; display: inline-block; }}
.fa-flip-horizontal {{ transform: scaleX(-1); }}
{style}
</style></head>
<body>
{body}
</body>
</html>
"""

#: Signs on the buttons, in place of those of a font matplotlib's page loads from elsewhere.
SIGNS = {
    "minus": "-",
    "plus": "+",
    "play": "\N{BLACK RIGHT-POINTING POINTER}",
    "pause": "||",
    "fast-backward": "|<",
    "fast-forward": ">|",
    "step-backward": "<",
    "step-forward": ">",
}


def _glyphs() -> str:
    rules = (f'.fa-{name}::before {{ content: "{sign}"; }}' for name, sign in SIGNS.items())
    return "\n".join(rules)


#: How each kind of file is written, by suffix.
WRITERS: dict[str, Callable[[Film, Path], None]] = {".gif": write_gif, ".html": _write_html}
