#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What the docstrings of the Python package say, name by name: shapes, dtypes, units, frames, errors, cost, threads.

    said_of_python.py    counts; prints `name: rule: what lacks` and ends with 1 if anything lacks

documented_test.py asks whether there are words; this asks for these, where signatures (of the stubs, of the sources) want them:

    named     each parameter has an entry under Parameters
    shape     an array has its shape in parentheses: (n, 4, 4)
    dtype     so has an array that is returned: float64, structured
    unit      a float or an array of floats has a unit in brackets, [m], or a word that says it has none: share, ...
    frame     a 4x4 or what has rows of 3 is of a frame: T_world_camera, world, grid, ...
    raises    what takes arguments has a section Raises with a name of an exception and when
    cost      what takes maps, scenes, frames, files or arrays without a fixed size has a sentence that begins `Cost:`, with
              an order of growth or a figure
    threads   so has it, where it is in C++, words on the GIL or on threads

An entry that refers to another function's (As ``integrate``.) has that one's words as well. Cost, threads and what a method
raises may be said once in its class, there under `Notes`.
"""
import ast
import enum
import importlib
import inspect
import pathlib
import re
import sys

MODULES = ["viewgain", "viewgain.plot", "viewgain.mesh", "viewgain.distributed"]
RULES = ("named", "shape", "dtype", "unit", "frame", "raises", "cost", "threads")
ARRAY = re.compile(r"ArrayLike|NDArray|ndarray|_Floats\b|_Rows\b|_Indices|_Image|Or[A-Z]\w+s\b|(?:Sequence|list|tuple)\[float")
WHOLE = re.compile(r"_Indices|_CodeOr|_BoolOr|u?int\d+\b|np\.bool")
GROWS = re.compile(r"ArrayLike|NDArray|ndarray|_Path|BeliefGrid|VoxelScene|FrameSequence|Surface\b|_Floats|_Rows|\bmap\b")
LARGE = {"BeliefGrid", "VoxelScene", "GainEvaluator", "FeasibilityChecker", "FrameIntegrator", "CloudIntegrator", "SimulatedSensor",
         "ViewPlanner", "FrameSequence", "Surface", "Reconstruction"}
SHAPE = re.compile(r"\(((?:\.\.\.|<?=? ?[a-z0-9][\w']*)(?:, ?(?:[a-z0-9][\w']*))*,?)\)")
DTYPE = re.compile(r"float(?:32|64)|u?int(?:8|32|64)|\bbool\b|structured|floating point|unicode")
UNIT = re.compile(r"\[[^\]]*\b(?:m|rad|deg|nat|s|px|Hz|spacings|%)\b[^\]]*\]")
UNITLESS = re.compile(r"\b(?:share|ratio|probability|log-odds|cosine|cos|counts?|weights?|factors?|multiples|indices|index into|"
                      r"whole numbers|coefficients|without a unit|unit (?:vectors?|normal)|in (?:its|the|their|one) unit|gain's unit)\b|"
                      r"\bin \[0, 1\]", re.I)
FRAME = re.compile(r"T_(?:world|flange)_\w+|\bworld\b|\b(?:grid|camera|sensor|flange|tree|file|surface)(?:'s)? (?:frame|image)\b|"
                   r"\bpoints' frame\b|\boptical axis\b|\blattice\b|\bon the flange\b", re.I)
SPATIAL = re.compile(r"(?:^|, )(?:4, 4|3)$|^2, 3$|^n, 2, 3$")
ERROR = r"(?:\w+\.)?(?:\w*Error|KilledWorker)"
RAISES = re.compile(rf"(?m)^{ERROR}(?:, {ERROR})*\n +\S+ \S+ \S+")  # and when, in three words at least
METHODS_RAISE = re.compile(rf"\braise\s+{ERROR} for \S+ \S+")
GROWTH = re.compile(r"\b(?:linear in|grows with|goes down with|constant time|is a copy|(?:that|times) of)\b|\b\d+ (?:times|ms|µs|ns|s)\b|"
                    r"\b(?:some|few) (?:ms|µs|(?:micro|milli)?seconds)\b")
THREADS = re.compile(r"\b(?:GIL|threads?|at a time|at once)\b")


def text_of(node):
    return ast.unparse(node) if node is not None else "None"


class Thing:
    """A public name: what its signature wants and what its docstring says."""

    def __init__(self, name, owner, kind, doc, parameters=(), result="None", is_native=False):
        self.name, self.owner, self.kind = name, owner, kind  # kind: class, function, value
        self.parameters, self.result, self.is_native = list(parameters), result, is_native
        self.sections = {"": ""}
        lines, title = inspect.cleandoc(doc or "").splitlines(), ""
        if is_native and kind == "function" and lines and "->" in lines[0]:
            lines = lines[1:]  # pybind11's signature is no word about it
        for i, line in enumerate(lines):
            if i + 1 < len(lines) and line and re.fullmatch(r"-{3,}", lines[i + 1]):
                title = line
            elif not re.fullmatch(r"-{3,}", line):
                self.sections[title] = self.sections.get(title, "") + line + "\n"
        self.entries = {}
        names = []
        for line in self.sections.get("Parameters", "").splitlines():
            if line and not line[0].isspace():
                names = [one.strip(" *") for one in line.split(" : ")[0].split(",")]
                self.entries.update((one, "") for one in names)
            for one in names:
                self.entries[one] += line.strip() + " "

    @property
    def words(self):
        return "\n".join(self.sections.values())

    def said_of_result(self):
        return self.words if self.kind == "value" else self.sections.get("Returns", "")

    def said_of_methods(self):
        return self.sections.get("Notes", "")


def parsed(path):
    """{name: node} of a stub or a source, members as `Class.member`."""
    nodes = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            nodes.setdefault(node.name, node)
        for inner in node.body if isinstance(node, ast.ClassDef) else ():
            if isinstance(inner, ast.FunctionDef):
                nodes[f"{node.name}.{inner.name}"] = inner  # the last overload returns most
    return nodes


def signature_of(node):
    """Parameters (name, type) and the result's type."""
    arguments = node.args
    every = arguments.posonlyargs + arguments.args + arguments.kwonlyargs
    pairs = [(one.arg, text_of(one.annotation)) for one in every if one.arg not in ("self", "cls")]
    return pairs, text_of(node.returns)


