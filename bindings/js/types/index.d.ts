import type { Calls } from './calls.js';

export type Vector3Like = ArrayLike<number> | { x: number; y: number; z: number };
export type QuaternionLike = ArrayLike<number> | { x: number; y: number; z: number; w: number };
/** One position of a blade: from outside the surface to how deep it reaches, in the space of the model. */
export type Blade = readonly [Vector3Like, Vector3Like] | { base: Vector3Like; tip: Vector3Like } | Float32Array | Float64Array;
/** Positions of a blade; in a typed array, six numbers each. */
export type StrokePath = readonly Blade[] | Float32Array | Float64Array;
export type Bytes = ArrayBuffer | ArrayBufferView | string;
export type WasmSource = BufferSource | WebAssembly.Module | Response;
export type WeightPolicy = 'barycentric' | 'poseExact' | 'refit' | 'exact' | 'ofModel';
export type MaterialName = 'skin' | 'fat' | 'muscle' | 'liver' | 'rubber' | 'foam' | 'cloth' | 'jelly';

/** A failure of the library. */
export class SunderError extends Error {
  constructor(code: string, status: number, index: number | null, text: string);
  /** The name of the status: 'not_found', 'invalid_argument', 'limit_exceeded' ... */
  readonly code: string;
  readonly status: number;
  /** The element that the text speaks of. */
  readonly index: number | null;
}

export interface TissueMaterial {
  returnFrequency: number; dampingRatio: number; membraneStiffness: number; membraneDamping: number; arealDensity: number;
  range: number; stretchLimit: number; strength: number; toughness: number; flawLength: number;
}
export type MaterialLike = MaterialName | (Partial<TissueMaterial> & { base?: MaterialName });

export interface ModelOptions {
  /** Soft tissue: true (the default), false, or its material. */
  soft?: boolean | MaterialLike;
  material?: MaterialLike;
  materials?: MaterialLike[];
  hasNormals?: boolean; hasTangents?: boolean; posesVertices?: boolean; unitLength?: boolean;
  skinning?: 'linear' | 'dualQuaternion';
  weights?: WeightPolicy;
  maximumInfluences?: number;
  particleRange?: number; particleSeed?: number | bigint;
  gravity?: Vector3Like;
  /** N/m, pulls lips apart. */
  tension?: number;
  addsPoseStrain?: boolean;
  /** Where tissue differs: factors per vertex of a mesh. */
  fields?: { mesh?: number; field: 'strength' | 'toughness' | 'stiffness' | 'tension' | 'thickness'; values: ArrayLike<number> }[];
  /** Lines along which tissue is weaker, as between stamps; strength: 0.001 to 1. */
  perforations?: { places: { mesh?: number; triangle: number; barycentric: ArrayLike<number> }[]; strength: number }[];
  /** Metres; lips and flaps of this thickness stop at one another. */
  selfContactThickness?: number; selfContactFriction?: number;
}
export interface LoadOptions extends ModelOptions {
  /** Refuses what would otherwise be repaired or dropped. */
  strict?: boolean;
  maximumBytes?: number | bigint; maximumMemory?: number | bigint;
}

export interface Transform { translation: ArrayLike<number>; rotation: ArrayLike<number>; scale: ArrayLike<number> }
export interface MeshArrays {
  name?: string;
  positions: ArrayLike<number>;
  triangles?: ArrayLike<number>;
  normals?: ArrayLike<number>;
  uvs?: ArrayLike<number>; uvSets?: ArrayLike<number>[];
  triangleSubmesh?: ArrayLike<number>; submeshes?: { name?: string; material?: number }[];
  /** As many per vertex as you like; without them, slot 0 moves everything. */
  slots?: ArrayLike<number>; weights?: ArrayLike<number>;
  skin?: number;
}
export interface CharacterArrays {
  name?: string;
  bones?: ({ name?: string; parent?: number | null } & Partial<Transform>)[];
  skins?: { name?: string; bones: ArrayLike<number>; boneFromBind: ArrayLike<number> }[];
  meshes: MeshArrays[];
}

