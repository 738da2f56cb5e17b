# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The role {cxx}: `viewgain::Name` as a link to Doxygen's page of it, found in the tag file.

A name that is not there is a warning. (Debian 12's sphinxcontrib.doxylink does not run with its Sphinx.)
"""
import os
import posixpath
import xml.etree.ElementTree as ElementTree

from docutils import nodes
from sphinx.util import logging
from sphinx.util.docutils import SphinxRole

FOLDER = "cpp"  # of Doxygen's pages, from the site's own folder


def links_of(tag_file):
    """{name: page and place}; the first of overloads."""
    links = {}
    for compound in ElementTree.parse(tag_file).getroot().findall("compound"):
        name, page = compound.findtext("name"), compound.findtext("filename")
        page += "" if page.endswith(".html") else ".html"
        scope = "" if compound.get("kind") == "file" else name + "::"
        links.setdefault(name, page)
        for member in compound.findall("member"):
            place = f"{member.findtext('anchorfile')}#{member.findtext('anchor')}"
            links.setdefault(scope + member.findtext("name"), place)
    return links


class CxxRole(SphinxRole):
    links = {}

    def run(self):
        if not self.links:
            self.links.update(links_of(os.environ["VIEWGAIN_TAG_FILE"]))
        link = self.links.get(self.text)
        text = nodes.literal(self.text, self.text.removeprefix("viewgain::"))
        if link is None:
            logging.getLogger(__name__).warning("Doxygen knows no %s", self.text, location=self.get_source_info())
            return [text], []
        to_root = posixpath.relpath(".", posixpath.dirname(self.env.docname) or ".")
        return [nodes.reference("", "", text, internal=True, refuri=f"{to_root}/{FOLDER}/{link}")], []


def setup(app):
    app.add_role("cxx", CxxRole())
    return {"parallel_read_safe": True}
