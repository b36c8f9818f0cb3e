"""Files of animations: GIF, and a page with controls that loads nothing."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Callable, Iterator
from html import escape
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.plotting.film import Film
from saleg.simulation.progress import progress_bar

if TYPE_CHECKING:
    from PIL.Image import Image

#: Colours of a frame.
PALETTE = 128


def write_gif(film: Film, path: Path | BytesIO) -> None:
    """All frames in one GIF that begins again at its end."""
    first, *others = _frames(film)
    look: dict[str, Any] = {"duration": 1e3 / film.rate, "loop": 0, "optimize": True}
    first.save(path, format="GIF", save_all=True, append_images=others, **look)


def _write_html(film: Film, path: Path) -> None:
    """A page with all frames and their controls in it; it loads nothing."""
    frames = []
    for frame in _frames(film):
        image = BytesIO()
        frame.save(image, format="PNG")
        data = b64encode(image.getvalue()).decode("ascii")
        frames.append(f"data:image/png;base64,{data}")
    name = escape(film.engine.name or "engine")
    page = PAGE % {
        "name": name,
        "first": frames[0],
        "last": len(frames) - 1,
        "frames": json.dumps(frames),
        "pause": f"{1e3 / film.rate:.0f}",
    }
    path.write_text(page, encoding="utf-8", newline="\n")


def _frames(film: Film) -> Iterator[Image]:
    """The frames as pictures of few colours."""
    from PIL import Image

    count = len(film.history)
    with progress_bar(count, unit="frame", desc="drawing") as bar:
        for frame in range(count):
            film.show(frame)
            film.figure.canvas.draw()
            pixels = np.asarray(film.figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
            yield Image.fromarray(pixels[..., :3].copy()).quantize(PALETTE)
            if bar is not None:
                bar.update()


PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>%(name)s</title>
<style>
body { margin: 0 auto; padding: 0.5rem; max-width: 60rem; font: 1rem sans-serif; }
img { display: block; width: 100%%; height: auto; }
form { display: flex; gap: 0.8rem; align-items: center; padding: 0.5rem 0; }
input { flex: 1; min-width: 4rem; height: 2.5rem; }
button, select { font: inherit; min-height: 2.5rem; min-width: 4.5rem; }
</style>
</head>
<body>
<img id="frame" alt="animation of %(name)s" src="%(first)s">
<form onsubmit="return false">
<button type="button" id="play">pause</button>
<input type="range" id="place" min="0" max="%(last)d" value="0" aria-label="frame">
<select id="speed" aria-label="speed">
<option value="4">1/4</option><option value="2">1/2</option>
<option value="1" selected>speed 1</option><option value="0.5">2</option>
</select>
</form>
<script>
const frames = %(frames)s;
const [frame, place, play, speed] =
  ["frame", "place", "play", "speed"].map(name => document.getElementById(name));
let timer = null;
function show(number) {
  place.value = number;
  frame.src = frames[number];
}
function next() {
  show((Number(place.value) + 1) %% frames.length);
  timer = setTimeout(next, %(pause)s * speed.value);
}
function stop() {
  clearTimeout(timer);
  timer = null;
  play.textContent = "play";
}
play.onclick = () => {
  if (timer !== null) return stop();
  play.textContent = "pause";
  next();
};
place.oninput = () => {
  stop();
  show(Number(place.value));
};
next();
</script>
</body>
</html>
"""

#: How each kind of file is written, by suffix.
WRITERS: dict[str, Callable[[Film, Path], None]] = {".gif": write_gif, ".html": _write_html}