/** Arrays are views on the memory of the library, made at each reading: copy what you keep. */
export interface MeshData {
  readonly name: string; readonly vertexCount: number; readonly triangleCount: number; readonly skin: number;
  readonly submeshes: { name: string; material: number | null }[];
  readonly positions: Float32Array; readonly normals: Float32Array | null; readonly tangents: Float32Array | null;
  readonly uvSets: Float32Array[]; readonly colorSets: Float32Array[];
  readonly attributes: { name: string; components: number; isLabel: boolean; values: Float32Array }[];
  readonly triangles: Uint32Array; readonly triangleSubmesh: Uint32Array;
  readonly firstInfluence: Uint32Array; readonly influences: Uint32Array;
}
export interface VertexRange { first: number; count: number }
/** Arrays are views, valid until the next update of the scene; then reading them throws. */
export interface PosedMesh {
  readonly vertexCount: number; readonly triangleCapacity: number; readonly epoch: bigint;
  readonly positions: Float32Array; readonly normals: Float32Array | null; readonly tangents: Float32Array | null;
  readonly drawRanges: { submesh: number; firstTriangle: number; triangleCount: number }[];
  readonly dirtyVertices: VertexRange[]; readonly dirtyAttributes: VertexRange[];
  readonly initialTriangles: Uint32Array;
  /** Four numbers each: the place in triangles, and its vertices. */
  readonly triangleWrites: Uint32Array;
}

declare class Disposable {
  readonly isDisposed: boolean;
  dispose(): void;
}

/** A rigged model, and what its instances share. */
export class Model extends Disposable {
  private constructor();
  readonly name: string;
  readonly meshCount: number;
  readonly bones: { name: string; parent: number | null; rest: Transform }[];
  /** Per slot a bone, and 12 numbers: the inverse of its bind transform. */
  readonly skins: { name: string; bones: Uint32Array; boneFromBind: Float32Array }[];
  readonly clips: { name: string; duration: number }[];
  readonly morphWeightCount: number;
  readonly notes: { kind: 'information' | 'repaired' | 'dropped' | 'warning'; place: string; text: string; count: number }[];
  mesh(index: number): MeshData;
  bone(name: string): number;
  clip(name: string | number): number;
  /** 12 numbers per bone, column after column, the translation last. */
  matrices(clip?: string | number | null, seconds?: number): Float64Array;
  ragdoll(matrices?: Float64Array | number[], options?: RagdollOptions): Ragdoll;
  /** A copy whose meshes have attributes of one number per vertex, in place of those of that name; files of it have them too. */
  withAttributes(attributes: { mesh?: number; name: string; values: ArrayLike<number> }[], options?: ModelOptions): Model;
  toGLB(options?: { maximumInfluences?: number }): Uint8Array;
}

/** How far a bone turns from its rest; radians. */
export interface BoneLimit { bone: number; kind?: 'hinge' | 'cone'; axis: Vector3Like; lower?: number; upper?: number; cone?: number }
export interface RagdollOptions {
  maximumBodies?: number;
  /** Of the mass; lighter bodies join others. */
  leastShare?: number;
  density?: number; openSurfaces?: 'fans' | 'shell'; shellThickness?: number;
  morphWeights?: Float32Array | number[];
  /** Of joints; of others: what the clips show. */
  limits?: BoneLimit[];
}
/** A rigid body and its joint to the body above; frames are 12 numbers: a rotation, column after column, and a translation. */
export interface RagdollBody {
  bone: number; parent: number | null; mass: number; moments: number[];
  modelFromBody: number[]; parentFromJoint: number[]; bodyFromJoint: number[];
  shape: { kind: 'sphere' | 'capsule' | 'box'; size: number[]; place: number[]; rotation: number[] };
  limit: { bone: number; kind: 'hinge' | 'cone'; axis: number[]; lower: number; upper: number; cone: number };
}
/** A model as rigid bodies and joints for a physics engine; made by Model.ragdoll(). */
export class Ragdoll extends Disposable {
  private constructor();
  readonly bodies: RagdollBody[];
  /** 12 numbers per body. */
  place(matrices: Float64Array | number[]): Float64Array;
  /** Quaternions x y z w, one per body. */
  turns(places: Float64Array | number[]): Float64Array;
  /** 12 numbers per bone. */
  matrices(places: Float64Array | number[]): Float64Array;
  hulls(options?: { points?: number }): { points: Float64Array; triangles: Uint32Array; volume: number }[];
}

