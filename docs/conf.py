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
    known = app.env.domains["py"].objects
    by_name = {}
    for path, entry in known.items():
        if entry.objtype in ("class", "exception"):
            by_name.setdefault(path.rpartition(".")[2], {})[entry.node_id] = entry

    def linked(text, child):
        path = re.match(r"[\w.]*", text)[0]
        same = list(by_name.get(path.rpartition(".")[2], {}).values())
        entry = known.get(path)
        if entry is None and ("." in path or not same):
            entry = known.get(f"saleg.{path}")
        if entry is None and len(same) == 1:
            entry = same[0]
        if entry is None:
            return child
        return make_refnode(app.builder, docname, entry.docname, entry.node_id, child)

    for literal in list(doctree.findall(nodes.literal)):
        if not isinstance(literal.parent, nodes.reference):
            literal.parent.replace(literal, linked(literal.astext(), literal.deepcopy()))
    types = [*doctree.findall(nodes.classifier)]
    for term in doctree.findall(nodes.term):  # what is returned or raised
        types += term.findall(nodes.strong)
        types += [term] if all(isinstance(child, nodes.Text) for child in term) else []
    for kind in types:
        words = re.split(r"([\w.]+)", kind.astext())
        kind.children = []
        kind += [linked(word, nodes.Text(word)) for word in words if word]


def tidy(app, doctree, docname):
    """Leave out bases that say nothing, and let long names of tests break at underscores."""
    for paragraph in list(doctree.findall(nodes.paragraph)):
        if paragraph.astext() == "Bases: object":
            paragraph.parent.remove(paragraph)
    for link in doctree.findall(download_reference):
        for text in link.findall(nodes.Text):
            text.parent.replace(text, nodes.Text(text.replace("_", "_\u200b")))


def setup(app):
    """Connect to Sphinx."""
    app.connect("autodoc-skip-member", leave_out_fields)
    app.connect("doctree-resolved", link_names)
    app.connect("doctree-resolved", tidy)
