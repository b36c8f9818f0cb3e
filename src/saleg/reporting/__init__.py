"""Reports: all there is to say of a run or a steady state, on one page of HTML.

The page is whole in itself: pictures are drawn in it, and it loads nothing and has no script. It is
read on a phone and on a desk, in light and dark themes.
"""

from saleg.reporting.document import ReportError, report

__all__ = ["ReportError", "report"]
