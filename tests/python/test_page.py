"""The text of docs/python.md does what it shows."""

import pathlib
import re

page = pathlib.Path(__file__).parents[2] / "docs/python.md"


def test_blocks_run(capsys):
    blocks = re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)
    assert blocks
    for block in blocks:
        exec(compile(block, page, "exec"), {})
    assert "[ True False]" in capsys.readouterr().out