def source_of(thing):
    """The stub of what is in C++, else the source."""
    module = sys.modules[thing.__module__]
    folder = pathlib.Path(module.__file__).parent
    stub = folder / {"viewgain": "_viewgain.pyi", "viewgain.mesh": "_mesh.pyi"}.get(thing.__module__, "")
    is_native = not inspect.isfunction(thing) and not issubclass(type(thing), type) or type(thing).__name__ == "pybind11_type"
    return (stub if is_native else pathlib.Path(inspect.getsourcefile(thing))), is_native


def members_of(full, name, thing, nodes, is_native):
    """What a class has, by name."""
    if hasattr(thing, "_fields"):  # a named tuple
        for field in thing._fields:
            yield Thing(f"{full}.{field}", full, "value", getattr(thing, field).__doc__, (), str(thing.__annotations__[field]))
        return
    if not is_native:  # a dataclass, whose fields' words follow them
        for node, words in zip(nodes[name].body, nodes[name].body[1:]):
            if isinstance(node, ast.AnnAssign):
                said = ast.literal_eval(words.value) if isinstance(words, ast.Expr) else ""
                yield Thing(f"{full}.{node.target.id}", full, "value", said, (), text_of(node.annotation))
        return
    for key, member in vars(thing).items():
        if key.startswith("_"):
            continue
        parameters, result = signature_of(nodes[f"{name}.{key}"])
        kind = "value" if isinstance(member, property) else "function"
        yield Thing(f"{full}.{key}", full, kind, inspect.getdoc(getattr(thing, key)), parameters, result, True)


