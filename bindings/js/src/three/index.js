export { SunderObject } from './sunder_object.js';
