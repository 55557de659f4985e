// Play, clip, poses, chart and slider.
import { drawChart, valueAt } from './chart.js';
import { byId, html, setText } from './elements.js';
import { quantity } from './format.js';

export class TimeBar {
  /** @param onPose  () after the player took another pose; @param hint  for the buttons of poses */
  constructor(data, player, { onPose, hint }) {
    Object.assign(this, { data, player, onPose });
    this.seek = byId('seek');
    const clips = byId('clip');
    clips.append(...data.clips.map((clip, i) => html('option', { value: i }, clip.name || `Clip ${i}`)));
    if (!data.clips.length) clips.append(html('option', {}, 'No clip'));
    clips.disabled = data.clips.length < 2;
    clips.addEventListener('change', () => this.change(() => player.setClip(Number(clips.value))));
    this.poses = data.poses.map((pose, i) => html('button', { 'aria-pressed': 'false',
      title: hint, onclick: () => this.togglePose(i) }, pose.name));
    byId('poses').append(...this.poses);
    byId('play').addEventListener('click', () => this.togglePlay());
    this.seek.addEventListener('input', () => this.change(() => {
      player.play(false);
      player.seek(Number(this.seek.value));
    }));
    byId('chart').addEventListener('pointerdown', (event) => this.change(() => {
      const { left, width } = byId('chart').getBoundingClientRect();
      player.play(false);
      player.seek(((event.clientX - left) / width) * player.duration);
    }));
    byId('play').disabled = this.seek.disabled = !data.clips.some((clip) => clip.duration > 0);
    this.drawClip();
  }

  change(act) {
    const { clip } = this.player;
    act();
    if (clip !== this.player.clip) this.drawClip();
    if (this.player.clip !== null) byId('clip').value = this.player.clip;
    this.update();
    this.onPose();
  }

  togglePlay() {
    this.change(() => this.player.play(!this.player.isPlaying));
  }

  togglePose(pose) {
    if (this.poses[pose]) this.change(() =>
      this.player.setPose(this.player.pose === pose ? null : pose));
  }

  step(direction) {
    this.change(() => {
      this.player.play(false);
      this.player.step(direction);
    });
  }

  drawClip() {
    const { clip, duration } = this.player;
    const list = this.data.series.filter((series) => series.clip === clip);
    [this.series] = list;
    this.moveCursor = drawChart(byId('chart'), byId('chart-title'), list, this.data.clips[clip]);
    this.seek.max = duration || 1;
    this.update();
  }

  update() {
    const { player } = this;
    setText(byId('play'), player.isPlaying ? 'Pause' : 'Play');
    this.poses.forEach((button, i) => button.setAttribute('aria-pressed', player.pose === i));
    this.seek.value = player.time;
    this.moveCursor(player.time);
    const value = this.series && player.pose === null
      ? `${quantity(valueAt(this.series, player.time), this.series.unit)} at ` : '';
    const ofClip = player.clip === null ? 'Rest' : `${value}${player.time.toFixed(2)} s`;
    setText(byId('clock'), player.pose === null ? ofClip : player.poses[player.pose].name);
  }
}
