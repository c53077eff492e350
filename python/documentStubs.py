# SPDX-License-Identifier: Apache-2.0
"""Writes type stubs with the docstrings of the module that they describe, which editors show.

Usage: documentStubs.py PACKAGES STUBS RESULT, where PACKAGES is the folder that has the package."""

import ast
import inspect
import pathlib
import re
import sys


def find_docstring(owner, name):
    """The docstring of a class, function or property, without the signature that the stub has; or None."""
    value = getattr(owner, name, None)
    docstring = inspect.cleandoc(getattr(value, "__doc__", None) or "")
    return re.sub(rf"\A{name}\(.*?\)(\n\n|\Z)", "", docstring, flags=re.S) or None


def find_documented(body, owner):
    """For each class and function the line behind which its docstring comes, the node and the docstring."""
    for node in body:
        isClass = isinstance(node, ast.ClassDef)
        if not isClass and not isinstance(node, ast.FunctionDef):
            continue
        docstring = find_docstring(owner, node.name)
        if docstring and not node.name.startswith("__"):
            yield node.lineno if isClass else node.body[0].lineno, node, docstring
        if isClass:
            yield from find_documented(node.body, getattr(owner, node.name))


def document(source, module):
    lines = source.splitlines()
    # From the end on, so that the numbers of lines before stay right.
    for line, node, docstring in sorted(find_documented(ast.parse(source).body, module),
                                        key=lambda found: -found[0]):
        indent = " " * (node.col_offset + 4)
        quoted = docstring.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
        if "\n" in quoted:
            quoted += "\n"
        text = [(indent + part).rstrip() for part in f'"""{quoted}"""'.splitlines()]
        if isinstance(node, ast.FunctionDef):  # "def name(...): ..."
            lines[line - 1] = lines[line - 1][:node.body[0].col_offset].rstrip()
        lines[line:line] = text
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    packages, stubs, result = map(pathlib.Path, sys.argv[1:])
    sys.path.insert(0, str(packages))
    import opensubdivhex
    result.write_text(document(stubs.read_text(encoding="utf-8"), opensubdivhex), encoding="utf-8")
