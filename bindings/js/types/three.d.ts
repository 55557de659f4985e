import type { Group, Material, Ray, Vector3 } from 'three';
import type { GLTF } from 'three/addons/loaders/GLTFLoader.js';
import type { Instance } from './index.js';

/** An instance as an object of three.js: place it where `gltf.scene` would stand. */
export class SunderObject extends Group {
  constructor(instance: Instance, options?: {
    /** What GLTFLoader gave for the same file: its materials are used, and copyPose() reads its bones. */
    gltf?: GLTF | null;
    /** By the index in the file, in place of those of `gltf`. */
    materials?: Material[];
    /** The material of walls and caps. */
    flesh?: Material | null;
    /** Whether a submesh of the model itself is one, as in a piece that came off. */
    isFlesh?: (submesh: { name: string; material: number | null }) => boolean;
  });
  /** Another one of the same character may take its place. */
  instance: Instance;
  flesh: Material;
  readonly uploadedBytes: number;
  copyPose(): void;
  update(): void;
  localRay(ray: Ray): { origin: Vector3; direction: Vector3 };
  dispose(): void;
}
