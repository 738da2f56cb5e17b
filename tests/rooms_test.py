#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms are as the READMEs draw them.

    rooms_test.py ROOT          compares; prints one line per fault and ends with 1 if there is any
    rooms_test.py --self-test   finds every kind of fault in a small tree made for it

Each module but core draws its rooms in a block of its README:

    ```rooms
    surface:
    boundary: surface
    ```

A line names a room and the rooms whose files it includes, as `#include "surface/point_grid.hpp"` or, where
the room is a library of its own with public headers, as `#include "viewgain/formats/frames.hpp"`.
"""
import pathlib
import re
import sys
import tempfile
import unittest

MOST_SOURCES = 16  # .cpp in a folder
MOST_LINES = 400
# Where a module's rooms are.
ROOMS = {"grid": "grid/src", "raycast": "raycast/src", "mesh": "mesh/src", "apps": "apps", "perf": "perf"}
# The modules whose public headers a module may include; apps and perf may include all.
LOWER = {"core": {"core"}, "grid": {"core", "grid"}, "raycast": {"core", "grid", "raycast"}, "mesh": {"core", "mesh"}}
# Libraries that are slow to compile, and how many sources may include them.
HEAVY = {"openvdb": 8, "CGAL": 4}
SUFFIXES = {".cpp", ".hpp", ".c", ".h", ".py"}
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


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
            if not colon or not re.fullmatch(r"\w+", name.strip()):
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


def check_rooms(root, module, faults):
    folder, readme = ROOMS[module], f"{module}/README.md"
    drawn = drawn_rooms(root, readme, faults)
    on_disk = {}
    for source in sources(root, folder):
        parts = source.path.relative_to(folder).parts
        if len(parts) > 1:
            on_disk.setdefault(parts[0], []).append(source)
    for room in sorted(on_disk.keys() - drawn.keys()):
        faults.append(f"{on_disk[room][0].path}:1: the room {room} is not in {readme}")
    for room in sorted(drawn.keys() - on_disk.keys()):
        faults.append(f"{readme}:{drawn[room][0]}: there is no room {room}")

    found = {room: {} for room in on_disk}
    for room, members in on_disk.items():
        own = {s.path.name for s in members}
        for source in members:
            for number, is_quoted, include in source.includes:
                where = f"{source.path}:{number}"
                target, is_there = include.split("/")[0], (root / folder / include).is_file()
                public = re.match(r"viewgain/(\w+)[/.]", include)
                if public and public[1] in on_disk and (root / folder / public[1] / "include" / include).is_file():
                    target, is_there = public[1], True
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


def check_modules(all_sources, faults):
    """Dependencies between modules, and what public headers include."""
    for source in all_sources:
        module = source.path.parts[0]
        for number, _, include in source.includes:
            where = f"{source.path}:{number}"
            match = re.match(r"viewgain/(\w+)/", include)
            if match and match[1] not in LOWER.get(module, {match[1]}):
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


def faults_of(root):
    faults = []
    for module in ROOMS:
        check_rooms(root, module, faults)
    product = [s for folder in ("core", *ROOMS) for s in sources(root, folder)]
    check_modules(product, faults)
    check_sizes(product, faults)
    check_heavy(product + sources(root, "tests"), faults)
    return faults


class FindsFaults(unittest.TestCase):
    """Each case changes one thing in a tree without faults; the line is what must be printed."""

    TREE = {
        "core/src/pose.cpp": '#include "viewgain/core/pose.hpp"\n',
        "core/include/viewgain/core/pose.hpp": "#include <Eigen/Core>\n",
        "grid/README.md": "# grid\n```rooms\nmap:\nupdate: map\n```\n",
        "grid/include/viewgain/grid/grid.hpp": '#include "viewgain/core/pose.hpp"\n',
        "grid/src/map/storage.hpp": "#include <openvdb/openvdb.h>\n",
        "grid/src/update/apply.cpp": '#include "map/storage.hpp"\n#include "readings.hpp"\n',
        "grid/src/update/readings.hpp": "\n",
        "raycast/README.md": "```rooms\nscene:\ntrace: scene\ngain: scene, trace\n```\n",
        "raycast/src/scene/scene.hpp": '#include "viewgain/grid/grid.hpp"\n',
        "raycast/src/trace/trace.hpp": '#include "scene/scene.hpp"\n',
        "raycast/src/gain/gain.cpp": '#include "scene/scene.hpp"\n#include "trace/trace.hpp"\n',
        "mesh/README.md": "```rooms\nsurface:\n```\n",
        "mesh/include/viewgain/mesh/surface.hpp": "\n",
        "mesh/src/surface/surface.cpp": "#include <CGAL/Surface_mesh.h>\n",
        "apps/README.md": "```rooms\nformats:\nplanner: formats\nviewgain: planner\n```\n",
        "apps/formats/include/viewgain/formats/ply.hpp": "\n",
        "apps/planner/files.cpp": '#include "viewgain/formats/ply.hpp"\n',
        "apps/planner/stage.hpp": '#include "viewgain/mesh/surface.hpp"\n',
        "apps/viewgain/main.cpp": '#include "planner/stage.hpp"\n#include "viewgain/core/pose.hpp"\n',
        "perf/README.md": "```rooms\nmicro:\n```\n",
        "perf/measure.hpp": "\n",
        "perf/micro/micro.cpp": '#include "measure.hpp"\n#include "scene/scene.hpp"\n',
        "tests/grid/vdb_test.cpp": '#include "map/storage.hpp"\n',
    }

    def faults(self, changes):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**self.TREE, **changes}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return faults_of(root)

    def expect(self, start, changes):
        faults = self.faults(changes)
        self.assertEqual(len(faults), 1, faults)
        self.assertTrue(faults[0].startswith(start), f"{faults[0]!r} does not begin with {start!r}")

    def test_none(self):
        self.assertEqual(self.faults({}), [])

    def test_arrow_not_drawn(self):
        self.expect("raycast/src/gain/gain.cpp:2: the arrow gain -> trace is not in raycast/README.md",
                    {"raycast/README.md": "```rooms\nscene:\ntrace: scene\ngain: scene\n```\n"})

    def test_arrow_to_a_public_header(self):
        self.expect('apps/viewgain/main.cpp:1: the arrow viewgain -> formats is not in apps/README.md',
                    {"apps/viewgain/main.cpp": '#include "viewgain/formats/ply.hpp"\n#include "planner/stage.hpp"\n'})

    def test_arrow_not_found(self):
        self.expect("grid/README.md:4: no source of update includes one of map",
                    {"grid/src/update/apply.cpp": '#include "readings.hpp"\n'})

    def test_circle(self):
        self.expect("grid/src/map/storage.hpp:1: the arrows go in a circle: map -> update -> map",
                    {"grid/README.md": "```rooms\nmap: update\nupdate: map\n```\n",
                     "grid/src/map/storage.hpp": '#include "update/readings.hpp"\n'})

    def test_arrow_back(self):
        faults = self.faults({"raycast/src/scene/scene.hpp": '\n#include "trace/trace.hpp"\n'})
        self.assertEqual([f.split(": ")[0] for f in faults], 2 * ["raycast/src/scene/scene.hpp:2"])

    def test_room_not_listed(self):
        self.expect("mesh/src/quality/tree.cpp:1: the room quality is not in mesh/README.md",
                    {"mesh/src/quality/tree.cpp": "\n"})

    def test_room_not_there(self):
        self.expect("mesh/README.md:3: there is no room quality", {"mesh/README.md": "```rooms\nsurface:\nquality:\n```\n"})

    def test_no_block(self):
        faults = self.faults({"perf/README.md": "# perf\n"})
        self.assertEqual(faults, ["perf/README.md:1: has no block ```rooms",
                                  "perf/micro/micro.cpp:1: the room micro is not in perf/README.md"])

    def test_line_without_a_room(self):
        self.expect("mesh/README.md:3: a line of a rooms block is", {"mesh/README.md": "```rooms\nsurface:\nfree text\n```\n"})

    def test_other_room_not_named(self):
        self.expect('apps/viewgain/info.cpp:1: "stage.hpp" is in another room: "planner/stage.hpp"',
                    {"apps/viewgain/info.cpp": '#include "stage.hpp"\n'})

    def test_path_up(self):
        self.expect('apps/viewgain/info.cpp:2: "../planner/stage.hpp" goes up',
                    {"apps/viewgain/info.cpp": '\n#include "../planner/stage.hpp"\n'})

    def test_too_many_sources(self):
        many = {f"mesh/src/surface/s{i:02}.cpp": "\n" for i in range(MOST_SOURCES)}
        self.expect("mesh/src/surface/surface.cpp:1: mesh/src/surface has 17 .cpp", many)
        many = {f"core/src/s{i:02}.cpp": "\n" for i in range(MOST_SOURCES)}
        self.expect("core/src/s15.cpp:1: core/src has 17 .cpp", many)

    def test_long_source(self):
        self.assertEqual(self.faults({"perf/micro/long.cpp": "\n" * MOST_LINES}), [])
        self.expect("perf/micro/long.cpp:401: over 400 lines", {"perf/micro/long.cpp": "\n" * (MOST_LINES + 1)})

    def test_module_above(self):
        cases = 0
        for name, above in (("core/src/pose.cpp", "grid"), ("grid/src/map/map.cpp", "raycast"), ("mesh/src/surface/s.cpp", "grid"),
                            ("raycast/src/scene/s.cpp", "mesh"), ("mesh/include/viewgain/mesh/m.hpp", "raycast"),
                            ("raycast/src/scene/s.cpp", "planner")):
            module = name.split("/")[0]
            self.expect(f"{name}:1: {module} must not include {above}", {name: f'#include "viewgain/{above}/x.hpp"\n'})
            cases += 1
        self.assertEqual(cases, 6)

    def test_public_header(self):
        for library in ("openvdb/openvdb.h", "embree4/rtcore.h", "CGAL/Kernel.h"):
            self.expect("grid/include/viewgain/grid/x.hpp:1: a public header includes",
                        {"grid/include/viewgain/grid/x.hpp": f"#include <{library}>\n"})

    def test_tbb(self):
        self.expect("raycast/src/gain/t.cpp:1: no header of TBB", {"raycast/src/gain/t.cpp": "#include <tbb/parallel_for.h>\n"})

    def test_too_many_with_openvdb(self):
        # apply.cpp and vdb_test.cpp include it through storage.hpp.
        many = {f"tests/grid/t{i}_test.cpp": '#include "map/storage.hpp"\n' for i in range(7)}
        self.expect("tests/grid/vdb_test.cpp:1: 9 sources include openvdb, 8 are the most", many)


def main():
    if sys.argv[1:] == ["--self-test"]:
        unittest.main(argv=sys.argv[:1])
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = faults_of(pathlib.Path(sys.argv[1]))
    print("\n".join(faults) or "the rooms are as drawn")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
