"""The programs of docs/python.md run, one after the other."""
import pathlib
import re
import shutil

from conftest import RIGS

PAGE = pathlib.Path(__file__).resolve().parents[3] / 'docs/python.md'


def test_programs_of_the_page(tmp_path, monkeypatch):
    shutil.copy(RIGS / 'two_clips.glb', tmp_path / 'model.glb')
    monkeypatch.chdir(tmp_path)
    programs = re.findall(r'^```python\n(.*?)^```', PAGE.read_text(encoding='utf-8'), re.MULTILINE | re.DOTALL)
    assert len(programs) == 9
    names = {}
    for program in programs:
        exec(compile(program, str(PAGE), 'exec'), names)
    assert (tmp_path / 'torn.glb').stat().st_size > 0
    assert names['torn'].result.vertices_added > 0 and names['command'].result.faces_crossed > 0
