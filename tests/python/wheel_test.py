"""Builds the wheel around the library of this build, installs it into an empty folder, and tears a model there.

wheel_test.py FOLDER_OF_THE_PACKAGE MODEL
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = '''
import sys, sunder_tear
character = sunder_tear.Character.load(sys.argv[1])
blades = [[[x, 1.0, 2.0], [x, 1.0, 0.0]] for x in (-0.2, 0.0, 0.2)]
torn = sunder_tear.tear(character, blades)
assert torn.result.vertices_added > 0
assert len(torn.character.meshes[0].positions) > len(character.meshes[0].positions)
'''


def main():
    package, model = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # A copy: setuptools writes beside the sources.
        source = folder / 'source'
        shutil.copytree(package, source / 'bindings/python', ignore=shutil.ignore_patterns('__pycache__', 'build', '*.egg-info'))
        shutil.copytree(package.parent / 'c', source / 'bindings/c')
        shutil.copy(package.parents[1] / 'CMakeLists.txt', source)
        pip = [sys.executable, '-m', 'pip', '-q', '--disable-pip-version-check']
        subprocess.check_call([*pip, 'wheel', '--no-deps', '--no-build-isolation', '-w', folder, source / 'bindings/python'])
        wheels = list(folder.glob('sunder_tear-*-py3-none-*.whl'))
        assert len(wheels) == 1, list(folder.iterdir())
        subprocess.check_call([*pip, 'install', '--no-deps', '--no-index', '--target', folder / 'site', wheels[0]])
        environment = {key: value for key, value in os.environ.items() if key != 'SUNDER_C_LIBRARY'}
        environment['PYTHONPATH'] = str(folder / 'site')
        subprocess.check_call([sys.executable, '-c', PROGRAM, model], env=environment, cwd=folder)


if __name__ == '__main__':
    main()
