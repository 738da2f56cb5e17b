# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The spec of a study, a TOML file. There is one run for each combination of its lists."""
from __future__ import annotations

import dataclasses
import difflib
import functools
import hashlib
import itertools
import json
import os
import pathlib
import re
import shlex
from typing import Optional

from .rows import SpecError

try:
    import tomllib
except ImportError:  # Python 3.9 and 3.10
    import tomli as tomllib

_FORMAT = 5  # format of the files of runs; increases when it changes
_MOST_RUNS = 1_000_000
_KEYS = ("objects", "policies", "against", "seeds", "sensors", "voxels", "sizes", "max_views", "tolerance", "flags", "kept_candidates")
_OBJECT_KEYS = ("mesh", "name", "reach", "obstacles", "flags")
_OWN_FLAGS = {f"--{name}" for name in ("sensor voxel size seed policy gain out max-views pictures report save-maps plan threads json "
                                       "quiet config save-config tolerance resume").split()}  # set by the study itself
_FILE_FLAGS = ("--reach", "--poses", "--hazard", "--obstacle")
_REPEATED = ("--obstacle", "--fine", "--stop")  # an object's flags add to those of all objects instead of replacing them


def _is_file(path):
    try:
        return pathlib.Path(path).is_file()
    except (OSError, ValueError):  # a name too long, a byte that no name has
        return False


@dataclasses.dataclass(frozen=True)
class Object:
    """A mesh and its surroundings."""
    name: str
    mesh: pathlib.Path
    words: tuple[str, ...]  # flags of reconstruct for this object alone


@dataclasses.dataclass(frozen=True)
class Policy:
    """A method of choosing views. If `command` is not empty, it replaces ``viewgain reconstruct``."""
    name: str
    policy: str
    gain: Optional[str] = None
    words: tuple[str, ...] = ()
    command: tuple[str, ...] = ()


@dataclasses.dataclass(frozen=True)
class Run:
    """One run. `hash` depends on everything that can change its result."""
    object: Object
    policy: Policy
    seed: int
    sensor: str
    voxel: float  # [m]
    size: Optional[float]  # longest side [m]
    configuration: dict = dataclasses.field(compare=False)
    hash: str


@dataclasses.dataclass(frozen=True)
class Spec:
    """The runs of a study. `runs` is ordered by sensor, then voxel, size, object, seed and policy."""
    path: pathlib.Path
    objects: tuple[Object, ...]
    policies: tuple[Policy, ...]
    against: str  # name of the policy with which all others are compared
    max_views: int
    tolerance: float  # tolerance of coverage [m]
    flags: tuple[str, ...]
    kept_candidates: int  # number per view
    runs: tuple[Run, ...]

    @functools.cached_property
    def _varied(self):
        return {key for key in ("sensor", "voxel", "size") if len({getattr(run, key) for run in self.runs}) > 1}

    def title(self, run: Run) -> str:
        """The name of a run, such as "camel, gain:combined, seed 3". Has sensor, voxel and size if the spec lists several."""
        parts = [run.object.name, run.policy.name, f"seed {run.seed}"]
        texts = {"sensor": run.sensor, "voxel": f"voxel {run.voxel:g}", "size": f"size {run.size or 0:g}"}
        return ", ".join(parts + [text for key, text in texts.items() if key in self._varied])

    def words(self, run: Run) -> list[str]:
        """The arguments of ``reconstruct`` for a run, without --out and --threads. Turns off all stopping rules except max_views, unless a flag
        of the spec sets one."""
        words = [f"--sensor={run.sensor}", f"--voxel={run.voxel!r}", f"--seed={run.seed}", f"--max-views={self.max_views}",
                 f"--tolerance={self.tolerance!r}", "--pictures=off", "--quiet", *run.policy.words]
        if run.size is not None:
            words.append(f"--size={run.size!r}")
        if self.kept_candidates:
            words.append("--save-maps=on")
        stop, replaced = ["gain=0,area=0,idle=0,promises=0"], {word.partition("=")[0] for word in run.object.words} - set(_REPEATED)
        for flag in (*(flag for flag in self.flags if flag.partition("=")[0] not in replaced), *run.object.words):
            if flag.startswith("--stop="):
                stop.append(flag[len("--stop="):])
            else:
                words.append(flag)
        return [*words, f"--stop={','.join(stop)}", "--", str(run.object.mesh)]


