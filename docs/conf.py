"""Settings of the documentation site; CONTRIBUTING.md says how to build it."""

import saleg

project = "saleg"
author = "the saleg developers"
project_copyright = author
version = release = saleg.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.viewcode",
    "sphinx_design",
]
exclude_patterns = ["images"]

# Pages are plain Markdown that reads well on a code host too: headings get anchors as there.
myst_heading_anchors = 3
myst_enable_extensions = ["deflist"]

# Docstrings describe types and units of parameters themselves.
autodoc_default_options = {"members": True, "member-order": "bysource", "show-inheritance": True}
autodoc_typehints = "none"
autodoc_preserve_defaults = True
numpydoc_show_class_members = False
# Names in docstrings become links: `Run` is described as saleg.Run.
default_role = "code"

html_theme = "pydata_sphinx_theme"
html_title = "saleg"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navigation_with_keys": False,
    "header_links_before_dropdown": 6,
    "show_prev_next": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}


def leave_out(app, what, name, value, skip, options):
    """Fields of named tuples: their class describes them."""
    return True if (getattr(value, "__doc__", None) or "").startswith("Alias for field") else None


def setup(app):
    """Connect to Sphinx."""
    app.connect("autodoc-skip-member", leave_out)
