# SPDX-License-Identifier: Apache-2.0
"""Errors that name the wrong argument of a call, in place of pybind11's, which list all arguments."""

import functools
import itertools
import operator
import re

_SIGNATURE = re.compile(r"^    \d+\. [\w.]*\((.*)\)(?: ->.*)?$", re.M)
_PARAMETER = re.compile(r"(\*|\w+)(?:: (?:\w+\.)*(\w+)(?:\[(\w+)\])?)?( = (?:\(.*?\)|[^,]*))?(?:, |$)")
_NUMBERS = {"int": ("an integer", "__index__", operator.index), "float": ("a number", "__float__", float),
            "bool": ("a bool", "__bool__", bool)}


def _find_expected(value, kind, inner):
    """What a parameter takes, where it does not take the value; else None."""
    if kind == "Optional":
        expected = value is not None and _find_expected(value, inner, "")
        return f"{expected} or None" if expected else None
    if kind == "List":
        isTaken = isinstance(value, (list, tuple)) and not any(_find_expected(v, inner, "") for v in value)
        return None if isTaken else f"a list of {inner}"
    if kind in _NUMBERS:
        expected, method, convert = _NUMBERS[kind]
        try:
            isTaken = hasattr(value, method) and convert(value) is not None
        except (TypeError, ValueError):  # arrays of several numbers
            isTaken = False
        return None if isTaken else expected
    isTaken = any(kind == base.__name__ for base in type(value).__mro__)
    return None if isTaken else f"{'an' if kind[0] in 'AEIOU' else 'a'} {kind}"


def _find_error(name, signature, args, kwargs):
    """What is wrong with the arguments of a call, behind the number of arguments that are right; or None."""
    parameters = _PARAMETER.findall(signature)
    names = [parameter[0] for parameter in parameters]
    positional = list(itertools.takewhile(lambda name: name != "*", names))
    values = {**dict(zip(positional, args)), **kwargs}
    if len(args) > len(positional):
        most, given = (len(listed) - names.count("self") for listed in (positional, args))
        return 0, TypeError(f"{name}: at most {most} arguments without a name, not {given}")
    for key in kwargs:
        if key not in names:
            return 0, TypeError(f"{name}: there is no argument '{key}'")
        if key in positional[:len(args)]:
            return 0, TypeError(f"{name}: {key} is given twice")
    for number, (key, kind, inner, default) in enumerate(parameters):
        if key not in values:
            if key != "*" and not default:
                return number, TypeError(f"{name}: the argument {key} is missing")
        elif expected := _find_expected(values[key], kind, inner):
            items = values[key] if kind == "List" and isinstance(values[key], (list, tuple)) else []
            types = [type(item).__name__ for item in items if _find_expected(item, inner, "")]
            given = " of ".join([type(values[key]).__name__, *types[:1]])
            return number, TypeError(f"{key}: {expected} is needed, not {given}")
    for key, kind, inner, _ in parameters:
        if "int" in (kind, inner) and values.get(key) is not None:
            for number in values[key] if kind == "List" else [values[key]]:
                if not -2**31 <= operator.index(number) < 2**31:
                    return len(names), ValueError(f"{key}: {number} is a number that 32 bits do not hold")
    for key, kind, _, _ in parameters:  # what is left is a number without a sign
        if kind == "int" and values.get(key) is not None and operator.index(values[key]) < 0:
            return len(names), ValueError(f"{key}: {values[key]} is below 0")
    return None


def _wrap(function, name, owner="", numSelf=0):
    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            signatures = _SIGNATURE.findall(str(error).partition("\nInvoked with: ")[0])
            found = [_find_error(name, signature, args[numSelf:], kwargs) for signature in signatures]
            if not found or None in found:
                raise
        raise max(found, key=operator.itemgetter(0))[1]
    call.__module__ = __package__
    call.__qualname__ = owner + function.__name__
    return call


def name_wrong_arguments(module, names):
    """Has functions and classes raise errors that name the argument, what is needed and what was given."""
    for name in names:
        value = getattr(module, name)
        if not isinstance(value, type):
            if callable(value):
                setattr(module, name, _wrap(value, name))
            continue
        for member, function in list(vars(value).items()):
            if isinstance(function, staticmethod):
                setattr(value, member, staticmethod(_wrap(function.__func__, member, name + ".")))
            elif member == "__init__" and "__members__" not in vars(value):
                setattr(value, member, _wrap(function, name, name + ".", 1))
            elif callable(function) and not member.startswith("__"):
                setattr(value, member, _wrap(function, member, name + "."))