class _Reader:
    """Reads the keys of a TOML file. Errors name file and line."""

    def __init__(self, path):
        self.path, self.folder = path, path.parent
        try:
            self.text = path.read_text(encoding="utf-8")
            self.table = tomllib.loads(self.text)
        except OSError as error:
            raise SpecError(f"{path}: {error.strerror}") from error
        except (ValueError, RecursionError) as error:  # also of bytes that are no UTF-8
            raise SpecError(f"{path}: the file is not valid TOML: {error}") from error
        for key in self.table:
            if key not in _KEYS:
                near = difflib.get_close_matches(key, _KEYS, 1)
                self.fail(key, f"is not a key of a study; {f'did you mean {near[0]}? Valid' if near else 'valid'} keys: {', '.join(_KEYS)}")

    def fail(self, key, message):
        found = re.search(rf"^\s*\"?{re.escape(key)}\"?\s*=", self.text, re.MULTILINE)
        line = f", line {self.text.count(chr(10), 0, found.end()) + 1}" if found else ""
        raise SpecError(f"{self.path}{line}: {key} {message}")

    def values(self, key, kind, is_right, must):
        """The value of a key that must be a list of distinct values."""
        if key not in self.table:
            raise SpecError(f"{self.path}: {key} is missing; it {must}")
        values = self.table[key]
        if not isinstance(values, list) or not values:
            self.fail(key, "must be a list with at least one entry")
        seen = set()
        for value in values:
            if isinstance(value, bool) or not isinstance(value, kind) or not is_right(value):
                self.fail(key, f"contains {value!r}; it {must}")
            if repr(value) in seen:
                self.fail(key, f"contains {value!r} twice")
            seen.add(repr(value))
        return values

    def lengths(self, key):
        return [float(value) for value in self.values(key, (int, float), lambda v: 0 < v < 1e9,
                                                      "must be a list of positive lengths [m]")]

    def number(self, key, kind, least, most, otherwise=None):
        value = self.table.get(key, otherwise)
        if value is None and key not in self.table:
            raise SpecError(f"{self.path}: {key} is missing; it must be a number in {least}..{most}")
        if isinstance(value, bool) or not isinstance(value, kind) or not least <= value <= most:
            self.fail(key, f"must be a {'whole ' if kind is int else ''}number in {least}..{most}, not {value!r}")
        return value

    def flags(self, key, values):
        """Checks a list of further flags of reconstruct. Makes relative files in them absolute; they are relative to the current folder."""
        if not isinstance(values, list):
            self.fail(key, 'must be a list of strings like "--up=y"')
        flags = []
        for flag in values:
            if not isinstance(flag, str) or not re.match(r"--\w", flag):
                self.fail(key, f'contains {flag!r}; it must be a list of strings like "--up=y"')
            name, equals, value = flag.partition("=")
            if "\0" in flag:
                self.fail(key, f"contains {flag!r}, which has a zero byte")
            if name in _OWN_FLAGS and not (key == "objects" and name == "--size"):
                self.fail(key, f"contains {name}; the study sets this flag itself")
            if name == "--help":
                self.fail(key, "contains --help, which is not a setting")
            before, file = _file_of(name, value)
            flags.append(name + equals + before + (os.path.abspath(file) if file else ""))
        return flags

    def file(self, key, name):
        if name is None:
            self.fail(key, "contains an entry without a file")
        if not isinstance(name, str) or not _is_file(self.folder / name):
            self.fail(key, f"contains {name!r}, but the file {self.folder / str(name)} does not exist")
        return pathlib.Path(os.path.abspath(self.folder / name))  # links are not resolved, because the name determines the kind of mesh