def things():
    for module_name in MODULES:
        try:
            module = importlib.import_module(module_name)
        except ImportError as error:
            print(f"{module_name} is left out: {error}")
            continue
        for name in getattr(module, "__all__", dir(module)):
            thing, full = getattr(module, name), f"{module_name}.{name}"
            if name.startswith("_") or inspect.ismodule(thing) or not callable(thing) or thing.__module__ != module_name:
                continue
            if inspect.isclass(thing) and issubclass(thing, (enum.Enum, Exception)):
                continue  # codes and what is raised have neither shapes nor units
            path, is_native = source_of(thing)
            nodes = parsed(path) if not hasattr(thing, "_fields") else {}
            doc = inspect.getdoc(thing)
            if not inspect.isclass(thing):
                yield Thing(full, None, "function", doc, *signature_of(nodes[name]), is_native)
                continue
            init = nodes.get(f"{name}.__init__")
            yield Thing(full, None, "class", doc, signature_of(init)[0] if init else (), "None", is_native)
            yield from members_of(full, name, thing, nodes, is_native)


class Count:
    """Of each rule: what was asked, and what lacks."""

    def __init__(self, every):
        self.every = {thing.name: thing for thing in every}
        self.asked, self.lacking = dict.fromkeys(RULES, 0), []

    def ask(self, thing, rule, what, is_said):
        self.asked[rule] += 1
        if not is_said:
            self.lacking.append((thing.name, rule, what))

    def referred(self, thing, text):
        """The things that a text names in double backticks."""
        for name in re.findall(r"``([\w.]+)``", text):
            module = thing.name[:thing.name.index(".", len("viewgain.mesh"))] if thing.name.startswith("viewgain.mesh.") else "viewgain"
            for full in (f"{thing.owner}.{name}", f"{module}.{name}", f"viewgain.{name}"):
                if full in self.every and full != thing.name:
                    yield self.every[full]
                    break

    def entry(self, thing, parameter, depth=0):
        """What is said of a parameter, there and where it is referred to; None without an entry."""
        text = thing.entries.get(parameter)
        if depth > 3:
            return text
        elsewhere = text if text is not None else " ".join(re.findall(r"Parameters are those of [^.]*\b.*?[.\n]", thing.words))
        for other in self.referred(thing, elsewhere):
            said = self.entry(other, parameter, depth + 1)
            if said is not None:
                text = (text or "") + said
        return text

    def look_at_value(self, thing, what, name, kind, text, is_result):
        """A parameter or a result: shape, dtype, unit, frame."""
        kind = re.sub(r"Callable\[.*\]", "Callable", kind)
        is_array, shapes = ARRAY.search(kind), SHAPE.findall(text)
        said = f"{name} {text}"
        if is_array:
            self.ask(thing, "shape", what, shapes or re.search(r"list of|sequence of|the grid's shape|\(float, float\)", text))
            if is_result and not re.search("list|tuple", kind):
                self.ask(thing, "dtype", what, DTYPE.search(text))
        is_pose = shapes and all(shape.endswith("4, 4") for shape in shapes)
        if (is_array and not WHOLE.search(kind) and not is_pose) or re.search(r"\bfloat\b", kind):
            self.ask(thing, "unit", what, UNIT.search(text) or UNITLESS.search(text))
        is_spatial = any(SPATIAL.search(shape) for shape in shapes) and not re.search(r"indices|\bindex of", text, re.I)
        if is_array and not WHOLE.search(kind) and is_spatial:
            self.ask(thing, "frame", what, FRAME.search(said))

    def look_at_call(self, thing):
        owner = self.every.get(thing.owner)
        of_class = owner.said_of_methods() if owner else ""
        if thing.kind != "value" and thing.parameters:
            self.ask(thing, "raises", "errors", RAISES.search(thing.sections.get("Raises", "")) or METHODS_RAISE.search(of_class))
        said = [(kind, self.entry(thing, name) or "") for name, kind in thing.parameters] + [(thing.result, thing.said_of_result())]
        grows = [kind for kind, text in said if GROWS.search(kind) and (not ARRAY.search(kind) or any(
            re.search(r"[a-z.]", shape) for shape in SHAPE.findall(text)) or not SHAPE.search(text))]
        is_large = thing.owner is not None and thing.owner.rpartition(".")[2] in LARGE
        if (thing.kind == "value" and not (grows and is_large and owner.is_native)) or not (grows or is_large):
            return
        every = thing.words + of_class
        self.ask(thing, "cost", "cost", any(GROWTH.search(one) for one in re.findall(r"Cost: ((?:.|\n)*?\.)(?:\s|$)", every)))
        if thing.is_native and thing.kind != "value":
            self.ask(thing, "threads", "threads", THREADS.search(every))

    def look(self):
        for thing in self.every.values():
            for name, kind in thing.parameters:
                text = self.entry(thing, name)
                self.ask(thing, "named", name, text is not None and len(text) > len(name))
                self.look_at_value(thing, name, name, kind, text or "", False)
            if thing.result != "None" and thing.kind != "class":
                self.look_at_value(thing, "the result", thing.name.rpartition(".")[2], thing.result, thing.said_of_result(), True)
            self.look_at_call(thing)


