// The pose that is shown: a clip at a time, or a given pose. No DOM.
import { modelFromBone, sampleClip } from './pose.js';
import { poseOf } from './skin.js';

/** Length of a step, in seconds. */
const STEP = 1 / 30;

export class Player {
  constructor(data) {
    this.data = data;
    this.clip = data.clips.length ? 0 : null;
    /** {name, matrices, morph_weights or nothing for those of rest} */
    this.poses = [...data.poses];
    this.pose = null;
    this.time = 0;
    this.isPlaying = false;
    this.lastTick = null;
    this.update();
  }

  get duration() {
    return this.data.clips[this.clip]?.duration ?? 0;
  }

  setClip(clip) {
    this.clip = clip;
    this.seek(0);
  }

  seek(time) {
    this.pose = null;
    this.time = Math.min(Math.max(time, 0), this.duration);
    this.update();
  }

  /** One step forward or back. */
  step(direction) {
    if (this.clip !== null) this.seek((Math.round(this.time / STEP) + direction) * STEP);
  }

  /** @param pose  number of a given pose; null goes back to the clip */
  setPose(pose) {
    this.pose = pose;
    this.isPlaying = false;
    this.update();
  }

  play(isPlaying) {
    this.isPlaying = isPlaying && this.duration > 0;
    this.lastTick = null;
    if (this.isPlaying && this.pose !== null) this.seek(this.time);
  }

  /** Moves on to the time of a frame; true if the pose changed. */
  tick(now) {
    if (!this.isPlaying) return false;
    const passed = this.lastTick === null ? 0 : Math.min(now - this.lastTick, 0.2);
    this.lastTick = now;
    this.time = (this.time + passed) % this.duration;
    this.update();
    return true;
  }

  update() {
    const { data } = this;
    let morphWeights;
    if (this.pose === null) {
      const sampled = sampleClip(data, data.clips[this.clip], this.time);
      this.bones = modelFromBone(data, sampled.parts);
      morphWeights = sampled.morphWeights;
    } else {
      const given = this.poses[this.pose];
      this.bones = Float64Array.from(given.matrices);
      morphWeights = given.morph_weights ?? data.skeleton.morph_weights;
    }
    this.source = poseOf(data.source, this.bones, morphWeights);
    this.target = data.target && poseOf(data.target, this.bones, morphWeights);
  }
}
