"""Makes the add-on as Blender installs it: a zip with the Python package and the C library inside.

build.py FOLDER_OF_SUNDER_TEAR LIBRARY ADD_ON.zip
"""
import pathlib
import sys
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
NAME = 'sunder_blender'


def main():
    package, library, target = (pathlib.Path(argument) for argument in sys.argv[1:4])
    files = {f'{NAME}/{file.name}': file for file in (HERE / NAME).iterdir() if file.suffix in ('.py', '.toml')}
    files.update({f'{NAME}/sunder_tear/{file.name}': file for file in (package / 'sunder_tear').iterdir() if file.suffix in ('.py', '.json')})
    files[f'{NAME}/sunder_tear/{library.name}'] = library.resolve()
    files[f'{NAME}/LICENSE'] = HERE.parents[1] / 'LICENSE'
    with zipfile.ZipFile(target, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, file in sorted(files.items()):
            archive.writestr(zipfile.ZipInfo(name), file.read_bytes(), zipfile.ZIP_DEFLATED)  # without times: the same bytes each time


main()
