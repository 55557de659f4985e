"""The Unity package that was assembled: its files are what Unity's package manager expects, and compile as Unity compiles them.

unity_package_test.py PACKAGE VERSION FOLDER_OF_STUBS MCS
"""
import json
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile

# Scenes and prefabs refer to these scripts by the GUIDs of their files: another one would break them.
GUIDS = {'Runtime/TearableCharacter.cs': '009f90dd6ca613cd1e00ada4280d0cb6', 'Runtime/Blade.cs': 'd24765a35aa80801c13118064fded94b'}


def check_manifest(package, version):
    manifest = json.loads((package / 'package.json').read_text(encoding='utf-8'))
    assert manifest['name'] == package.name and re.fullmatch(r'[a-z0-9-]+(\.[a-z0-9-]+){2}', manifest['name'])
    assert manifest['version'] == version and manifest['unity'] == '2021.2'
    assert manifest['displayName'] and manifest['description']
    for sample in manifest['samples']:
        assert list((package / sample['path']).glob('*.cs')), sample


def check_assemblies(package):
    assemblies = {}
    for file in package.rglob('*.asmdef'):
        assembly = json.loads(file.read_text(encoding='utf-8'))
        assert file.name == assembly['name'] + '.asmdef'
        assemblies[assembly['name']] = assembly
    assert set(assemblies) == {'Sunder', 'Sunder.Unity'}
    assert all(assembly['allowUnsafeCode'] for assembly in assemblies.values())
    assert assemblies['Sunder']['noEngineReferences'] and assemblies['Sunder.Unity']['references'] == ['Sunder']


def check_metas(package):
    """One per file and folder that Unity looks at, and no other; each GUID once."""
    guids = {}
    for path in package.rglob('*'):
        relative = path.relative_to(package)
        if any(part.endswith('~') for part in relative.parts):
            assert path.suffix != '.meta', path
            continue
        if path.suffix == '.meta':
            assert path.with_suffix('').exists(), path
            continue
        text = path.with_name(path.name + '.meta').read_text(encoding='utf-8')
        guid = re.match(r'fileFormatVersion: 2\nguid: ([0-9a-f]{32})\n', text).group(1)
        assert guid not in guids.values(), path
        guids[relative.as_posix()] = guid
        assert ('folderAsset: yes' in text) == path.is_dir(), path
        assert ('MonoImporter:' in text) == (path.suffix == '.cs'), path
        assert ('PluginImporter:' in text) == (path.is_file() and path.suffix in ('.so', '.dll', '.dylib', '.a')), path
    for path, guid in GUIDS.items():
        assert guids[path] == guid, (path, guids[path])
    return guids


def check_tarball(package, version):
    with tarfile.open(package.with_name(f'{package.name}-{version}.tgz')) as tarball:
        packed = {entry.name for entry in tarball.getmembers()}
    assert packed == {'package/' + path.relative_to(package).as_posix() for path in package.rglob('*') if path.is_file()}


def check_sources(package, stubs, mcs):
    """As Unity compiles them: it has spans, and links the library on some platforms."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def build(assembly, files, *options):
            target = folder / f'{assembly}.dll'
            subprocess.check_call([mcs, '-nologo', '-unsafe', '-langversion:7.2', '-warnaserror', '-warn:4', '-target:library',
                                   *options, f'-out:{target}', *files])
            return target

        binding = sorted((package / 'Runtime/Binding').glob('*.cs'))
        # The stub of ReadOnlySpan stands beside one that Mono has for itself.
        sunder = build('Sunder', [*binding, stubs / 'Span.cs'], '-define:UNITY_2021_2_OR_NEWER', '-nowarn:436')
        assert b'\0sunder_c\0' in sunder.read_bytes() and b'get_Span' in sunder.read_bytes()
        engine = build('UnityEngine', [file for file in stubs.glob('Unity*.cs') if file.name != 'UnityTests.cs'])
        layer = build('Sunder.Unity', sorted((package / 'Runtime').glob('*.cs')), f'-r:{sunder}', f'-r:{engine}')
        build('Sample', sorted((package / 'Samples~').rglob('*.cs')), f'-r:{sunder}', f'-r:{engine}', f'-r:{layer}')
        for platform in ('UNITY_IOS', 'UNITY_WEBGL'):
            linked = build(platform, binding, f'-define:{platform}').read_bytes()
            assert b'\0__Internal\0' in linked and b'\0sunder_c\0' not in linked, platform
            editor = build(platform, binding, f'-define:{platform}', '-define:UNITY_EDITOR').read_bytes()
            assert b'\0sunder_c\0' in editor, platform


def main():
    package, version, stubs, mcs = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3]), sys.argv[4]
    check_manifest(package, version)
    check_assemblies(package)
    check_metas(package)
    check_tarball(package, version)
    check_sources(package, stubs, mcs)


main()
