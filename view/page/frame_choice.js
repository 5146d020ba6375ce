// SPDX-License-Identifier: Apache-2.0
// Chooses the frame that is shown, of an animated scene.
import {command} from "./server.js";

const element = id => document.getElementById(id);

export class FrameChoice {
  // `tell`: shows a message.
  constructor(tell) {
    this.tell = tell;
    this.frames = [];
    this.wanted = null;  // the frame to send next; null for none
    this.sends = false;
    this.isLed = false;  // by a flip book
    element("frame").addEventListener("input", event => this.choose(Number(event.target.value)));
  }

  // After each state of the server.
  update({frame, frames}) {
    this.frames = frames;
    element("frames").hidden = frames.length < 2;
    element("frame").max = frames.length - 1;
    if (!this.sends && !this.isLed) this.show(frame);  // while it sends, the slider is ahead of the server
  }

  show(frame) {
    element("frame").value = this.frames.indexOf(frame);
    element("frame_number").textContent = frame;
  }

  step(count) {
    const place = Number(element("frame").value) + count;
    if (place >= 0 && place < this.frames.length) this.choose(place);
  }

  async choose(place) {
    element("frame").value = place;
    element("frame_number").textContent = this.wanted = this.frames[place];
    if (this.sends) return;
    this.sends = true;
    while (this.wanted !== null) {
      const frame = this.wanted;
      this.wanted = null;
      await command("frame.json", {frame}).catch(problem => this.tell(problem.message));
    }
    this.sends = false;
  }
}
