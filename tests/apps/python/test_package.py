# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The stubs name what there is, and everything is documented."""
import ast
import importlib.util
import inspect
import pathlib
import pickle
import typing

import numpy as np
import numpy.typing
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


@pytest.mark.parametrize("name", MODULES)
def test_everything_is_documented(name):
    module = importlib.import_module(name)
    for public_name in public(dir(module)):
        thing = getattr(module, public_name)
        if inspect.isclass(thing) or inspect.isbuiltin(thing):
            assert len(thing.__doc__ or "") > 30, public_name


@pytest.mark.parametrize("name", MODULES)
def test_members_are_documented_with_what_they_return(name):
    module = importlib.import_module(name)
    checked = 0
    for node in stub_of(module).body:
        if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name == "Error":
            continue
        is_class = isinstance(node, ast.ClassDef)
        for function in node.body if is_class else [node]:
            if function.name == "__init__":
                continue
            thing = getattr(getattr(module, node.name), function.name) if is_class else getattr(
                module, node.name)
            doc = thing.__doc__ or ""
            assert len(doc) >= 3, (node.name, function.name)
            is_property = any(ast.unparse(d) == "property" for d in function.decorator_list)
            if not is_property and ast.unparse(function.returns) != "None":
                assert "Returns\n" in doc, (node.name, function.name)
            checked += 1
    assert checked >= (80 if name == MODULES[0] else 11)


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


def test_the_stub_says_where_a_single_pose_gives_a_scalar(evaluator, poses):
    reach, checker = viewgain.ReachRegion(), viewgain.FeasibilityChecker(evaluator.scene)
    results = {
        "evaluate": evaluator.evaluate(poses[0]),
        "evaluate_detailed": evaluator.evaluate_detailed(poses[0]),
        "evaluate_own": evaluator.evaluate_own(poses[0], lambda pose, hits: 1.0),
        "approximate": evaluator.approximate(poses[0]),
        "contains": reach.contains(poses[0]),
        "feasible": checker.feasible(poses[0]),
        "reasons": checker.reasons(poses[0]),
    }
    stub = stub_of(viewgain._viewgain)
    names = {"Union": typing.Union, "np": np, "NDArray": np.typing.NDArray}
    aliases = {node.targets[0].id: node.value for node in stub.body if isinstance(node, ast.Assign)}
    checked = 0
    for node in ast.walk(stub):
        if isinstance(node, ast.FunctionDef) and node.name in results:
            union = eval(ast.unparse(aliases[ast.unparse(node.returns)]), names)  # noqa: S307: our own text
            scalar, array = typing.get_args(union)
            assert type(results[node.name]) is scalar, node.name
            assert typing.get_origin(array) is np.ndarray, node.name
            checked += 1
    assert checked == len(results) == 7


def test_package():
    folder = pathlib.Path(viewgain.__file__).parent
    assert (folder / "py.typed").exists()
    assert viewgain.__version__.count(".") == 2
    assert public(dir(viewgain._viewgain)) <= set(dir(viewgain))