def _file_of(name, value):
    """Splits the value of a flag into the part before the name of a file, and the name, which is empty if there is none."""
    before, comma, last = value.rpartition(",") if name == "--hazard" else ("", "", value)  # size=L,FILE
    return (before + comma, last) if name in _FILE_FLAGS and _is_file(last) else (value, "")


def _is_name(text):
    return isinstance(text, str) and text and text.isprintable() and "|" not in text


def _object(reader, value):
    entry = {"mesh": value} if isinstance(value, str) else value
    for key in entry:
        if key not in _OBJECT_KEYS:
            reader.fail("objects", f"has an entry with the unknown key {key!r}; valid keys: {', '.join(_OBJECT_KEYS)}")
    mesh = reader.file("objects", entry.get("mesh"))
    name = entry.get("name", mesh.stem)
    if not _is_name(name):
        reader.fail("objects", f"contains {value!r}, whose name cannot be shown in a table; rename it with {{mesh = ..., name = ...}}")
    words = [f"--reach={reader.file('objects', entry['reach'])}"] if "reach" in entry else []
    obstacles = entry.get("obstacles", [])
    if not isinstance(obstacles, list):
        reader.fail("objects", f"contains {value!r}; obstacles must be a list of files and boxes \"x0,y0,z0,x1,y1,z1\"")
    for obstacle in obstacles:
        numbers = re.fullmatch(r"[-+.\deE]+(,[-+.\deE]+)+", str(obstacle))
        if numbers and str(obstacle).count(",") != 5:
            reader.fail("objects", f"contains the obstacle {obstacle!r}; a box has six numbers, \"x0,y0,z0,x1,y1,z1\" [m]")
        words.append(f"--obstacle={obstacle if numbers else reader.file('objects', obstacle)}")
    words += reader.flags("objects", entry.get("flags", []))
    if "sizes" in reader.table and any(word.startswith("--size=") for word in words):
        reader.fail("objects", f"contains {value!r}; give either sizes for all objects or --size for each object")
    return Object(name, mesh, tuple(words))


def _policy(reader, value):
    if isinstance(value, dict):
        name, command = value.get("name"), value.get("command")
        if set(value) != {"name", "command"} or not _is_name(name) or ":" in name or not isinstance(command, str) or "\0" in command:
            reader.fail("policies", f"contains {value!r}; your own policy must be {{name = \"...\", command = \"...\"}}, and its name must not contain : or |")
        try:
            words = shlex.split(command)
        except ValueError as error:
            reader.fail("policies", f"contains {value!r}: {error}")
        if not words:
            reader.fail("policies", f"contains {value!r}, which has no command")
        # Words that name files in the spec's folder become absolute paths.
        return Policy(name, name, command=tuple(os.path.abspath(reader.folder / word) if _is_file(reader.folder / word) else word for word in words))
    if value.startswith("tour:") or value == "tour":
        counts = re.fullmatch(r"tour:([1-9]\d{0,3}):([1-9]\d{0,3})", value)
        if not counts or not 2 <= int(counts[1]) <= 1000 or int(counts[2]) > int(counts[1]):
            reader.fail("policies", f"contains {value!r}; a tour must be \"tour:K:M\", which plans K views (2..1000) and replans after M of them")
        return Policy(value, value, words=("--policy=gain", f"--plan={counts[1]},{counts[2]}"))
    policy, colon, gain = value.partition(":")
    if (policy == "gain") != bool(gain) or (colon and not gain) or not policy:
        reader.fail("policies", f"contains {value!r}; a policy must be \"gain:NAME\" (\"gain:combined\") or another policy of reconstruct (\"frontier\")")
    return Policy(value, policy, gain or None, (f"--policy={policy}", *([f"--gain={gain}"] if gain else [])))


