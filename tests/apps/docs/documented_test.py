#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name of the C++ and C headers has words, by Doxygen's XML: documented_test.py DOXYGEN DOXYFILE

Nothing needs to be said of what the language itself says: destructors, copies and moves, defaulted
and deleted operators. The comment of an enumeration may speak for its values. Python's names: tests/apps/python/test_package.py.
"""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

COMPOUNDS = {"class", "struct", "union", "namespace", "file"}


def has_words(element):
    return any("".join(text.itertext()).strip() for tag in ("briefdescription", "detaileddescription") for text in element.findall(tag))


def needs_none(member, of):
    """Is it a function of which the language says what it does?"""
    name, arguments = member.findtext("name"), (member.findtext("argsstring") or "").replace(" ", "")
    if name.startswith("~") or arguments.endswith("=delete"):
        return True
    if name.startswith("operator") and arguments.endswith("=default"):
        return True
    return name in (of, "operator=") and arguments.startswith((f"({of}&&", f"(const{of}&"))


def public_names(folder):
    """(element, name, whether it has words) of all that is public, each once."""
    seen = set()
    for path in sorted(folder.glob("*.xml")):
        for compound in ElementTree.parse(path).getroot().findall("compounddef"):
            kind, name = compound.get("kind"), compound.findtext("compoundname")
            if kind not in COMPOUNDS or "detail" in name.split("::") or compound.get("prot") == "private":
                continue
            if kind in ("class", "struct", "union"):
                yield compound, name, has_words(compound)
            for member in compound.iter("memberdef"):
                if member.get("id") in seen or member.get("prot") == "private" or member.get("kind") == "friend":
                    continue
                seen.add(member.get("id"))
                full = f"{name}::{member.findtext('name')}"
                yield member, full, has_words(member) or needs_none(member, name.split("::")[-1])
                for value in member.findall("enumvalue"):
                    yield member, f"{full}: {value.findtext('name')}", has_words(value) or has_words(member)


def main():
    doxygen, doxyfile = sys.argv[1:]
    folder = pathlib.Path(re.search(r"(?m)^OUTPUT_DIRECTORY *= *(.+)$", pathlib.Path(doxyfile).read_text(encoding="utf-8"))[1])
    folder.mkdir(exist_ok=True)
    subprocess.run([doxygen, doxyfile], check=True)
    names = list(public_names(folder / "xml"))
    faults = [(element.find("location"), name) for element, name, is_documented in names if not is_documented]
    print(f"{len(names)} public names, {len(faults)} without words")
    assert len(names) > 1500, "does Doxygen read the headers?"
    for place, name in faults:
        print(f"{place.get('file')}:{place.get('line')}: {name} has no words")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
