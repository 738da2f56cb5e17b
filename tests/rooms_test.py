#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms are as the READMEs draw them.

    rooms_test.py ROOT          compares; prints one line per fault and ends with 1 if there is any

Each module but core draws its rooms in a block of its README:

    ```rooms
    surface:
    boundary: surface
    ```

A line names a room and the rooms whose files it includes, as `#include "surface/point_grid.hpp"` or, where
the room is a library of its own with public headers, as `#include "viewgain/formats/frames.hpp"`.
What lies in a folder `src` is included from nowhere else but tests and perf, which measure parts.
"""
import pathlib
import re
import sys

MOST_SOURCES = 16  # .cpp in a folder
MOST_LINES = 400
# Where a module's rooms are.
ROOMS = {"grid": "grid/src", "raycast": "raycast/src", "mesh": "mesh/src", "apps": "apps", "perf": "perf"}
# Rooms of apps that have rooms, too.
LIBRARIES = {"apps/planner": "apps/planner/src", "apps/formats": "apps/formats/src"}
# The modules whose public headers a module may include; apps and perf may include all.
LOWER = {"core": {"core"}, "grid": {"core", "grid"}, "raycast": {"core", "grid", "raycast"}, "mesh": {"core", "mesh"}}
# Not a module: what core has for the other modules alone (core/support), which all include.
SUPPORT = "support"
# Libraries that are slow to compile, and how many sources may include them.
HEAVY = {"openvdb": 12, "CGAL": 4}
# Folders of apps whose folders are rooms, too.
FLOORS = {"program", "show"}
SUFFIXES = {".cpp", ".hpp", ".c", ".h", ".py"}
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
NAMESPACE = re.compile(r"(?:inline )?namespace ?([\w:]*) ?\{|\}  // namespace ?([\w:]*)$")
TYPE = re.compile(r"(?:struct|class|enum class|enum)\s+(?:alignas\(\d+\) )?(?:VIEWGAIN_EXPORT\s+)?([\w:]*\w)(?: final)?(?: : [^;]*)? ?\{")


class Source:
    """A file: its path below the root, its lines, and its includes (line number, is quoted, path)."""

    def __init__(self, root, path):
        self.path = path.relative_to(root)
        self.lines = path.read_text(encoding="utf-8").splitlines()
        matches = ((i, INCLUDE.match(line)) for i, line in enumerate(self.lines, 1))
        self.includes = [(i, m[1] == '"', m[2]) for i, m in matches if m] if path.suffix != ".py" else []


def sources(root, folder):
    paths = sorted(p for p in (root / folder).rglob("*") if p.suffix in SUFFIXES and p.is_file())
    return [Source(root, p) for p in paths]


def drawn_rooms(root, readme, faults):
    """{room: (line number, {room: line number of the arrow})} of a README's block."""
    path = root / readme
    rooms, inside = None, False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() if path.exists() else [], 1):
        if line.strip() == "```rooms":
            rooms, inside = {}, True
        elif inside and line.strip() == "```":
            inside = False
        elif inside and line.strip():
            name, colon, targets = line.partition(":")
            if not colon or not re.fullmatch(r"[\w/]+", name.strip()):
                faults.append(f"{readme}:{number}: a line of a rooms block is `room: rooms that it includes`")
                continue
            rooms[name.strip()] = (number, {t: number for t in re.split(r"[,\s]+", targets.strip()) if t})
    if rooms is None:
        faults.append(f"{readme}:1: has no block ```rooms")
    return rooms or {}


def circle(arrows):
    """Rooms along a circle of arrows {room: rooms}, or nothing."""
    done = set()

    def walk(room, way):
        if room in way:
            return way[way.index(room):] + [room]
        if room in done:
            return None
        for target in sorted(arrows.get(room, ())):
            found = walk(target, way + [room])
            if found:
                return found
        done.add(room)
        return None

    return next((found for found in (walk(room, []) for room in sorted(arrows)) if found), None)


def room_of(path):
    """The room of a file, by its path below the module's rooms."""
    parts = pathlib.PurePath(path).parts
    return "/".join(parts[:2]) if parts[0] in FLOORS and len(parts) > 2 else parts[0]


def check_rooms(root, module, faults):
    folder, readme = (ROOMS | LIBRARIES)[module], f"{module}/README.md"
    drawn = drawn_rooms(root, readme, faults)
    on_disk = {}
    for source in sources(root, folder):
        parts = source.path.relative_to(folder).parts
        if len(parts) > 1:
            on_disk.setdefault(room_of(source.path.relative_to(folder)), []).append(source)
    for room in sorted(on_disk.keys() - drawn.keys()):
        faults.append(f"{on_disk[room][0].path}:1: the room {room} is not in {readme}")
    for room in sorted(drawn.keys() - on_disk.keys()):
        faults.append(f"{readme}:{drawn[room][0]}: there is no room {room}")

    # A library's public header is of the room that has its source.
    made = {s.path.stem: room for room, members in on_disk.items() for s in members if module in LIBRARIES}
    found = {room: {} for room in on_disk}
    for room, members in on_disk.items():
        own = {s.path.name for s in members}
        for source in members:
            for number, is_quoted, include in source.includes:
                where = f"{source.path}:{number}"
                target, is_there = room_of(include), (root / folder / include).is_file()
                if include.startswith(f"viewgain/{pathlib.PurePath(module).name}/") and pathlib.PurePath(include).stem in made:
                    target, is_there = made[pathlib.PurePath(include).stem], True
                for other in on_disk if include.endswith(".hpp") else ():  # C's headers are one, of parts of three libraries
                    if any((root / folder / other / part / include).is_file() for part in ("include", "support")):
                        target, is_there = other, True
                if ".." in include.split("/"):
                    faults.append(f'{where}: "{include}" goes up; name the room')
                elif not is_quoted:
                    continue
                elif "/" in include and target != room and is_there:
                    if target not in drawn.get(room, (0, {}))[1] and target not in found[room]:
                        faults.append(f"{where}: the arrow {room} -> {target} is not in {readme}")
                    found[room][target] = where
                elif "/" not in include and include not in own and not (root / folder / include).is_file():
                    others = [r for r in on_disk if any(s.path.name == include for s in on_disk[r])]
                    if others:
                        faults.append(f'{where}: "{include}" is in another room: "{others[0]}/{include}"')
    for room, (_, targets) in drawn.items():
        for target, number in targets.items():
            if target not in found.get(room, {}):
                faults.append(f"{readme}:{number}: no source of {room} includes one of {target}")
    way = circle({room: targets.keys() for room, targets in found.items()})
    if way:
        faults.append(f"{found[way[0]][way[1]]}: the arrows go in a circle: {' -> '.join(way)}")


