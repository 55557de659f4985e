export { Sunder } from './sunder.js';
export { SunderError } from './sunder_error.js';
export { Model } from './model.js';
export { Scene } from './scene.js';
export { Instance } from './instance.js';
export { Piece } from './piece.js';
export { Ragdoll } from './ragdoll.js';
