#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name has words: those of the C++ and C headers by Doxygen's XML, those of Python by their docstrings.

    documented_test.py headers DOXYGEN DOXYFILE   counts the names of the headers, and what their words say (said_of_headers);
                                                  exit code 77 without Doxygen
    documented_test.py python                     counts those of the package

Nothing needs to be said of what the language itself says: destructors, copies and moves, defaulted and deleted operators. The
comment of an enumeration may speak for its values.
"""
import inspect
import os
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import said_of_headers
from said_of_headers import needs_none, words_of

COMPOUNDS = {"class", "struct", "union", "namespace", "file"}


def has_words(element):
    return bool(words_of(element))


def undocumented_of(folder):
    """(how many names, those without words as `file:line: name`)."""
    count, faults, seen = 0, [], set()

    def look(element, name, is_documented):
        nonlocal count
        count += 1
        if not is_documented:
            place = element.find("location")
            faults.append(f"{place.get('file')}:{place.get('line')}: {name} has no words")

    for path in sorted(folder.glob("*.xml")):
        for compound in ElementTree.parse(path).getroot().findall("compounddef"):
            kind, name = compound.get("kind"), compound.findtext("compoundname")
            if kind not in COMPOUNDS or "detail" in name.split("::") or compound.get("prot") == "private":
                continue
            if kind in ("class", "struct", "union"):
                look(compound, name, has_words(compound))
            for member in compound.iter("memberdef"):
                if member.get("id") in seen or member.get("prot") == "private" or member.get("kind") == "friend":
                    continue
                seen.add(member.get("id"))
                full = f"{name}::{member.findtext('name')}"
                look(member, full, has_words(member) or needs_none(member, name.split("::")[-1]))
                for value in member.findall("enumvalue"):
                    count += 1
                    if not has_words(value) and not has_words(member):
                        faults.append(f"{full}: {value.findtext('name')} has no words")
    return count, faults


def headers(doxygen, doxyfile):
    if not os.access(doxygen, os.X_OK):
        print("skipped: there is no Doxygen (apps/install_dependencies.sh --docs)")
        sys.exit(77)
    folder = re.search(r"(?m)^OUTPUT_DIRECTORY *= *(.+)$", pathlib.Path(doxyfile).read_text(encoding="utf-8"))[1]
    pathlib.Path(folder).mkdir(exist_ok=True)
    subprocess.run([doxygen, doxyfile], check=True)
    count, faults = undocumented_of(pathlib.Path(folder) / "xml")
    assert count > 1500, f"only {count} names: does Doxygen read the headers?"
    return count, faults, said_of_headers.unsaid_of(pathlib.Path(folder) / "xml")


def python():
    import viewgain
    import viewgain.mesh

    modules, count, faults = [viewgain, viewgain.mesh], 0, []
    try:
        import viewgain.distributed

        modules.append(viewgain.distributed)
    except ImportError as error:
        print(error)
    for module in modules:
        for name in getattr(module, "__all__", dir(module)):
            thing = getattr(module, name)
            if name.startswith("_") or inspect.ismodule(thing):
                continue
            if not callable(thing):
                assert isinstance(thing, tuple), name  # names of codes, said where the codes are
                continue
            members = [(f"{module.__name__}.{name}", thing)]
            if inspect.isclass(thing):
                # What a constructor takes stands in the class's own words.
                members += [(f"{module.__name__}.{name}.{key}", value) for key, value in vars(thing).items()
                            if not key.startswith("_")]
            for full, member in members:
                count += 1
                words = inspect.getdoc(member) or ""
                # pybind11 begins with the signature, which is no word about it.
                words = re.sub(r"^\w+\(.*\) -> .*$|^\w+\(\*args.*$|Overloaded function\.|^\d+\. ", "", words, flags=re.M)
                if not words.strip():
                    faults.append(f"{full} has no words")
    assert count > 150, count
    return count, faults, []


def main():
    count, wordless, unsaid = python() if sys.argv[1] == "python" else headers(*sys.argv[2:])
    print(f"{count} public names, {len(wordless)} without words")
    print("\n".join(wordless + unsaid))
    sys.exit(1 if wordless or unsaid else 0)


if __name__ == "__main__":
    main()