def check_privates(root, product, faults):
    """Nothing includes a header from another library's or program's src."""
    privates = sorted(p for p in root.glob("*/src") if p.is_dir()) + sorted(p for p in root.glob("apps/*/src") if p.is_dir())
    for source in (s for s in product if s.path.parts[0] != "perf"):
        own = next((p for p in privates if (root / source.path).is_relative_to(p.parent)), None)
        for number, is_quoted, include in source.includes:
            if "src" in include.split("/"):
                faults.append(f'{source.path}:{number}: "{include}" names a src')
            beside = [(root / source.path).parent, root / "apps", root / "perf", *([own] if own else [])]
            if is_quoted and not include.startswith("viewgain/") and not any((p / include).is_file() for p in beside):
                other = next((p for p in privates if (p / include).is_file()), None)
                if other:
                    faults.append(f'{source.path}:{number}: "{include}" is private to {other.relative_to(root)}')


def check_modules(all_sources, faults):
    """Dependencies between modules, and what public headers include."""
    for source in all_sources:
        module = source.path.parts[0]
        for number, _, include in source.includes:
            where = f"{source.path}:{number}"
            match = re.match(r"viewgain/(\w+)/", include)
            if match and match[1] != SUPPORT and match[1] not in LOWER.get(module, {match[1]}):
                faults.append(f"{where}: {module} must not include {match[1]}")
            library = re.match(r"(openvdb|embree|CGAL|tbb|oneapi)", include.split("/")[0])
            if library and library[1] in ("tbb", "oneapi"):
                faults.append(f"{where}: no header of TBB")
            elif library and "include" in source.path.parts:
                faults.append(f"{where}: a public header includes {library[1]}")


def check_sizes(all_sources, faults):
    folders = {}
    for source in all_sources:
        if source.path.suffix == ".cpp":
            folders.setdefault(source.path.parent, []).append(source)
    for folder, members in folders.items():
        if len(members) > MOST_SOURCES:
            faults.append(f"{members[-1].path}:1: {folder} has {len(members)} .cpp, {MOST_SOURCES} are the most")
    for source in all_sources:
        if len(source.lines) > MOST_LINES:
            faults.append(f"{source.path}:{len(source.lines)}: over {MOST_LINES} lines")


def check_heavy(all_sources, faults):
    """How many .cpp include a library that is slow to compile, through headers of ours or directly."""
    for library, most in HEAVY.items():
        heavy = {s for s in all_sources if any(i.split("/")[0] == library for _, _, i in s.includes)}
        while True:
            names = {s.path.name for s in heavy if s.path.suffix == ".hpp"}
            more = {s for s in all_sources if any(q and i.split("/")[-1] in names for _, q, i in s.includes)}
            if more <= heavy:
                break
            heavy |= more
        cpp = sorted(str(s.path) for s in heavy if s.path.suffix == ".cpp")
        if len(cpp) > most:
            faults.append(f"{cpp[-1]}:1: {len(cpp)} sources include {library}, {most} are the most: {', '.join(cpp)}")


def check_types(product, faults):
    """No type's name is defined twice in one namespace: the linker would take two for one, and say nothing."""
    first = {}
    for source in product:
        inside = []
        for number, line in enumerate(source.lines, 1):
            match = NAMESPACE.match(line)
            if match and line.startswith("}"):
                inside = inside[:-1]
            elif match:
                inside.append(match[1])
            match = TYPE.match(line)
            if match and "" not in inside:
                name = "::".join([*inside, match[1]])
                if name in first:
                    faults.append(f"{source.path}:{number}: {name} is in {first[name]}, too")
                first[name] = f"{source.path}:{number}"


def faults_of(root):
    faults = []
    for module in ROOMS | LIBRARIES:
        check_rooms(root, module, faults)
    product = [s for folder in ("core", *ROOMS) for s in sources(root, folder)]
    check_privates(root, product, faults)
    check_modules(product, faults)
    check_sizes(product, faults)
    check_types([s for s in product if s.path.parts[0] != "perf"], faults)  # perf: programs of their own
    check_heavy(product + sources(root, "tests"), faults)
    return faults


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = faults_of(pathlib.Path(sys.argv[1]))
    print("\n".join(faults) or "the rooms are as drawn")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
