"""Settings of the documentation site; CONTRIBUTING.md says how to build it."""

import re

from docutils import nodes
from sphinx.addnodes import download_reference
from sphinx.util.nodes import make_refnode

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
default_role = "code"
autodoc_default_options = {
    "members": True,
    "member-order": "bysource",
    "show-inheritance": True,
    "no-value": True,
}
autodoc_typehints = "none"
autodoc_preserve_defaults = True
numpydoc_show_class_members = False
toc_object_entries_show_parents = "hide"

html_theme = "pydata_sphinx_theme"
html_title = "saleg"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "navbar_persistent": ["search-button"],
    "header_links_before_dropdown": 7,
    "navigation_with_keys": False,
    "show_prev_next": False,
    "show_toc_level": 2,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}


def leave_out_fields(app, what, name, value, skip, options):
    """Leave out fields of named tuples, which their class describes."""
    return True if (getattr(value, "__doc__", None) or "").startswith("Alias for field") else None


def link_names(app, doctree, docname):
    """Link names in code (``saleg.simulate``, ``Hohenberg``) and in types of parameters."""

    def linked(text, child):
        name = re.match(r"[\w.]*", text)[0]
        for path in (name, f"saleg.{name}", f"saleg.laws.{name}"):
            entry = app.env.domains["py"].objects.get(path)
            if entry:
                return make_refnode(app.builder, docname, entry.docname, entry.node_id, child)
        return child

    for literal in list(doctree.findall(nodes.literal)):
        if not isinstance(literal.parent, nodes.reference):
            literal.parent.replace(literal, linked(literal.astext(), literal.deepcopy()))
    for link in doctree.findall(download_reference):  # long names of tests may break at underscores
        for text in link.findall(nodes.Text):
            text.parent.replace(text, nodes.Text(text.replace("_", "_\u200b")))
    for kind in doctree.findall(nodes.classifier):
        words = re.split(r"([\w.]+)", kind.astext())
        kind.children = []
        kind += [linked(word, nodes.Text(word)) for word in words if word]


def setup(app):
    """Connect to Sphinx."""
    app.connect("autodoc-skip-member", leave_out_fields)
    app.connect("doctree-resolved", link_names)
