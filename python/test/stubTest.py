# SPDX-License-Identifier: Apache-2.0
"""The type stubs and the docstrings say what there is, with the arguments that it takes."""

import ast
import builtins
import inspect
import pathlib
import pydoc
import re

import opensubdivhex as osh
import pytest

STUBS = ast.parse((pathlib.Path(osh.__file__).parent / "__init__.pyi").read_text())


def split_arguments(text):
    return [argument for argument in re.sub(r"\s", "", text).split(",") if argument]


def list_arguments(function):
    """Names and defaults, as Python source: ["level", "full=False", "*", ...]."""
    arguments = function.args
    plain = arguments.posonlyargs + arguments.args
    defaults = [None] * (len(plain) - len(arguments.defaults)) + arguments.defaults
    listed = list(zip(plain, defaults))
    if arguments.kwonlyargs:
        listed += [(ast.arg("*"), None)] + list(zip(arguments.kwonlyargs, arguments.kw_defaults))
    return split_arguments(",".join(
        a.arg if d is None else f"{a.arg}={ast.literal_eval(d)!r}"
        for a, d in listed if a.arg != "self"))


def list_functions():
    for node in STUBS.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, getattr(osh, node.name), node
        elif isinstance(node, ast.ClassDef) and not hasattr(getattr(osh, node.name), "__members__"):
            for item in node.body:
                if isinstance(item, ast.FunctionDef) and not any(
                        getattr(d, "id", "") == "property" for d in item.decorator_list):
                    owner = getattr(osh, node.name)
                    value = owner if item.name == "__init__" else getattr(owner, item.name)
                    yield f"{node.name}.{item.name}", value, item


FUNCTIONS = list(list_functions())


def test_stubs_list_everything():
    names = {node.name for node in STUBS.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    names |= {node.target.id for node in STUBS.body if isinstance(node, ast.AnnAssign)}
    public = {name for name in dir(osh) if not name.startswith("_")} | {"__version__"}
    assert names == public
    for node in STUBS.body:
        if not isinstance(node, ast.ClassDef):
            continue
        there = getattr(osh, node.name)
        listed = {item.name if isinstance(item, ast.FunctionDef) else item.target.id
                  for item in node.body if isinstance(item, (ast.FunctionDef, ast.AnnAssign))}
        if node.name in ("StatusError", "StatusWarning"):
            continue
        found = {name for name in vars(there) if not name.startswith("_")}
        special = {name for name in listed if name.startswith("__")}
        assert listed - special == found - special - {"name", "value"} | (
            {"name", "value"} if hasattr(there, "__members__") else set()), node.name


@pytest.mark.parametrize("name, value, stub", FUNCTIONS, ids=[name for name, *_ in FUNCTIONS])
def test_signatures(name, value, stub):
    expected = list_arguments(stub)
    documented = re.search(r"^(?:\d+\. )?\w+\((.*?)\)$", value.__doc__, re.S | re.M)
    if documented is None:  # a class whose docstring begins with its constructor
        pytest.fail(f"{name} has no signature in its docstring")
    assert split_arguments(documented.group(1)) == expected
    # The parameters that the function itself names.
    with pytest.raises(TypeError) as caught:
        if isinstance(value, type):
            value.__init__.__wrapped__(value.__new__(value), no_such_argument=1)
        else:
            getattr(value, "__wrapped__", value)(no_such_argument=1)
    taken = re.search(r"1\. [\w.]*\((.*)\)", str(caught.value)).group(1)
    taken = re.sub(r"\b(\w+): [\w.]+(\[\w+\])?", r"\1", taken)
    assert [a for a in split_arguments(taken) if a != "self"] == expected


def test_everything_is_documented():
    for name in dir(osh):
        value = getattr(osh, name)
        if name.startswith("_") or not callable(value):
            continue
        assert value.__doc__ and len(value.__doc__) > 10, name
        if isinstance(value, type) and not hasattr(value, "__members__"):
            for member, what in vars(value).items():
                assert member.startswith("_") or len(what.__doc__ or "") > 4, (name, member)


def test_stubs_have_the_docstrings_of_the_module():
    for name in ("TopologyRefiner", "Surface", "create_polygon_indices", "FaceMask"):
        node = next(node for node in STUBS.body if getattr(node, "name", "") == name)
        docstring = ast.get_docstring(node)
        assert docstring and docstring in inspect.cleandoc(getattr(osh, name).__doc__), name
    surface = next(node for node in STUBS.body if getattr(node, "name", "") == "Surface")
    functions = {node.name: ast.get_docstring(node) for node in surface.body
                 if isinstance(node, ast.FunctionDef)}
    assert functions["face_size"] == "Vertices of the face."
    assert functions["evaluate"] == "Points of the surface, shape (n, length)."


def test_names_of_options_are_those_that_are_taken():
    aliases = {node.targets[0].id: node.value for node in STUBS.body if isinstance(node, ast.Assign)}
    assert len(aliases) >= 10
    for name, value in aliases.items():
        listed = [constant.value for constant in ast.walk(value.right)
                  if isinstance(constant, ast.Constant)]
        assert f"_{value.left.id}" == name
        assert listed == [member.lower() for member in getattr(osh, value.left.id).__members__]


def test_names_in_annotations_are_there():
    there = set(dir(builtins))
    for node in STUBS.body:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            there |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.Assign):
            there |= {target.id for target in node.targets}
        elif isinstance(node, ast.AnnAssign):
            there.add(node.target.id)
        elif isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            there.add(node.name)
    there |= {"property", "staticmethod", "overload"}
    used = {node.id for node in ast.walk(STUBS)
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    assert used - there == set()


def test_objects_say_what_they_are():
    refiner = osh.TopologyRefiner([[0, 1, 2, 3]], vtx_boundary_interpolation="edge_only")
    refiner.refine_uniform(2, full_topology_in_last_level=True)
    level = refiner.get_level(2)
    assert repr(level) == "<TopologyLevel depth=2, num_vertices=28, num_faces=13, " \
        "has_full_topology=True>"
    assert repr(refiner).startswith("<TopologyRefiner scheme_type=<SchemeType.HEXAGONAL: 0>, ")
    assert repr(osh.StencilTable(refiner)).startswith("<StencilTable num_stencils=")
    assert repr(osh.SurfaceFactory(refiner).vertex_surface(0)) == "<Surface face_size=4>"
    assert repr(osh.LevelTessellation(4, 1)) == \
        "<LevelTessellation face_size=4, levels=[1, 1, 1, 1, 1]>"
    refiner.refine_uniform(1)
    assert "take it again" in repr(level)


def test_help_lists_everything():
    text = pydoc.plain(pydoc.render_doc(osh))
    for name in osh.__all__:
        listed = f"class {name}(" if isinstance(getattr(osh, name), type) else name
        assert listed in text, name
