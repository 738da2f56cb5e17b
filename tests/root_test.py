#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing lies at the repository's root that does not belong there, and git ignores what documented commands write there.

    root_test.py ROOT               compares; prints one line per fault and ends with 1 if there is any
    root_test.py ROOT --written DIR the same of what lies in DIR, where a page's commands ran

In a git checkout git says what is ignored and what is tracked; elsewhere, say in an exported archive, .gitignore does.
"""
import fnmatch
import pathlib
import re
import subprocess
import sys

# All that the root has.
NAMES = {
    ".ci", ".clang-format", ".dockerignore", ".git", ".gitignore", "CHANGELOG.md", "CITATION.cff", "CMakeLists.txt",
    "CMakePresets.json", "Dockerfile", "LICENSES", "README.md", "SECURITY.md", "apps", "cmake", "core", "grid", "mesh", "perf",
    "pyproject.toml", "raycast", "tests",
}
# Pages whose commands a reader runs at the root.
PAGES = ("README.md", "apps/README.md", "apps/docs/**/*.md")
# What names a file or folder to write.
WRITES = re.compile(
    r"(?<![\w-])--(?:out|points|save-config|report|picture|prefix)[ =]\"?([\w./$-]+)"
    r"|(?<![\w<-])[12]?>{1,2} ?\"?([\w./-]+\.\w+)"
    r"|\bextract_mesh\.sh \S+ ([\w./-]+)"
    r"|\.save(?:fig|_mesh)?\(f?\"([\w./{}-]+)\""
    r"|\b(?:save|write)_\w+\([^\"()]*\"([\w./-]+)\"")
# What else follows these words: a name of the reader's own (DIR, FILE.html), a switch, a number.
NO_NAME = re.compile(r"[A-Z_]+(\.\w+)?|on|off|[\d.]+|.*[{}$].*")


def is_checkout(root):
    """Whether git knows the root as a repository's; not a folder in another one."""
    try:
        top = subprocess.run(["git", "-C", root, "rev-parse", "--show-toplevel"], capture_output=True, text=True)
    except FileNotFoundError:
        return False
    return top.returncode == 0 and pathlib.Path(top.stdout.strip()).resolve() == root


def patterns(root):
    """Names that .gitignore lists; it has nothing else, so that git is not needed to read it."""
    names = []
    path = root / ".gitignore"
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() if path.exists() else [], 1):
        if not line or line.startswith("#"):
            continue
        match = re.fullmatch(r"/((?:[\w.-]|\[0-9\])+)/?", line)
        if not match:
            sys.exit(f".gitignore:{number}: {line!r} is not /NAME or /NAME/, in which [0-9] is a digit")
        names.append(match[1])
    return names


def ignored(root, names, own=False):
    """Those of the names at the root that are ignored; `own`: by the reader's own settings, too."""
    listed = patterns(root)
    if not names or not is_checkout(root):
        return {name for name in names if any(fnmatch.fnmatchcase(name, pattern) for pattern in listed)}
    paths = "".join(f"{name}\0{name}/\0" for name in sorted(names))
    settings = [] if own else ["-c", "core.excludesFile=/dev/null"]
    said = subprocess.run(["git", *settings, "-C", root, "check-ignore", "--no-index", "--stdin", "-z"],
                          input=paths, capture_output=True, text=True)
    if said.returncode > 1:
        sys.exit(f"git check-ignore: {said.stderr}")
    return {path.rstrip("/") for path in said.stdout.split("\0") if path}


def check_root(root, faults):
    names = {path.name for path in root.iterdir()}
    for name in sorted(names - NAMES - ignored(root, names - NAMES, own=True)):
        faults.append(f"{name}: does not belong at the root; if it does, add it to NAMES of tests/root_test.py")
    if is_checkout(root):
        tracked = subprocess.run(["git", "-C", root, "ls-files", "-z"], capture_output=True, text=True, check=True)
        tracked = {path.split("/")[0] for path in tracked.stdout.split("\0") if path}
        for name in sorted((tracked - NAMES) & names & ignored(root, tracked)):
            faults.append(f"{name}: is tracked, though .gitignore lists it")


def written_names(text):
    """{name at the root: line} of what a page's commands write."""
    names = {}
    for number, line in enumerate(text.splitlines(), 1):
        for match in WRITES.finditer(line):
            path = next(group for group in match.groups() if group)
            name = path.removeprefix("./").split("/")[0]
            if not path.startswith(("/", "..")) and not NO_NAME.fullmatch(name):
                names.setdefault(name, number)
    return names


def check_pages(root, faults):
    found = 0
    for page in sorted(path for pattern in PAGES for path in root.glob(pattern)):
        names = written_names(page.read_text(encoding="utf-8"))
        found += len(names)
        for name in sorted(names.keys() - ignored(root, set(names))):
            faults.append(f"{page.relative_to(root)}:{names[name]}: writes {name}, which .gitignore does not list")
    if found < 10:
        faults.append(f"only {found} names found that pages write; see WRITES of tests/root_test.py")


def check_written(root, folder, faults):
    names = {path.name for path in folder.iterdir()}
    for name in sorted(names - ignored(root, names)):
        faults.append(f"{name}: is written at the root, and .gitignore does not list it")


def main():
    if len(sys.argv) not in (2, 4) or len(sys.argv) == 4 and sys.argv[2] != "--written":
        sys.exit(__doc__)
    root, faults = pathlib.Path(sys.argv[1]).resolve(), []
    if len(sys.argv) == 4:
        check_written(root, pathlib.Path(sys.argv[3]), faults)
    else:
        check_root(root, faults)
        check_pages(root, faults)
    print("\n".join(faults) or "nothing is at the root that does not belong there")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
