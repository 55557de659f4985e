"""Tears and validates all models of a folder, on the processes of this machine or on many machines.

tear_folder.py MODELS OUTPUT [--seed N] [--processes N] [--scheduler ADDRESS]

Each glTF or GLB below MODELS gets a stroke across its largest mesh, in a random pose of its first clip: OUTPUT has the torn GLB,
and a record: the model's digest, what the tear did, and what validation found, or the error. Models whose record was made of the
same bytes with the same seed are not torn again, so a run that was stopped goes on. With --scheduler the work goes to the workers
of a Dask scheduler (dask-scheduler, dask-worker), which all reach both folders. Exit code 1: a model failed.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import sys

import numpy as np

import sunder_tear


def stroke_across(character, pose, random):
    """Positions of a blade, (9, 2, 3): across the middle half of the largest mesh as it stands, from outside to its far side."""
    mesh = max(range(character.mesh_count), key=lambda m: len(character.meshes[m].positions))
    instance = sunder_tear.Scene(threads=1).spawn(character)
    instance.set_pose(pose)
    instance.scene.update()
    places = instance.posed(mesh).positions.astype(float)
    low, high = places.min(axis=0), places.max(axis=0)
    size = np.linalg.norm(high - low)
    start = places[random.integers(len(places))]
    along, inwards = random.normal(size=(2, 3))
    along /= np.linalg.norm(along)
    inwards -= along * (inwards @ along)
    inwards /= np.linalg.norm(inwards)
    line = start + size * np.linspace(-0.25, 0.25, 9)[:, None] * along
    return np.stack([line - 0.3 * size * inwards, line + 0.3 * size * inwards], axis=1)


def tear_and_validate(model, random):
    """The torn model as GLB, and what is recorded of it."""
    character = sunder_tear.Character.load(model)
    moment = {'clip': 0, 'seconds': random.uniform(0, character.clips[0].duration)} if character.clips else {}
    blades = stroke_across(character, character.pose(**moment), random)
    torn = sunder_tear.tear(character, blades, weight_policy='exact', influences=None, **moment)
    report = sunder_tear.validate(character, torn.character)
    return torn.glb, {
        'faces_crossed': torn.result.faces_crossed, 'vertices_added': torn.result.vertices_added,
        'passes': report.passes, 'deviation': report.sampled, 'codes': sorted({finding.code for finding in report.findings})}


def write(path, content):
    """Writes a file completely or not at all."""
    part = path.with_name(path.name + '.part')
    part.write_bytes(content)
    os.replace(part, path)


def digest_of(model):
    return hashlib.sha256(pathlib.Path(model).read_bytes()).hexdigest()


def path_of(output, suffix):
    """A file of a model's output. The model's own suffix is part of the name: a.glb and a.gltf are two models."""
    return pathlib.Path(f'{output}.torn{suffix}')


def process(model, output, seed):
    """Tears one model; for a worker, which may be another machine. @return its record."""
    record = {'model': str(model), 'sha256': digest_of(model), 'seed': seed}
    random = np.random.default_rng([seed, int(record['sha256'][:8], 16)])
    try:
        glb, outcome = tear_and_validate(model, random)
        write(path_of(output, '.glb'), glb)
        record.update(outcome)
    except (sunder_tear.SunderError, ValueError, OSError) as error:
        record['error'] = str(error)
    write(path_of(output, '.json'), json.dumps(record, indent=1).encode())
    return record


def is_done(model, output, seed):
    try:
        record = json.loads(path_of(output, '.json').read_text())
        return record['sha256'] == digest_of(model) and record['seed'] == seed and (
            'error' in record or path_of(output, '.glb').exists())
    except (OSError, ValueError, KeyError, TypeError):
        return False


def executor_of(arguments):
    if not arguments.scheduler:
        return concurrent.futures.ProcessPoolExecutor(arguments.processes)
    import distributed
    return distributed.Client(arguments.scheduler).get_executor(retries=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('models', type=pathlib.Path)
    parser.add_argument('output', type=pathlib.Path)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--processes', type=int)
    parser.add_argument('--scheduler', help='address of a Dask scheduler, such as tcp://10.0.0.1:8786')
    arguments = parser.parse_args()
    found = sorted(path for path in arguments.models.rglob('*') if path.suffix in ('.glb', '.gltf'))
    todo = []
    for model in found:
        output = arguments.output / model.relative_to(arguments.models)
        output.parent.mkdir(parents=True, exist_ok=True)
        if not is_done(model, output, arguments.seed):
            todo.append((model, output))
    print(f'{len(found)} models, {len(found) - len(todo)} of them done before')
    failed = 0
    with executor_of(arguments) as executor:
        waiting = {executor.submit(process, str(model.resolve()), str(output.resolve()), arguments.seed): model
                   for model, output in todo}
        for future in concurrent.futures.as_completed(waiting):
            try:
                record = future.result()
            except Exception as error:  # the process ended, or the worker was lost: no record, so the next run tries again
                record = {'error': f'{type(error).__name__}: {error}'}
            failed += 'error' in record or not record['passes']
            text = record.get('error') or f'{record["faces_crossed"]} faces, ' + ('passes' if record['passes'] else 'FAILS')
            print(f'{waiting[future]}: {text}', flush=True)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
