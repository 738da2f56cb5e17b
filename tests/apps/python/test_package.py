# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The stubs name what there is, and everything is documented."""
import ast
import importlib.util
import inspect
import pathlib
import pickle
import re

import pytest

import viewgain

MODULES = ["viewgain._viewgain"]
if importlib.util.find_spec("viewgain.mesh") is not None:
    MODULES.append("viewgain.mesh._mesh")


def public(names):
    return {name for name in names if not name.startswith("_")}


def stub_of(module):
    text = pathlib.Path(module.__file__).parent / (module.__name__.rpartition(".")[2] + ".pyi")
    return ast.parse(text.read_text())


def names_in(body):
    names = set()
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    return public(names)


@pytest.mark.parametrize("name", MODULES)
def test_stub_and_module_name_the_same(name):
    module = importlib.import_module(name)
    stub = stub_of(module)
    assert names_in(stub.body) == public(dir(module))
    checked = 0
    for node in stub.body:
        if not isinstance(node, ast.ClassDef) or node.name == "Error":
            continue
        members = public(dir(getattr(module, node.name)))
        assert names_in(node.body) == members, node.name
        checked += len(members)
    assert checked >= (60 if name == MODULES[0] else 8)


@pytest.mark.parametrize("name", MODULES)
def test_parameters_are_those_of_the_stub(name):
    module = importlib.import_module(name)
    checked = 0
    for node in stub_of(module).body:
        functions = node.body if isinstance(node, ast.ClassDef) else [node]
        owner = getattr(module, node.name, None) if isinstance(node, ast.ClassDef) else module
        for function in functions:
            if not isinstance(function, ast.FunctionDef) or owner is None:
                continue
            decorated = {ast.unparse(d) for d in function.decorator_list}
            if "property" in decorated or function.name == "__init__" and "__init__" not in vars(owner):
                continue
            doc = inspect.getattr_static(owner, function.name, None)
            doc = getattr(getattr(owner, function.name), "__doc__", None) if doc is not None else None
            assert doc, function.name
            line = doc.splitlines()[0]
            args = [a.arg for a in function.args.args + function.args.kwonlyargs if a.arg != "self"]
            positions = [line.find(f"{arg}:") for arg in args]
            assert -1 not in positions and positions == sorted(positions), (line, args)
            checked += 1
    assert checked >= (40 if name == MODULES[0] else 4)


def test_everything_is_documented():
    checked = 0
    for module_name in ("viewgain", "viewgain.mesh", "viewgain.distributed"):
        try:
            module = importlib.import_module(module_name)
        except ImportError:  # without CGAL, or without Dask
            continue
        for name in public(getattr(module, "__all__", dir(module))):
            thing = getattr(module, name)
            if inspect.ismodule(thing) or isinstance(thing, tuple):  # names of codes, said where the codes are
                continue
            # What a constructor takes stands in the class's own words.
            members = public(vars(thing)) if inspect.isclass(thing) else set()
            for full, one in [(name, thing)] + [(f"{name}.{key}", vars(thing)[key]) for key in members]:
                # pybind11 begins with the signature, which is no word about it.
                words = re.sub(r"(?m)^\w+\(.*\) -> .*$|^\w+\(\*args.*$|Overloaded function\.|^\d+\. ", "", inspect.getdoc(one) or "")
                assert words.strip(), f"{module_name}.{full}"
                checked += 1
    assert checked > 150


@pytest.mark.parametrize("name", MODULES)
def test_classes_say_how_they_are_pickled(name, evaluator, sensor):
    module = importlib.import_module(name)
    classes = [thing for thing in vars(module).values()
               if inspect.isclass(thing) and not issubclass(thing, Exception)]
    for one in classes:
        assert "__reduce_ex__" in vars(one), one
    assert len(classes) == (18 if name == MODULES[0] else 2)
    things = [evaluator, evaluator.scene, viewgain.BatchControl(),
              viewgain.FeasibilityChecker(evaluator.scene), viewgain.FrameIntegrator(sensor),
              viewgain.CloudIntegrator(sensor)]
    for thing in things:
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            with pytest.raises(TypeError, match=f"cannot pickle '{type(thing).__name__}'"):
                pickle.dumps(thing, protocol)


def test_package():
    folder = pathlib.Path(viewgain.__file__).parent
    assert (folder / "py.typed").exists()
    assert viewgain.__version__.count(".") == 2
    assert public(dir(viewgain._viewgain)) <= set(dir(viewgain))
