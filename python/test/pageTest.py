# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/PYTHON.md run as they are printed, one after the other."""

import pathlib
import re

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "PYTHON.md"


def test_examples(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text()
    examples = list(re.finditer(r"^```python\n(.*?)^```$", text, re.S | re.M))
    assert len(examples) >= 8
    names = {}
    for example in examples:
        line = text[:example.start(1)].count("\n")
        exec(compile("\n" * line + example.group(1), str(PAGE), "exec"), names)
