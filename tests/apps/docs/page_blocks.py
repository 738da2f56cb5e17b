# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The blocks of code of a page of the site."""
import dataclasses
import pathlib
import re

RUN = {"python", "sh", "toml", "cpp", "console"}  # what the tests run
FENCE = re.compile(r"^```(\S*)")


@dataclasses.dataclass
class Block:
    language: str
    line: int  # of its first line of code, from 1
    code: str


def blocks_of(page: pathlib.Path) -> list[Block]:
    """All blocks in their order but those that tell Sphinx what to put there. A language that no test runs is an error."""
    blocks, fences, opened = [], 0, None
    for number, text in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        fence = FENCE.match(text)
        if fence and opened is None:
            opened = Block(fence[1], number + 1, "")
        elif fence:
            if opened.language in RUN:
                blocks.append(opened)
            elif not opened.language.startswith("{"):
                raise SystemExit(f"{page}:{opened.line - 1}: no test runs a block of {opened.language or 'no language'!r}")
            opened, fences = None, fences + 1
        elif opened is not None:
            opened.code += text + "\n"
    if opened is not None:
        raise SystemExit(f"{page}:{opened.line - 1}: a block without an end")
    return blocks
