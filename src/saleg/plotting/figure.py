"""Figures, axes and panels that notebooks show; imported with matplotlib, when something is drawn.

What a notebook's cell ends with is shown as a picture if it has ``_repr_png_``. Axes of one's own,
of pyplot for instance, are left to whoever made them.
"""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

#: Runs that are named below a figure.
SIGNED = 2


class ShownFigure(Figure):
    """A figure that shows as the result of a notebook's cell, without pyplot."""

    def add_subplot(self, *args: Any, **settings: Any) -> Any:
        """As of any figure; the axes show as the result of a cell too."""
        if settings.get("projection") == "3d":
            from mpl_toolkits.mplot3d.axes3d import Axes3D

            kind = type("ShownAxes3D", (ShownAxes, Axes3D), {})
            settings = {**settings, "projection": None, "axes_class": kind}
        elif not {"projection", "polar"} & set(settings):
            settings.setdefault("axes_class", ShownAxes)
        return super().add_subplot(*args, **settings)

    def sign(self, text: str) -> None:
        """Say below all panels of which engine and run they are; every text once."""
        texts = [*getattr(self, "_signatures", ()), text]
        self._signatures = list(dict.fromkeys(texts))
        shown = self._signatures[:SIGNED] + ["..."] * (len(self._signatures) > SIGNED)
        look: dict[str, Any] = {"x": 0.995, "ha": "right", "fontsize": "x-small", "color": "0.45"}
        self.supxlabel(" | ".join(shown), **look)

    def _repr_png_(self) -> bytes:
        image = BytesIO()
        self.savefig(image, format="png", dpi=100)
        return image.getvalue()


class ShownAxes(Axes):
    """Axes that show with all of their figure as the result of a notebook's cell.

    Figures are declared to return them; axes of one's own come back as they are.
    """

    figure: Figure

    def _repr_png_(self) -> bytes | None:
        return _picture(self)


class Panels(np.ndarray):
    """Axes of a figure in an array; they show together as the result of a notebook's cell.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
    """

    @classmethod
    def of(cls, axes: Any) -> Panels:
        """An array of axes."""
        return np.asarray(axes, dtype=object).view(cls)

    @property
    def figure(self) -> Any:
        """The figure of the first panel."""
        return self.flat[0].figure

    def _repr_png_(self) -> bytes | None:
        return _picture(self.flat[0]) if self.size else None


def _picture(ax: Axes) -> bytes | None:
    """Picture of a figure made here; None of another, which its maker shows."""
    figure = ax.figure
    return figure._repr_png_() if isinstance(figure, ShownFigure) else None
