// The pose that is shown: a clip at a time, or a given pose. No DOM.
import { modelFromBone, sampleClip } from './pose.js';
import { palette } from './skin.js';

export class Player {
  constructor(data) {
    this.data = data;
    this.clip = data.clips.length ? 0 : null;
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

  /** One sample forward or back. */
  step(direction) {
    const clip = this.data.clips[this.clip];
    if (!clip || clip.samples < 2) return;
    const length = clip.duration / (clip.samples - 1);
    this.seek((Math.round(this.time / length) + direction) * length);
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
    this.bones = this.pose === null
      ? modelFromBone(data, sampleClip(data, data.clips[this.clip], this.time))
      : Float64Array.from(data.poses[this.pose].matrices);
    this.source = palette(data.source, this.bones);
    this.target = palette(data.target, this.bones);
  }
}
