// SPDX-License-Identifier: Apache-2.0
// Plays the frames of an animated scene: renders a coarse picture of each, keeps them, and shows them in turn.
const kCoarsest = 4;           // pixels between those of the grid
const kMaxBytes = 512 * 2 ** 20;

const bytesOf = layer => layer.channels.reduce((sum, channel) => sum + channel.data.byteLength, 0);

export class FlipBook {
  // `frames`: the FrameChoice. `onTurn`: shows `shown`, the layer to show instead of the server's; null for none.
  constructor(button, frames, tell, onTurn) {
    Object.assign(this, {button, frames, tell, onTurn, shown: null, plays: false});
    button.addEventListener("click", () => this.plays ? this.stop() : this.start());
  }

  start() {
    if (this.frames.frames.length < 2) return;
    this.plays = true;
    this.button.setAttribute("aria-pressed", true);
    this.begin();
  }

  // Forgets all pictures.
  begin() {
    clearTimeout(this.timer);
    this.timer = this.shown = null;
    this.frames.isLed = false;
    this.pictures = [];
    this.all = this.frames.frames.slice();
    this.ask();
  }

  // `stays`: whether the frame that is shown is rendered.
  stop(stays = true) {
    if (!this.plays) return;
    const frame = this.shown?.frame;
    this.plays = this.frames.isLed = false;
    this.button.setAttribute("aria-pressed", false);
    clearTimeout(this.timer);
    this.timer = this.shown = null;
    this.pictures = [];
    if (stays && frame !== undefined) this.frames.choose(this.frames.frames.indexOf(frame));
    this.onTurn();
  }

  ask() { this.frames.choose(this.pictures.length); }

  // After each state and layer of the server. Begins again if the pictures no longer fit: after an edit, for another
  // layer, or for other frames.
  update(state, layer) {
    if (!this.plays) return;
    if (state.error) return this.stop();
    if (!layer) return;
    const key = JSON.stringify([layer.name, layer.width, layer.height, state.frames]);
    // Each frame is an edit of its own.
    const edits = this.edits + this.pictures.length - (this.timer === null ? 0 : 1);
    if (this.pictures.length && (key !== this.key || state.edits > edits)) return this.begin();
    // The layer may be of the frame before it was chosen, which began another edit.
    const isWanted = layer.edit === state.edits && layer.frame === this.all[this.pictures.length];
    if (this.timer !== null || !isWanted || layer.grid > kCoarsest) return;
    this.key = key;
    this.fps = state.fps;
    if (!this.pictures.length) this.edits = layer.edit;
    if (layer.edit !== this.edits + this.pictures.length) return this.begin();
    this.pictures.push(layer);
    const isFull = this.pictures.length * bytesOf(layer) > kMaxBytes;
    if (isFull && this.pictures.length < this.all.length)
      this.tell(`Plays the first ${this.pictures.length} frames: more pictures would take too much memory`);
    if (isFull || this.pictures.length === this.all.length) this.turn(0);
    else this.ask();
  }

  turn(place) {
    this.frames.isLed = true;
    this.timer = setTimeout(() => this.turn((place + 1) % this.pictures.length), 1000 / this.fps);
    this.shown = this.pictures[place];
    this.frames.show(this.shown.frame);
    this.onTurn();
  }
}