export interface FillingOptions { weights?: WeightPolicy; maximumInfluences?: number; background?: boolean }
export interface TearOptions extends FillingOptions {
  layers?: 'nearest' | 'all';
  /** Of the gap; 0: the lips coincide. */
  width?: number;
  /** Of the inner walls; 0: none. */
  wallDepth?: number;
  lipRoll?: number;
  wallMaterial?: number;
}
export interface StrokeOptions extends TearOptions { minimumDistance?: number; minimumSeconds?: number }
export interface CutOptions extends FillingOptions {
  point: Vector3Like; normal: Vector3Like;
  caps?: boolean; capMaterial?: number;
  polygon?: Vector3Like[]; sections?: Vector3Like[]; bone?: string;
  firstHit?: { origin: Vector3Like; direction: Vector3Like };
}
export interface BoreOptions extends FillingOptions {
  origin: Vector3Like; direction: Vector3Like; radius: number; depth: number;
  wall?: boolean; chordTolerance?: number; wallMaterial?: number;
}
export interface WeldOptions {
  /** Only the wound nearest to each is closed. */
  places?: Vector3Like[];
  /** How far from these places along the wound, metres; 0: to its ends. */
  reach?: number; background?: boolean;
}
/** A thread of a suture; an end is null if it holds nothing any more. */
export interface SutureThread {
  left: { mesh: number; vertex: number } | null;
  right: { mesh: number; vertex: number } | null;
  /** With which it pulled its lips together in the last update. */
  newtons: number;
  isBroken: boolean;
}
export interface SutureOptions extends WeldOptions {
  /** Between threads along the wound, metres. */
  spacing?: number;
  /** Of a thread, newtons per metre. */
  stiffness?: number;
  /** Newtons: with which a thread was tied, and at which it breaks; 0: it never does. */
  tension?: number; strength?: number;
}
export interface DetachOptions {
  mesh?: number; triangle?: number; point?: Vector3Like; bone?: string;
  motion?: 'frozen' | 'animated' | 'vanishes'; axes?: 'principal' | 'model'; openSurfaces?: 'fans' | 'shell';
  density?: number; shellThickness?: number;
}

/** What came of a command. */
export interface Result {
  readonly command: bigint; readonly instance: Instance | null; readonly error: SunderError | null;
  readonly runs: number; readonly segmentsMissed: number; readonly facesCrossed: number; readonly verticesAdded: number; readonly trianglesAdded: number;
  readonly trianglesRetired: number; readonly blocked: number; readonly caps: number; readonly openSections: number;
  readonly separatedPieces: number; readonly length: number; readonly areaRemoved: number;
  readonly piece: Piece | null;
}
/** What was asked of an instance; the next update does it. */
export interface Command {
  readonly id: bigint;
  readonly result: Result | null;
  readonly done: Promise<Result>;
}
export interface Stroke {
  readonly begun: Command;
  extend(position: Blade, seconds: number): Command;
  end(): Command;
  cancel(): Command;
}
export interface Hold { move(target: Vector3Like): void; release(): void }
export interface Layer {
  readonly state: { isOver: boolean; time: number; weight: number };
  fade(weight: number, seconds: number): void;
  stop(seconds?: number): void;
  seek(time: number): void;
  set speed(speed: number);
}
export interface PlayOptions {
  kind?: 'whole' | 'animated' | 'additive'; mode?: 'loop' | 'pingPong' | 'once'; easing?: 'linear' | 'smooth' | 'in' | 'out';
  time?: number; speed?: number; fadeIn?: number; fadeOut?: number; weight?: number; maskBone?: number;
}
export interface Contact {
  place: number[]; normal: number[]; distance: number; depth: number; barycentric: number[];
  mesh: number; triangle: number; submesh: number; material: number; bone: number; enters: number;
}
export interface ForceTearing {
  hasTorn: boolean; isFromTip: boolean; verticesAdded: number; greatestStretch: number; greatestRelease: number;
  length: number; place: number[]; direction: number[];
}
export interface Collider {
  shape: 'sphere' | 'capsule' | 'box' | 'halfSpace'; size?: Vector3Like; place?: Vector3Like; rotation?: QuaternionLike; friction?: number;
}
export type TissuePlace = { mesh?: number; vertex: number } | Contact;

