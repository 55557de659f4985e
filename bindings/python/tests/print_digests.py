"""What tests/c/print_digests.c does, through this package: prints the same lines.

    print_digests.py FOLDER COUNT FILE
"""
import sys

import numpy as np

import sunder_tear
from sunder_tear import Asset, Character, Scene, SunderError, material

START, BITS = 14695981039346656037, 2 ** 64 - 1


def hash_bytes(value: int, data: bytes) -> int:
    for byte in data:
        value = (value ^ byte) * 1099511628211 & BITS
    return value


def hash_meshes(who) -> int:
    value = START
    for mesh in range(who.asset.character.mesh_count):
        posed = who.posed(mesh)
        value = hash_bytes(value, posed.positions.tobytes())
        if posed.normals is not None:
            value = hash_bytes(value, posed.normals.tobytes())
    return value


def go_on(scene, who) -> None:
    """A stroke with walls over 8 frames, from side to side through the middle of the model, of which the half is undone; then tissue
    tears by force."""
    scene.update(1 / 64)
    positions = who.posed().positions
    low, high = positions.min(axis=0), positions.max(axis=0)  # of 32 bits, as their differences and sums
    size, middle = (high - low).astype(float), 0.5 * (low + high).astype(float)
    low, high = low.astype(float), high.astype(float)
    for frame in range(16):
        along = frame % 8 / 7
        x = low[0] + (0.2 + 0.6 * along) * size[0]
        y = middle[1] + (frame // 8 - 0.5) * 0.3 * size[1]
        blade = [[x, y, np.float32(high[2]) + np.float32(size[2])], [x, y, middle[2]]]
        if frame % 8 == 0:
            who.begin_stroke(blade, width=0.01 * size[0], wall_depth=0.02 * size[0])
        else:
            who.extend_stroke(blade, 1 / 64)
        if frame % 8 == 7:
            who.end_stroke()
        scene.update(1 / 64)
    who.undo()
    for _ in range(8):
        scene.update(1 / 64)
        who.tear_overstretched()
    scene.update(1 / 64)


def line_of(folder: str, number: int) -> str:
    character = Character.load(f'{folder}/{number}.glb')
    asset = Asset(character, soft=True, materials=[material('skin', strength=1.2)], tension=2.0, gravity=(0, -9.81, 0))
    scene = Scene(threads=1)
    who = scene.spawn(asset)
    if character.clips:
        who.play(0)
    scene.update(0.25)
    with open(f'{folder}/{number}.json') as log:
        try:
            status, applied = 0, who.apply_log(log.read())
        except SunderError as error:
            status, applied = error.status, error.index
    scene.update(1 / 64)
    words = [str(number), str(status), str(applied), f'{who.digest:016x}', f'{hash_meshes(who):016x}']
    for _ in range(100):
        scene.update(1 / 64)
    snapshot = scene.save()
    words += [f'{hash_meshes(who):016x}', f'{hash_bytes(START, snapshot):016x}']
    scene.update(1.0)
    scene.restore(snapshot, [asset])
    go_on(scene, who)
    words.append(f'{who.digest ^ (hash_meshes(who) * 0x9E3779B97F4A7C15 & BITS):016x}')
    return ' '.join(words)


if __name__ == '__main__':
    _, folder, count, file = sys.argv
    with open(file, 'w') as to:
        for number in range(int(count)):
            print(line_of(folder, number), file=to)
