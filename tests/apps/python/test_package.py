# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""The stubs name what there is and say of what type, and everything is documented."""
import __future__
import ast
import importlib.util
import inspect
import pathlib
import pickle
import re

import pytest

import viewgain

MODULES = ["viewgain._viewgain"]
if importlib.util.find_spec("viewgain.mesh").submodule_search_locations is not None:  # a package: it was built
    MODULES.append("viewgain.mesh._mesh")


def public(names):
    return {name for name in names if not name.startswith("_")}


def stub_of(module):
    text = pathlib.Path(module.__file__).parent / (module.__name__.rpartition(".")[2] + ".pyi")
    return ast.parse(text.read_text())


def types_in(name):
    """{"Class.method": types of its parameters and of what it returns, a list per overload}, each looked up."""
    stub = stub_of(importlib.import_module(name))
    namespace = {"__package__": name.rpartition(".")[0]}
    exec(compile(stub, "stub", "exec", __future__.annotations.compiler_flag, dont_inherit=True), namespace)
    types = {}
    for owner in [stub] + [node for node in stub.body if isinstance(node, ast.ClassDef)]:
        for function in (node for node in owner.body if isinstance(node, ast.FunctionDef)):
            found = {a.arg: ast.unparse(a.annotation) for a in function.args.args + function.args.kwonlyargs if a.arg != "self"}
            found["return"] = ast.unparse(function.returns)
            for text in found.values():
                eval(text, namespace)
                assert text != "object", function.name
            types.setdefault(f"{getattr(owner, 'name', '')}.{function.name}", []).append(found)
    return types


def test_types_say_what_matters():
    types = types_in("viewgain._viewgain")
    assert len(types) > 150
    floats = "NDArray[np.float64]"
    assert types[".sphere_poses"] == [{"count": "int", "radius": "float", "center": "ArrayLike", "return": floats}]
    evaluate = {"T_world_camera": "ArrayLike", "strict": "bool", "control": "BatchControl | None"}
    assert types["GainEvaluator.evaluate"] == [{**evaluate, "return": f"np.float64 | {floats}"}]
    assert types["GainEvaluator.evaluate_detailed"] == [{**evaluate, "return": "np.void | NDArray[np.void]"}]
    assert [one["return"] for one in types["GainEvaluator.best_set"]] == ["ViewSet"]
    assert [one["return"] for one in types[".read_poses"] + types[".read_timed_poses"]] == [floats, "TimedPoses"]
    assert types[".read_frames"][0]["out_of_range"] == "Literal['carve', 'invalid'] | None"
    assert types["BeliefGrid.statistics"][0]["criterion"] == "Literal['log_diagonal', 'log_determinant', 'trace']"
    assert types["BeliefGrid.states"][0]["return"] == "NDArray[np.uint8]"
    assert types["Sensor.T_flange_camera"][0]["return"] == f"{floats} | None"
    assert types["ReachRegion.__init__"][0]["predicate"] == f"Callable[[{floats}], object] | None"
    assert types[".cloud_bounds"][0]["points"] == "ArrayLike"  # as another function's words say
    if len(MODULES) > 1:
        types = types_in(MODULES[1])
        assert types[".reconstruct"][0]["observer"] == "Callable[[ViewRecord], object] | None"
        assert types["Surface.triangles"][0]["return"] == "NDArray[np.uint32]"


def test_everything_is_documented():
    checked = 0
    for module_name in ("viewgain", "viewgain.mesh"):
        try:
            module = importlib.import_module(module_name)
        except ImportError:  # without CGAL
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
    assert len(classes) == (19 if name == MODULES[0] else 2)
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
