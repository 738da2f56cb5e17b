# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's filter for headers: prints FILE with comments in the form that Doxygen sees. Lines stay lines.

C headers have plain comments, which become Doxygen's. A comment behind several variables, as in
`double fx = 0, fy = 0;  ///< [px]`, is said of each. Pages of the site that a comment names become links.
"""
import pathlib
import re
import sys


def as_doxygen(line):
    if "SPDX" in line or "----" in line:
        return line
    line = re.sub(r"^(\s*)/\* ", r"\1/** ", line)
    return re.sub(r"(?<=[;,\w]) +/\* ", " /**< ", line)


def parts(declarators):
    """`fx = f(1, 2), fy` cut at the commas outside brackets."""
    depth, begin, found = 0, 0, []
    for i, character in enumerate(declarators):
        depth += (character in "([{<") - (character in ")]}>")
        if character == "," and depth == 0:
            found.append(declarators[begin:i].strip())
            begin = i + 1
    return found + [declarators[begin:].strip()]


def said_of_each(lines):
    several = re.compile(r"^(\s*)((?:const )?[\w:]+(?:<[^;]*?>)?\*?) ([^();]*,[^();]*);\s*(?:///<|/\*\*<) ?(.*)$")
    result = []
    for i, line in enumerate(lines):
        match = several.match(line)
        names = parts(match[3]) if match else []
        if len(names) < 2:
            result.append(line)
            continue
        indent, kind, _, comment = match.groups()
        follow = []
        for other in lines[i + 1:]:
            if not re.match(r"^\s*///<", other):
                break
            follow.append(other.strip()[4:].strip())
        opened = line.rstrip().endswith("*/") or "/**<" not in line
        text = " ".join([comment.replace("*/", "").strip(), *follow])
        if not opened:
            text = " ".join([text, *[part.strip() for part in lines[i + 1:i + 4]]]).split("*/")[0].strip()
        last = f" /**< {comment}" if "/**<" in line else f" ///< {comment}"
        result.append(indent + " ".join(f"{kind} {name}; /**< {text} */" for name in names[:-1])
                      + f" {kind} {names[-1]};" + last)
    return result


path = pathlib.Path(sys.argv[1])
text = path.read_text(encoding="utf-8").splitlines()
if path.suffix == ".h":
    text = [as_doxygen(line) for line in text]
    # The first comment is about the file.
    first = next(i for i, line in enumerate(text) if line.startswith("/** "))
    text[first] = text[first].replace("/** ", f"/** @file {path.name} ", 1)
page = re.compile(r"apps/docs/([\w/]+)\.md")
text = [page.sub(r'<a href="../\1.html">\1</a>', line) if line.lstrip().startswith(("//", "*", "/*")) else line for line in text]
print("\n".join(said_of_each(text)))
