"""The tests of the binding and of the Unity layer, compiled ahead of time and run without a JIT compiler, as on iOS: what would need code
that is generated at run time, as calls back into what is not static, ends the program.

ahead_of_time_test.py MONO FOLDER SUNDER.dll FOLDER_OF_TESTS MODELS
Mono's class libraries are compiled once per FOLDER, which takes a minute.
"""
import os
import pathlib
import shutil
import subprocess
import sys

CLASS_LIBRARIES = ('mscorlib', 'Mono.Security', 'System', 'System.Configuration', 'System.Core', 'System.Numerics', 'System.Security', 'System.Xml')


def compile_ahead(mono, source, folder, environment):
    target = folder / source.name
    code = target.with_name(target.name + '.so')
    if code.exists() and target.stat().st_mtime >= source.stat().st_mtime:
        return
    code.unlink(missing_ok=True)
    shutil.copy(source, target)
    done = subprocess.run([mono, '--aot=full', target.name], cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and code.exists(), done.stdout + done.stderr


def main():
    mono, folder, sunder, tests, models = sys.argv[1], *(pathlib.Path(argument) for argument in sys.argv[2:])
    folder.mkdir(exist_ok=True)
    environment = {**os.environ, 'MONO_PATH': str(folder)}
    system = pathlib.Path(mono).resolve().parents[1] / 'lib/mono/4.5'
    for name in CLASS_LIBRARIES:
        compile_ahead(mono, system / f'{name}.dll', folder, environment)
    for file in (sunder, *(tests / name for name in ('UnityEngine.dll', 'Sunder.Unity.dll', 'SunderTests.exe', 'UnityTests.exe'))):
        compile_ahead(mono, file, folder, environment)
    subprocess.check_call([mono, '--full-aot', folder / 'SunderTests.exe', 'tests', models], env=environment)
    subprocess.check_call([mono, '--full-aot', folder / 'UnityTests.exe'], env=environment)


main()
