# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How Sphinx makes the site. The target `docs` says in the environment where the build's parts are."""
import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, os.environ["VIEWGAIN_PYTHON"])  # the package, for its docstrings

project = "viewgain"
copyright = "2026, The viewgain authors"
version = release = os.environ["VIEWGAIN_VERSION"]

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "command_help",
    "doxygen_links",
]
smartquotes = False  # of --flag they make a dash
exclude_patterns = ["__pycache__"]

myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3

# Debian's MathJax, copied beside the pages: the site needs no network.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
mathjax2_config = {"messageStyle": "none", "showMathMenu": False}
myst_update_mathjax = False

autodoc_member_order = "groupwise"
autodoc_default_options = {"members": True, "undoc-members": True}
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = "viewgain"
html_show_sphinx = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
html_static_path = ["figures/site.css"]
html_css_files = ["site.css"]


def readable_signatures(app, what, name, obj, options, signature, return_annotation):
    """Without self, which pybind11 has with its type."""
    return signature and re.sub(r"^\(self: [\w.]+(, )?", "(", signature), return_annotation


def setup(app):
    app.connect("autodoc-process-signature", readable_signatures)
