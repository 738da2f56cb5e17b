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


def run_from_files(app, exception):
    """Debian's furo wants a web server: its script is a module, which browsers do not load from files, and its style takes another from
    the server's root. Without them the pages have no theme to choose and a white edge. Its style also lost the dark colours of who has
    chosen no theme on a dark desktop: the page would be light, its code dark."""
    if exception is not None:
        return
    static = pathlib.Path(app.outdir) / "_static"
    script, style = static / "scripts/furo.js", static / "styles/furo.css"
    imported = re.compile(r'(?m)^import .*"\./(gumshoe-patched\.js)";\n')
    text = script.read_text(encoding="utf-8")
    if found := imported.match(text):
        script.write_text((script.parent / found[1]).read_text(encoding="utf-8") + imported.sub("", text), encoding="utf-8")
    rules = re.sub(r"@import url\(/(javascript/normalize\.css/normalize\.css)\);",
                   lambda found: pathlib.Path("/usr/share", found[1]).read_text(encoding="utf-8"), style.read_text(encoding="utf-8"))
    dark = re.search(r'body\[data-theme="?dark"?\]\s*(\{[^}]*--color-background-primary[^}]*\})', rules)
    if dark and not re.search(r'prefers-color-scheme:\s*dark\)\s*\{\s*body:not\(\[data-theme', rules):
        rules += f"\n@media screen and (prefers-color-scheme: dark) {{\n  body[data-theme=auto] {dark[1]}\n}}\n"
    style.write_text(rules, encoding="utf-8")
    for page in pathlib.Path(app.outdir).rglob("*.html"):
        html = page.read_text(encoding="utf-8")
        if '<script type="module" ' in html:
            page.write_text(html.replace('<script type="module" ', "<script "), encoding="utf-8")


def setup(app):
    app.connect("autodoc-process-signature", readable_signatures)
    app.connect("build-finished", run_from_files)
