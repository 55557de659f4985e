#!/usr/bin/env python3
"""Assembles the Unity package, as a folder and as a tarball that Unity's package manager installs.

    build.py VERSION GENERATED FOLDER [--plugin PLATFORM LIBRARY]...

GENERATED has the sources that make_calls.py wrote. PLATFORM: linux-x86_64, windows-x86_64, macos, android-arm64, ios, webgl.
Each file gets a .meta; its GUID is a hash of its path, so that it stays when a package is built again.
"""
import gzip
import hashlib
import io
import json
import pathlib
import shutil
import sys
import tarfile

HERE = pathlib.Path(__file__).resolve().parent
NAME = 'com.sunder.tear'
# Path in Runtime/Plugins; what the importer is told per platform: its name, and settings.
PLUGINS = {
    'linux-x86_64': ('x86_64/libsunder_c.so', [('Editor: Editor', 'CPU: x86_64', 'DefaultValueInitialized: true', 'OS: Linux'),
                                               ('Standalone: Linux64', 'CPU: x86_64')]),
    'windows-x86_64': ('x86_64/sunder_c.dll', [('Editor: Editor', 'CPU: x86_64', 'DefaultValueInitialized: true', 'OS: Windows'),
                                               ('Standalone: Win64', 'CPU: x86_64')]),
    'macos': ('macOS/libsunder_c.dylib', [('Editor: Editor', 'CPU: AnyCPU', 'DefaultValueInitialized: true', 'OS: OSX'),
                                          ('Standalone: OSXUniversal', 'CPU: AnyCPU')]),
    'android-arm64': ('Android/libs/arm64-v8a/libsunder_c.so', [('Android: Android', 'CPU: ARM64')]),
    'ios': ('iOS/libsunder_c.a', [('iPhone: iOS', 'AddToEmbeddedBinaries: false')]),
    'webgl': ('WebGL/libsunder_c.a', [('WebGL: WebGL',)])}


def fail(text):
    sys.exit(f'build.py: {text}')


def guid_of(path):
    return hashlib.md5(f'{NAME}/{path}'.encode()).hexdigest()


def importer_of(path, is_folder):
    """The lines of a .meta after the GUID."""
    if is_folder:
        return ['folderAsset: yes', 'DefaultImporter:', '  externalObjects: {}', '  userData: ', '  assetBundleName: ', '  assetBundleVariant: ']
    if path.suffix == '.cs':
        return ['MonoImporter:', '  externalObjects: {}', '  serializedVersion: 2', '  defaultReferences: []', '  executionOrder: 0',
                '  icon: {instanceID: 0}', '  userData: ', '  assetBundleName: ', '  assetBundleVariant: ']
    for where, platforms in PLUGINS.values():
        if str(path) == f'Runtime/Plugins/{where}':
            lines = ['PluginImporter:', '  externalObjects: {}', '  serializedVersion: 2', '  iconMap: {}', '  executionOrder: {}',
                     '  defineConstraints: []', '  isPreloaded: 0', '  isOverridable: 0', '  isExplicitlyReferenced: 0',
                     '  validateReferences: 1', '  platformData:', '  - first:', '      Any: ', '    second:', '      enabled: 0', '      settings: {}']
            for platform, *settings in platforms:
                lines += ['  - first:', f'      {platform}', '    second:', '      enabled: 1',
                          '      settings:' if settings else '      settings: {}', *(f'        {one}' for one in settings)]
            return [*lines, '  userData: ', '  assetBundleName: ', '  assetBundleVariant: ']
    kinds = {'.asmdef': 'AssemblyDefinitionImporter', '.md': 'TextScriptImporter', '.json': 'PackageManifestImporter'}
    return [f'{kinds[path.suffix]}:', '  externalObjects: {}', '  userData: ', '  assetBundleName: ', '  assetBundleVariant: ']


def write_metas(folder):
    """Unity does not look into folders whose names end with ~."""
    for path in sorted(folder.rglob('*')):
        relative = path.relative_to(folder)
        if any(part.endswith('~') for part in relative.parts):
            continue
        lines = ['fileFormatVersion: 2', f'guid: {guid_of(relative.as_posix())}', *importer_of(relative, path.is_dir())]
        path.with_name(path.name + '.meta').write_text('\n'.join(lines) + '\n', encoding='utf-8')


def write_tarball(folder, tarball):
    """The same bytes for the same files."""
    with open(tarball, 'wb') as file, gzip.GzipFile(fileobj=file, mode='wb', filename='', mtime=0) as zipped, \
            tarfile.open(fileobj=zipped, mode='w') as tar:
        for path in sorted(folder.rglob('*')):
            if not path.is_file():
                continue
            data = path.read_bytes()
            entry = tarfile.TarInfo('package/' + path.relative_to(folder).as_posix())
            entry.size, entry.mode = len(data), 0o644
            tar.addfile(entry, io.BytesIO(data))


def assemble(version, generated, folder, plugins):
    source = HERE.parents[2]
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(HERE, folder, ignore=shutil.ignore_patterns('build.py', '__pycache__'))
    for file in [*(HERE.parent / 'Sunder').glob('*.cs'), *generated.glob('*.cs')]:
        shutil.copy(file, folder / 'Runtime/Binding')
    package = json.loads((folder / 'package.json').read_text(encoding='utf-8'))
    package = {'name': package.pop('name'), 'version': version, **package}
    (folder / 'package.json').write_text(json.dumps(package, indent=2) + '\n', encoding='utf-8')
    for name, to in (('LICENSE', 'LICENSE.md'), ('CHANGELOG.md', 'CHANGELOG.md'), ('THIRD_PARTY.md', 'Third Party Notices.md')):
        shutil.copy(source / name, folder / to)
    for platform, library in plugins:
        to = folder / 'Runtime/Plugins' / PLUGINS[platform][0]
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(library.resolve(), to)
    write_metas(folder)
    write_tarball(folder, folder.with_name(f'{NAME}-{version}.tgz'))


def main():
    arguments = sys.argv[1:]
    plugins = []
    while '--plugin' in arguments:
        at = arguments.index('--plugin')
        if len(arguments) < at + 3 or arguments[at + 1] not in PLUGINS:
            fail(f'--plugin PLATFORM LIBRARY, with a platform of {", ".join(PLUGINS)}')
        plugins.append((arguments[at + 1], pathlib.Path(arguments[at + 2])))
        del arguments[at:at + 3]
    if len(arguments) != 3:
        fail('usage: build.py VERSION GENERATED FOLDER [--plugin PLATFORM LIBRARY]...')
    assemble(arguments[0], pathlib.Path(arguments[1]), pathlib.Path(arguments[2]), plugins)


main()
