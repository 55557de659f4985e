"""samples/tear_folder.py: a record per model, what is done is not done again, and the same files by Dask."""
import json
import pathlib
import shutil
import subprocess
import sys

import pytest

import sunder_tear
from conftest import RIGS

SAMPLE = pathlib.Path(__file__).resolve().parents[1] / 'samples/tear_folder.py'


def run(models, output, *options):
    done = subprocess.run([sys.executable, '-B', SAMPLE, models, output, '--processes', '2', *options], capture_output=True, text=True,
                          timeout=300)
    assert 'Traceback' not in done.stderr, done.stderr
    return done.returncode, done.stdout


@pytest.fixture
def models(tmp_path):
    folder = tmp_path / 'models'
    (folder / 'below').mkdir(parents=True)
    shutil.copy(RIGS / 'tube.glb', folder)
    shutil.copy(RIGS / 'two_clips.glb', folder / 'below')
    return folder


def files_of(folder):
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob('*') if file.is_file()}


def test_tears_each_model_once(models, tmp_path):
    output = tmp_path / 'torn'
    code, text = run(models, output)
    assert code == 0 and '2 models, 0 of them done before' in text, text
    record = json.loads((output / 'below/two_clips.glb.torn.json').read_text())
    assert record['passes'] and record['faces_crossed'] > 0
    torn = sunder_tear.Character.load(output / 'below/two_clips.glb.torn.glb')
    assert len(torn.meshes[0].positions) == \
        len(sunder_tear.Character.load(RIGS / 'two_clips.glb').meshes[0].positions) + record['vertices_added']
    first = files_of(output)
    (output / 'tube.glb.torn.json').unlink()  # as if the run had been stopped
    code, text = run(models, output)
    assert code == 0 and '2 models, 1 of them done before' in text, text
    assert files_of(output) == first
    code, text = run(models, output, '--seed', '2')
    assert '2 models, 0 of them done before' in text and files_of(output) != first


def test_records_what_cannot_be_read(models, tmp_path):
    (models / 'broken.glb').write_bytes(b'glTF' + bytes(40))
    code, text = run(models, tmp_path / 'torn')
    assert code == 1
    assert json.loads((tmp_path / 'torn/broken.glb.torn.json').read_text())['error']
    assert json.loads((tmp_path / 'torn/tube.glb.torn.json').read_text())['passes']
    assert '3 models, 3 of them done before' in run(models, tmp_path / 'torn')[1]


def test_dask_writes_the_same_files(models, tmp_path):
    distributed = pytest.importorskip('distributed')
    run(models, tmp_path / 'torn')
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        code, text = run(models, tmp_path / 'by_dask', '--scheduler', cluster.scheduler_address)
    assert code == 0, text
    assert files_of(tmp_path / 'by_dask') == files_of(tmp_path / 'torn')


def snakemake(models, output, *options):
    """A run of tear_many/Snakefile. @return what it prints."""
    program = shutil.which('snakemake') or pytest.skip('needs snakemake: scripts/setup snakemake')
    done = subprocess.run(
        [program, '-s', SAMPLE.parent / 'tear_many/Snakefile', '--directory', output.parent, '--cores', '2', '--scheduler', 'greedy', '--config',
         f'models={models}', f'output={output}', *options], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_snakemake_writes_the_same_files(models, tmp_path):
    (models / 'broken.glb').write_bytes(b'glTF' + bytes(40))
    output = tmp_path / 'by_snakemake/torn'
    output.parent.mkdir()
    assert '3 of 4 steps' in snakemake(models, output)
    run(models, tmp_path / 'torn')
    files = files_of(output)
    table = files.pop(pathlib.Path('table.tsv')).decode().splitlines()
    assert files == files_of(tmp_path / 'torn')
    assert len(table) == 4 and all(len(row.split('\t')) == 5 for row in table)
    assert sum('broken.glb' in row for row in table) == 1
    assert 'Nothing to be done' in snakemake(models, output)
    for name in ('tube.glb.torn.json', 'table.tsv'):  # as if the run had been stopped
        (output / name).unlink()
    assert '1 of 2 steps' in snakemake(models, output)
    assert files_of(output)[pathlib.Path('tube.glb.torn.json')] == files[pathlib.Path('tube.glb.torn.json')]
