# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The directive {command-help}: a section for each subcommand, of what its --help prints."""
import os
import re
import subprocess

from docutils import nodes
from docutils.parsers.rst import Directive


def help_of(*words):
    return subprocess.run([os.environ["VIEWGAIN_PROGRAM"], *words, "--help"], check=True, capture_output=True,
                          text=True).stdout


class CommandHelp(Directive):
    def run(self):
        sections = []
        for name in sorted(re.findall(r"^  ([a-z]+)  ", help_of(), re.MULTILINE)):
            section = nodes.section("", nodes.title("", f"viewgain {name}"), ids=[f"viewgain-{name}"])
            text = help_of(name)
            section += nodes.literal_block(text, text, language="text")
            sections.append(section)
        if not sections:
            raise self.error("the program names no subcommands")
        return sections


def setup(app):
    app.add_directive("command-help", CommandHelp)
    return {"parallel_read_safe": True}
