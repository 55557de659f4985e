"""One tear of a character in one call, without a scene."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union

from .character import Asset, Character
from .scene import Result, Scene


@dataclass(frozen=True)
class Torn:
    """What a tear made: a GLB that plays all clips, a log that makes it again, and figures."""
    glb: bytes
    log: str
    result: Result

    @property
    def character(self) -> Character:
        return Character.load(self.glb)

    def _repr_png_(self) -> bytes:
        return self.character._repr_png_()


def tear(character: Character, blades, *, clip: Union[str, int, None] = None, seconds: float = 0.0, influences: Optional[int] = 0,
         **options) -> Torn:
    """Tears a character along positions of a blade, (n, 2, 3), in the pose of a clip at a time, or at rest. Options are those of
    Instance.tear(); influences as in Instance.save(). Raises SunderError."""
    scene = Scene(threads=1)
    instance = scene.spawn(Asset(character, poses_vertices=0))
    instance.set_pose(character.pose(clip, seconds))
    command = instance.tear(blades, **options)
    scene.update()
    return Torn(instance.save(influences), instance.log, command.result)
