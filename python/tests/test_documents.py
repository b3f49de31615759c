"""The examples of the documents run."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]


def examples(document):
    text = (ROOT / document).read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.parametrize("document", ["python/README.md", "docs/how-to/python.md"])
def test_examples_run(document, tmp_path, monkeypatch, capsys):
    (tmp_path / "scenarios").symlink_to(ROOT / "scenarios")
    monkeypatch.chdir(tmp_path)
    assert len(examples(document)) == 2
    for example in examples(document):
        exec(compile(example, document, "exec"), {})
    said = capsys.readouterr().out
    assert "serviced" in said and "12.8506 s, 62 jumps; Zeno: jumps accumulate at 12.8506 s" in said
    for promised in re.findall(r"print\(.*# (serviced.*|\d.*)", "".join(examples(document))):
        assert promised in said
