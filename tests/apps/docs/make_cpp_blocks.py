#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""make_cpp_blocks.py OUT.cpp PAGES...: a test of each page whose body is the page's `cpp` blocks, in their order."""
import pathlib
import re
import sys

from page_blocks import blocks_of


def main():
    out, pages = pathlib.Path(sys.argv[1]), [pathlib.Path(word) for word in sys.argv[2:]]
    includes, tests = {"#include <cstdio>", "#include <optional>", "#include <stdexcept>", "#include <vector>"}, ""
    for page in pages:
        body = ""
        for block in blocks_of(page):
            if block.language == "cpp":
                code = re.sub(r"(?m)^#include.*$", lambda found: includes.add(found[0]) or "", block.code)
                body += f'#line {block.line} "{page}"\n{code}'
        if body:
            name = re.sub(r"\W", "_", page.stem)
            tests += f"\nTEST(DocsBlocks, {name}) {{\n{body}}}\n"
    out.write_text("#include <gtest/gtest.h>\n\n" + "\n".join(sorted(includes)) + "\n" + tests, encoding="utf-8")


if __name__ == "__main__":
    main()
