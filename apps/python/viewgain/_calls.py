# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""One-line messages for invalid calls, instead of pybind11's list of all signatures and arguments."""
import ast
import difflib
import functools
import re
import types

# The attribute that a value needs to be accepted as each simple type.
_MADE_OF = {"int": "__index__", "float": "__float__", "bool": "__bool__", "str": "isidentifier"}


def _fault(function, args, kwargs):
    """A short message about what is wrong with a call; None if there is none. The arguments exclude self."""
    head = function.__doc__.partition("\n")[0].rpartition(" -> ")[0]  # pybind11 begins docstrings with the signature
    found = ast.parse(f"def {head}: ...").body[0].args
    by_place = [one for one in found.args if one.arg != "self"]
    parameters = {one.arg: ast.unparse(one.annotation) for one in by_place + found.kwonlyargs}
    for name in kwargs:
        if name not in parameters:
            near = difflib.get_close_matches(name, parameters, 1, 0)
            return f"unknown argument {name!r}" + "".join(f"; did you mean {one!r}?" for one in near)
    if len(args) > len(by_place):
        return f"{len(args)} positional arguments are too many; at most {len(by_place)}, and others by keyword"
    given = {**dict(zip((one.arg for one in by_place), args)), **kwargs}
    for one in by_place[:len(by_place) - len(found.defaults)]:
        if one.arg not in given:
            return f"the argument {one.arg!r} is missing"
    for name, value in given.items():
        kind, optional = re.fullmatch(r"(?:(Optional)\[)?(\w+)\]?|.*", parameters[name]).group(2, 1)
        if kind in _MADE_OF and not hasattr(value, _MADE_OF[kind]) and not (optional and value is None):
            return f"{name} must be {kind}, not {type(value).__name__}"
        if kind == "int" and isinstance(value, int) and value < 0:
            return f"{name} must be at least 0, not {value}"
    return None


def _explained(function, name, method):
    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            if "incompatible" not in str(error):
                raise
            fault = _fault(function, args[method:], kwargs)
            if fault is None:
                raise
        raise TypeError(f"{name}(): {fault}")
    return call


def explain(module):
    """Wraps the functions of an extension module, and the methods of its classes, so that they raise these messages."""
    for name, one in list(vars(module).items()):
        if isinstance(one, types.BuiltinFunctionType):
            setattr(module, name, _explained(one, name, False))
        elif isinstance(one, type) and not issubclass(one, BaseException):
            for key, member in list(vars(one).items()):
                if isinstance(member, staticmethod):
                    setattr(one, key, staticmethod(_explained(member.__func__, f"{name}.{key}", False)))
                elif key == "__init__" or (key[0] != "_" and type(member).__name__ == "instancemethod"):
                    setattr(one, key, _explained(member, name if key == "__init__" else f"{name}.{key}", True))
