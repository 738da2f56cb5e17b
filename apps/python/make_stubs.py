#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the types of an extension module, for editors and type checkers.

    make_stubs.py FOLDER MODULE FILE.pyi

FOLDER holds the package. Names, order and defaults come from pybind11's signatures. Types come from the docstrings (numpydoc), such as
"array_like, (..., 4, 4), optional". A parameter without a type is an error.
"""
import ast
import functools
import importlib
import inspect
import re
import sys

HEAD = '''# Made of the docstrings by make_stubs.py.
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Literal, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

{imports}

_Path = Union[str, bytes, "os.PathLike[str]"]
'''
# Types that docstrings state in words.
WORDS = {
    "path-like": "_Path", "path": "_Path", "array_like": "ArrayLike", "callable": "Callable[..., Any]", "dict": "dict[str, float]",
    "iterable of (vertices, triangles)": "Iterable[tuple[ArrayLike, ArrayLike]]", "iterable of (box, weight)": "Iterable[tuple[ArrayLike, float]]",
    "sequence of frames": "FrameSequence | Sequence[tuple[ArrayLike, ArrayLike]]",
    "(float, float)": "tuple[float, float]", "tuple of 3 int": "tuple[int, int, int]", "trimesh.Trimesh": "Any", "open3d.geometry.TriangleMesh": "Any",
}
# Signatures of callables, by the name of the parameter.
CALLED = {
    "progress": "[int, int], object", "predicate": "[NDArray[np.float64]], object", "generator": "[BeliefGrid], ArrayLike",
    "measure": "[NDArray[np.float64], Any], float", "way": "[int, int], float", "acquire": "[NDArray[np.float64]], Any",
    "observer": "[ViewRecord], object",
}
PROTOCOLS = {
    "__len__": "(self) -> int", "__getitem__": "(self, index: int) -> Frame", "__iter__": "(self) -> Iterator[Frame]",
}
faults = []


def type_of(words):
    """The type for words such as "ndarray, (n, 4, 4), float64, or None"."""
    words = words.strip().replace("viewgain.", "")
    if words.endswith(", optional"):
        return type_of(words[:-len(", optional")]) + " | None"
    if words.endswith(" or None"):
        return type_of(words[:-len(" or None")].rstrip(",")) + " | None"
    if words in WORDS:
        return WORDS[words]
    if words.startswith("{"):
        return f"Literal[{words[1:-1]}]"
    if array := re.fullmatch(r"ndarray, \((.*?)\), (\w+)", words):
        scalar = "np.void" if array[2] == "structured" else "np.bool_" if array[2] == "bool" else f"np.{array[2]}"
        return f"{scalar} | NDArray[{scalar}]" if array[1] == "..." else f"NDArray[{scalar}]"  # a single pose gives a scalar
    if some := re.fullmatch(r"(list|sequence) of (\w+)(, \(.*\))?", words):
        return f"{some[1].replace('sequence', 'Sequence')}[{some[2]}]"
    if words.startswith("array_like"):
        return "ArrayLike"
    if " or " in words:
        return " | ".join(type_of(word) for word in re.split(r", (?=\w+ or )| or ", words))
    if not words.isidentifier():
        faults.append(f"no type is called {words!r}")
    return words


def sections(doc, owner):
    """{parameter: words}, and the words for the result. "As ``name``" refers to another docstring of the owner."""
    parameters, returned, section, names = {}, None, "", ""
    for line in inspect.cleandoc(doc).splitlines():
        if line in ("Parameters", "Returns", "Raises"):
            section = line
        elif section == "Parameters" and (found := re.fullmatch(r"(\w+(?:, \w+)*) : (.+)", line)):
            parameters.update((name, found[2]) for name in found[1].split(", "))
        elif section == "Parameters" and (found := re.fullmatch(r" +As ``([\w.]+)``.*", line)):
            other = functools.reduce(getattr, found[1].split("."), owner).__doc__
            parameters.update((name, sections(other, owner)[0].get(name, "")) for name in names.split(", "))
        elif section == "Returns" and returned is None and re.match(r"\w", line):
            returned = line.partition(" : ")[2] or line
        names = line
    return parameters, returned


def indented(doc, depth):
    text = inspect.cleandoc(doc).replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    return re.sub(r"\n(?=.)", "\n" + "    " * depth, f'"""{text}"""')


def function(name, doc, depth, owner, decorator=""):
    signature, _, words = doc.partition("\n")
    head, _, result = signature.rpartition(" -> ")
    arguments = ast.parse(f"def {head}: ...").body[0].args
    parameters, returned = sections(owner.__doc__ if name == "__init__" else words, owner)
    for argument in arguments.args + arguments.kwonlyargs:
        if argument.arg == "self":
            argument.annotation = None
            continue
        if argument.arg not in parameters:
            faults.append(f"{name}: the docstring says no type of {argument.arg}")
        said = type_of(parameters.get(argument.arg, "callable").removesuffix(", optional"))
        said = said.replace("Callable[..., Any]", f"Callable[{CALLED.get(argument.arg)}]")
        argument.annotation = ast.Name(said)
    for argument, default in [*zip(arguments.args[::-1], arguments.defaults[::-1]), *zip(arguments.kwonlyargs, arguments.kw_defaults)]:
        if isinstance(default, ast.Constant) and default.value is None:
            argument.annotation.id += " | None"
    for argument in (arguments.vararg, arguments.kwarg):
        if argument is not None:
            argument.annotation = ast.Name("Any")
    if result != "None" and returned is None:
        faults.append(f"{name}: the docstring says nothing of what it returns")
    result = "None" if result == "None" or returned is None else type_of(returned)
    lines = [decorator] * bool(decorator)
    lines.append(f"def {name}({ast.unparse(arguments)}) -> {result}:")
    lines.append("    " + (indented(words.strip(), depth + 1) if words.strip() else "..."))
    return "".join("    " * depth + line + "\n" for line in lines)


def class_stub(name, one):
    base = "(RuntimeError)" if issubclass(one, Exception) else ""
    text = f"\nclass {name}{base}:\n    {indented(one.__doc__, 1)}\n"
    for key, member in vars(one).items():
        if key in PROTOCOLS:
            text += f"    def {key}{PROTOCOLS[key]}: ...\n"
        elif key.startswith("_") and key != "__init__" or base:
            continue
        elif isinstance(member, property):
            words = member.__doc__.splitlines()[0].partition(":")[0]
            text += f"    @property\n    def {key}(self) -> {type_of(words)}:\n        {indented(member.__doc__, 2)}\n"
        else:
            doc = getattr(one, key).__doc__
            if not doc.startswith(f"{key}("):
                continue  # of object
            is_static = not inspect.isroutine(vars(one)[key]) or isinstance(vars(one)[key], staticmethod)
            decorator = "@classmethod" if isinstance(vars(one)[key], classmethod) else "@staticmethod" if is_static else ""
            text += function(key, doc, 1, one, decorator)
    return text


def main(folder, name, file):
    sys.path[0] = folder  # replaces the script's folder, where the package is incomplete
    module = importlib.import_module(name)
    package = importlib.import_module(name.rpartition(".")[0])
    names = [key for key in vars(module) if not key.startswith("_")]
    text = ""
    for key in names:
        thing = getattr(module, key)
        if inspect.isclass(thing):
            text += class_stub(key, thing)
        elif callable(thing):
            text += function(key, thing.__doc__, 0, module)
        else:
            text += f"\n{key}: tuple[str, ...]\n"
    # Classes of the package beside the module, or of the package around it.
    used = sorted(set(re.findall(r"\w+", re.sub(r'"""[\s\S]*?"""', "", text))) - set(names))
    own = [key for key in used if inspect.isclass(getattr(package.results, key, None)) and key != "Any"]
    outer = [key for key in used if key not in own and inspect.isclass(getattr(sys.modules["viewgain"], key, None))]
    imports = [f"from {place} import {', '.join(found)}" for place, found in ((".results", own), ("..", outer)) if found]
    if faults:
        raise SystemExit("\n".join(f"{name}: {fault}" for fault in faults))
    with open(file, "w", encoding="utf-8") as out:
        out.write(HEAD.format(imports="\n".join(imports)) + ("\n__version__: str\n" if hasattr(module, "__version__") else "") + text)


if __name__ == "__main__":
    main(*sys.argv[1:])