def _identity(path):
    """Hash of the contents of a file. That of a reach file includes the poses to which it refers."""
    data = pathlib.Path(path).read_bytes()
    poses = re.search(rb"^\s*poses\s*=\s*[\"'](.+?)[\"']", data, re.MULTILINE) if str(path).endswith(".toml") else None
    inner = pathlib.Path(path).parent / poses[1].decode(errors="replace") if poses else None
    return "file " + hashlib.sha256(data + (inner.read_bytes() if inner and _is_file(inner) else b"")).hexdigest()[:16]


def _flag_identity(flag):
    name, equals, value = flag.partition("=")
    before, file = _file_of(name, value)
    return name + equals + before + (_identity(file) if file else "")


def read_spec(path, version: str = "") -> Spec:
    """Reads a spec. `version` is the version of the program, on which the hash of each run depends. Raises SpecError with the file, the line and
    what to do."""
    reader = _Reader(pathlib.Path(path))
    text = (str, lambda value: bool(value))
    objects = [_object(reader, value) for value in reader.values("objects", (str, dict), bool, "must be a list of mesh files or tables")]
    names = [one.name for one in objects]
    for i, name in enumerate(names):
        if name in names[:i]:
            reader.fail("objects", f"contains two objects with the name {name!r}; rename one with {{mesh = ..., name = ...}}")
    policies = [_policy(reader, value) for value in reader.values("policies", (str, dict), bool, "must be a list of names")]
    seeds = reader.values("seeds", int, lambda value: 0 <= value <= 2**62, "must be a list of whole numbers in 0..2^62")
    sensors = [str(reader.file("sensors", value)) if value.endswith(".toml") else value
               for value in reader.values("sensors", *text, "must be a list of presets and .toml files")]
    voxels = reader.lengths("voxels")
    sizes = reader.lengths("sizes") if "sizes" in reader.table else [None]
    max_views = reader.number("max_views", int, 1, 1000)
    tolerance = float(reader.number("tolerance", (int, float), 1e-9, 1e9, max(0.005, *voxels)))
    kept = reader.number("kept_candidates", int, 1, 100_000, None) if "kept_candidates" in reader.table else 0
    flags = reader.flags("flags", reader.table.get("flags", []))
    against = reader.table.get("against", policies[0].name)
    policy_names = [policy.name for policy in policies]
    if against not in policy_names:
        reader.fail("against", f"is {against!r}; valid policies: {', '.join(policy_names)}")
    for key, given in (("policies", policy_names), ("sensors", sensors)):
        twice = next((one for i, one in enumerate(given) if one in given[:i]), None)
        if twice is not None:
            reader.fail(key, f"contains {twice!r} twice")
    count = len(sensors) * len(voxels) * len(sizes) * len(objects) * len(seeds) * len(policies)
    if count > _MOST_RUNS:
        reader.fail("seeds", f"and the other lists make {count:,} runs together; the maximum is {_MOST_RUNS:,}")

    shared = {"version": version, "format": _FORMAT, "max_views": max_views, "tolerance": tolerance, "kept_candidates": kept,
              "flags": [_flag_identity(flag) for flag in flags]}
    by_object = {one.name: {"object": one.name, "mesh": _identity(one.mesh), "own": [_flag_identity(w) for w in one.words]} for one in objects}
    by_sensor = {sensor: _identity(sensor) if sensor.endswith(".toml") else sensor for sensor in sensors}
    by_policy = {policy.name: [_identity(word) if _is_file(word) else word for word in policy.command] for policy in policies}
    runs = []
    for sensor, voxel, size, one, seed, policy in itertools.product(sensors, voxels, sizes, objects, seeds, policies):
        configuration = {**shared, **by_object[one.name], "policy": policy.name, "command": by_policy[policy.name], "seed": seed,
                         "sensor": by_sensor[sensor], "voxel": voxel, "size": size}
        digest = hashlib.sha256(json.dumps(configuration, sort_keys=True).encode()).hexdigest()[:16]
        runs.append(Run(one, policy, seed, sensor, voxel, size, configuration, digest))
    return Spec(reader.path, tuple(objects), tuple(policies), against, max_views, tolerance, tuple(flags), kept, tuple(runs))