export interface ValidationOptions {
  randomPoses?: number; seed?: number | bigint;
  /** Largest turn of a bone from rest, radians. */
  randomAngle?: number;
  /** Shares of the diagonal above which a deviation is a warning, and an error. */
  maximumDeviation?: number; errorDeviation?: number;
  /** Certificates hold for the joints' reach in the clips, and not for all poses. */
  clipLimits?: boolean;
  /** Radians beyond the reach in clips. */
  clipMargin?: number;
}
export interface Finding {
  code: string; text: string; advice: string; unit: string; value: number; threshold: number; count: number;
  severity: 'note' | 'warning' | 'error'; evidence: 'exact' | 'certified' | 'sampled' | 'notTested';
  mesh: number | null; vertex: number | null; bone: number | null;
}
/** Lengths in metres; arrays are copies. */
export interface ValidationReport {
  errorCount: number; warningCount: number; noteCount: number; poseCount: number; vertexCount: number; unmatched: number; uncertified: number;
  diagonal: number; metresPerUnit: number;
  /** The largest deviation in the poses that were tried. */
  sampled: number;
  /** What a search for the worst pose found, and what no certified vertex exceeds in any pose within the limits. */
  found: number; certified: number;
  /** The points that the newest operation made on the surface. */
  newest: { points: number; uncertified: number; sampled: number; certified: number };
  findings: Finding[];
  /** Per vertex of the target, all meshes one after the other. NaN: no match, or no bound. */
  deviations: Float32Array; bounds: Float32Array;
}

export interface WoundMaskOptions {
  width?: number; height?: number; uvSet?: number; dilation?: number;
  /** Metres along the surface. */
  reach?: number;
  /** Only the wounds of these operations, as the log numbers them. */
  firstOperation?: number; operationCount?: number;
}
/** The wounds of a mesh in its texture: metres along the surface from the nearest lip, negative where skin was removed. */
export interface WoundMask {
  width: number; height: number; overlappingTexels: number; unpaintedTriangles: number;
  /** A view until the next update. */
  distances: Float32Array;
  /** Texels that may have changed since the last call; none: width 0. */
  changed: { left: number; top: number; width: number; height: number };
}

