"""Builds the C library of this checkout, and puts it into the package. SUNDER_C_LIBRARY names one that is built already."""
import os
import pathlib
import re
import shutil
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent


def build_library(folder):
    """Configures and builds libsunder_c alone. Needs cmake, ninja, g++ and the libraries that scripts/setup installs."""
    subprocess.check_call([
        'cmake', '-S', SOURCE, '-B', folder, '-G', 'Ninja', '-DCMAKE_BUILD_TYPE=Release', '-DSUNDER_C=ON', '-DSUNDER_QHULL=ON',
        *(f'-DSUNDER_{part}=OFF' for part in ('IO', 'CERES', 'BULLET', 'TOOLS', 'SAMPLES', 'TESTS', 'BENCH'))])
    subprocess.check_call(['cmake', '--build', folder, '--target', 'sunder_c'])
    return folder / 'bindings/c/libsunder_c.so'


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        named = os.environ.get('SUNDER_C_LIBRARY')
        library = pathlib.Path(named) if named else build_library(SOURCE / 'build/python')
        package = pathlib.Path(self.build_lib) / 'sunder_tear'
        shutil.copy(library.resolve(), package / 'libsunder_c.so')
        shutil.copy(SOURCE / 'bindings/c/sunder_api.json', package)


class WheelOfPlatform(bdist_wheel):
    """The package has a library of the machine, but nothing that depends on the version of Python."""

    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return 'py3', 'none', super().get_tag()[2]


setup(
    version=re.search(r'project\(Sunder VERSION ([\d.]+)', (SOURCE / 'CMakeLists.txt').read_text(encoding='utf-8')).group(1),
    cmdclass={'build_py': BuildWithLibrary, 'bdist_wheel': WheelOfPlatform})
