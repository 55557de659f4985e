"""The programs of docs/csharp.md are compiled, and run one after the other.

docs_test.py PAGE MODEL MCS MONO SUNDER.dll UNITY_ENGINE.dll SUNDER_UNITY.dll
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def main():
    page, model, mcs, mono, *assemblies = sys.argv[1:]
    blocks = re.findall(r'^```csharp\n(.*?)^```', pathlib.Path(page).read_text(encoding='utf-8'), re.MULTILINE | re.DOTALL)
    assert len(blocks) == 3, len(blocks)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copy(model, folder / 'model.glb')
        printed = []
        for i, block in enumerate(blocks):
            source, is_program = folder / f'{i}.cs', 'static void Main()' in block
            source.write_text(block, encoding='utf-8')
            subprocess.check_call([mcs, '-nologo', '-langversion:7.2', '-warnaserror', '-warn:4', *(f'-r:{assembly}' for assembly in assemblies),
                                   f'-target:{"exe" if is_program else "library"}', f'-out:{folder / str(i)}.exe', source])
            if is_program:
                printed += subprocess.check_output([mono, folder / f'{i}.exe'], cwd=folder, text=True).splitlines()
        print('\n'.join(printed))
        assert len(printed) == 2 and all(int(number) > 0 for line in printed for number in re.findall(r'\d+', line))
        assert (folder / 'torn.glb').stat().st_size > 0 and (folder / 'torn.json').stat().st_size > 0


main()