/** One character in a scene. Operations are applied by the next update, in the pose of then. */
export class Instance {
  private constructor();
  readonly id: bigint; readonly model: Model; readonly scene: Scene; readonly exists: boolean;
  tear(stroke: StrokePath, options?: TearOptions): Command;
  beginStroke(position: Blade, options?: StrokeOptions): Stroke;
  cut(plane: CutOptions): Command;
  drill(bore: BoreOptions): Command;
  weld(options?: WeldOptions): Command;
  suture(options?: SutureOptions): Command;
  detach(piece: DetachOptions): Command;
  undo(): Command;
  redo(): Command;
  readonly undoCounts: { undo: number; redo: number };
  prepareToTear(): void;
  readonly log: string;
  applyLog(json: Bytes): number;
  readonly digest: bigint;
  toGLB(options?: { maximumInfluences?: number }): Uint8Array;
  validate(options?: ValidationOptions): ValidationReport;
  play(clip?: string | number, options?: PlayOptions): Layer;
  crossFade(clip: string | number, options?: PlayOptions): Layer;
  stop(): void;
  setMatrices(matrices: ArrayLike<number>, morphWeights?: ArrayLike<number> | null): void;
  setTransforms(transforms: Transform[], morphWeights?: ArrayLike<number> | null): void;
  /** A view until the next update. */
  readonly matrices: Float64Array;
  mesh(index?: number, seen?: bigint): PosedMesh;
  source(index?: number): MeshData;
  beginWoundMask(options?: WoundMaskOptions, index?: number): void;
  endWoundMask(index?: number): void;
  woundMask(index?: number): WoundMask;
  /** A view until the next one of the scene: per texel of the mask, -1, 0 or 1 where there is no wound. */
  woundChannel(channel: 'age' | 'depth' | 'stretch', index?: number): Float32Array;
  /** How much blood runs over each texel of the mask, 0 to 1. Lengths in metres. */
  flowBlood(options?: { down?: Vector3Like; length?: number; width?: number; spacing?: number; seed?: number | bigint }, index?: number): Float32Array;
  set visible(visible: boolean);
  set screenHeight(pixels: number);
  readonly tissue: { particleCount: number; pointCount: number; isAwake: boolean };
  readonly threads: SutureThread[];
  hold(at: TissuePlace, target: Vector3Like, options?: { stiffness?: number }): Hold;
  push(at: TissuePlace, newtonSeconds: Vector3Like): void;
  set gravity(metresPerSecondSquared: Vector3Like);
  setTension(newtonsPerMetre: number, options?: { addsPoseStrain?: boolean }): void;
  setMaterial(material: MaterialLike, index?: number): void;
  tearOverstretched(options?: { length?: number; metres?: number }): ForceTearing;
  setColliders(colliders: Collider[]): void;
  moveCollider(collider: number, place: Vector3Like, rotation?: QuaternionLike): void;
  inheritMotion(piece: Piece): void;
  raycast(origin: Vector3Like, direction: Vector3Like, length?: number): Contact | null;
  nearest(point: Vector3Like, mostDistance?: number): Contact | null;
  bladeContacts(position: Blade): Contact[];
  dispose(): void;
}

export interface FrameStats { [figure: string]: number }

/** Instances that are updated together, once per frame. */
export class Scene extends Disposable {
  private constructor();
  spawn(model: Model, options?: { visible?: boolean; vertices?: number; triangles?: number; operations?: number }): Instance;
  adopt(id: bigint, model: Model): Instance;
  readonly instances: Instance[];
  update(seconds: number): Result[];
  readonly results: Result[];
  readonly drawn: Instance[];
  readonly stats: FrameStats;
  setBudget(budget?: { settledPoints?: number; modelWork?: number }): void;
  save(): Uint8Array;
  restore(snapshot: Bytes, models: Model[], options?: { instances?: number; operations?: number | bigint; memory?: number | bigint }): void;
}

/** A part that came off. */
export class Piece extends Disposable {
  private constructor();
  readonly info: {
    mass: number; volume: number; area: number; centre: number[]; inertia: number[]; inertiaPiece: number[]; modelFromPiece: number[];
    solid: 'closed' | 'fans' | 'shell'; holes: number; meshCount: number;
  };
  toModel(options?: ModelOptions): Model;
  source(mesh?: number): { mesh: number; vertices: Uint32Array };
  hulls(options?: { most?: number; points?: number }): { points: Float64Array; triangles: Uint32Array; bone: number | null; volume: number }[];
}

export const Sunder: {
  init(source?: WasmSource | Promise<WasmSource>): Promise<void>;
  load(bytes: Bytes, options?: LoadOptions): Promise<Model>;
  fromArrays(data: CharacterArrays, options?: ModelOptions): Promise<Model>;
  createScene(options?: { backgroundUpdates?: number }): Promise<Scene>;
  readonly version: string;
  readonly features: { threads: boolean; hulls: boolean; validation: boolean };
  validate(source: Model, target: Model, options?: ValidationOptions): ValidationReport;
  readonly materialNames: MaterialName[];
  material(name: MaterialName): TissueMaterial;
  tensionForGap(material: MaterialLike, length: number, gap: number): number;
  /** Newtons on a blade, against its motion. lengthTorn: of the frame; depth: of the tip below the surface; metres. */
  bladeForce(step: { lengthTorn: number; depth: number; motion: Vector3Like },
    tissue?: { toughness?: number; thickness?: number; friction?: number; greatest?: number }): [number, number, number];
  readonly memoryBytes: number;
  readonly calls: Calls;
};