# How many names each rule is asked of in `viewgain` alone: fewer, and something is not looked at.
LEAST = {"named": 270, "shape": 140, "dtype": 54, "unit": 205, "frame": 74, "raises": 78, "cost": 76, "threads": 74}

WHOLE_DOC = """Where points are.

Runs without the GIL. Cost: linear in the points, 20 ns each.

Parameters
----------
points : array_like, (n, 3)
    World frame [m].

Returns
-------
ndarray, (n, 3), float64
    World frame [m].

Raises
------
ValueError
    Another shape or dtype.
"""
# What is taken away, or made an empty phrase, and the rules that must see it.
FAULTS = [("points : array_like", "point : array_like", {"named", "shape", "unit"}), ("array_like, (n, 3)", "array_like", {"shape"}),
          ("float64", "numbers", {"dtype"}), ("World frame [m].", "World frame.", {"unit"}), ("World frame", "Somewhere", {"frame"}),
          ("Another shape or dtype", "Wrong", {"raises"}), ("ValueError\n", "It\n", {"raises"}), ("Cost: linear in", "Fast for", {"cost"}),
          ("linear in the points, 20 ns each", "grows", {"cost"}), ("without the GIL", "well", {"threads"})]


def lacking_of(doc):
    count = Count([Thing("viewgain.center", None, "function", doc, [("points", "ArrayLike")], "NDArray[np.float64]", True)])
    count.look()
    return {rule for _, rule, _ in count.lacking}


def self_test():
    assert not lacking_of(WHOLE_DOC)
    for said, instead, rules in FAULTS:
        assert said in WHOLE_DOC and lacking_of(WHOLE_DOC.replace(said, instead)) == rules, (instead, rules)
    assert {rule for *_, rules in FAULTS for rule in rules} == set(RULES)


def main():
    self_test()
    count = Count(things())
    count.look()
    print(f"{len(count.every)} public names")
    for rule in RULES:
        lacking = sum(one[1] == rule for one in count.lacking)
        print(f"{rule:8} {count.asked[rule]:4} asked, {lacking:3} lacking")
        assert count.asked[rule] >= LEAST[rule], f"{rule}: asked {count.asked[rule]} times: are all names looked at?"
    for name, rule, what in count.lacking:
        print(f"{name}: {rule}: {what}")
    sys.exit(1 if count.lacking else 0)


if __name__ == "__main__":
    main()
