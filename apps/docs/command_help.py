# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The directive {command-help}: a section for each subcommand, of its man page, which the program makes from its --help."""
import os
import pathlib
import re

from docutils import nodes
from docutils.parsers.rst import Directive


def inline_nodes(text):
    """Bold, italic and plain text of a line of roff."""
    for escape, character in (("\\-", "-"), ("\\(ha", "^"), ("\\(ti", "~"), ("\\&", ""), ("\\e", "\\")):
        text = text.replace(escape, character)
    text = re.sub(r"\\f[BIR]$", "", text)  # the end of a font, and of the line
    found = []
    for font, part in re.findall(r"(?:\\f([BIR]))?((?:(?!\\f[BIR]).)+)", text):
        kind = {"B": nodes.literal, "I": nodes.emphasis}.get(font, nodes.Text)
        found.append(nodes.Text(part) if kind is nodes.Text else kind(part, part))
    return found


def paragraph_of(text):
    paragraph = nodes.paragraph()
    paragraph += inline_nodes(text)
    return paragraph


def nodes_of(roff):
    """The nodes of a man page, without its title and name."""
    found, options, lines = [], None, iter(roff.splitlines())
    for line in lines:
        macro, _, rest = line.partition(" ")
        if macro == ".TH" or line.startswith(".SH NAME"):
            if macro == ".SH":
                next(lines)  # the name again
        elif macro in (".SH", ".SS"):
            title = rest.strip('"') if macro == ".SS" else rest.strip('"').capitalize()
            found.append(nodes.rubric("", "", *inline_nodes(title)))
            options = None
        elif macro == ".TP":
            if options is None:
                options = nodes.definition_list()
                found.append(options)
            term = nodes.term("", "", *inline_nodes(next(lines)))
            options += nodes.definition_list_item("", term, nodes.definition("", paragraph_of(next(lines))))
        elif macro == ".nf":
            kept = []
            for kept_line in iter(lines.__next__, ".fi"):
                kept.append(nodes.Element("", *inline_nodes(kept_line)).astext())
            found.append(nodes.literal_block("\n".join(kept), "\n".join(kept), language="sh"))
        elif line and not line.startswith("."):
            found.append(paragraph_of(line))
    return found


class CommandHelp(Directive):
    def run(self):
        sections = []
        for page in sorted(pathlib.Path(os.environ["VIEWGAIN_MAN_PAGES"]).glob("viewgain-*.1")):
            title = page.stem.replace("-", " ", 1)
            section = nodes.section("", nodes.title(title, title), ids=[page.stem], names=[page.stem])
            section += nodes_of(page.read_text(encoding="utf-8"))
            sections.append(section)
        if not sections:
            raise self.error("the program has no man pages")
        return sections


def setup(app):
    app.add_directive("command-help", CommandHelp)
    return {"parallel_read_safe": True}
