// SPDX-License-Identifier: Apache-2.0
// A rectangle of the picture that is refined first.
import {command} from "./server.js";

export class RegionTool {
  constructor(view) {
    this.view = view;
    this.box = null;  // [x0, y0, x1, y1] while it is drawn
  }

  down(event) {
    if (event.button !== 0) return false;
    this.from = this.view.canvas.toPicture(event.offsetX, event.offsetY);
    return true;
  }

  move(event) {
    if (!this.from) return;
    const {width, height} = this.view.state(), to = this.view.canvas.toPicture(event.offsetX, event.offsetY);
    const clamp = (v, max) => Math.min(Math.max(v, 0), max);
    const ends = (a, b, max) => [clamp(Math.floor(Math.min(a, b)), max), clamp(Math.ceil(Math.max(a, b)), max)];
    const [x0, x1] = ends(this.from.x, to.x, width), [y0, y1] = ends(this.from.y, to.y, height);
    this.box = x0 < x1 && y0 < y1 ? [x0, y0, x1, y1] : null;
    this.view.canvas.setBox(this.box);
  }

  up() {
    if (this.from && this.box) this.send(this.box);
    this.from = this.box = null;
  }

  clear() { this.send(null); }

  send(region) {
    this.last = region;
    command("region.json", {region}).catch(problem => this.view.tell(problem.message));
  }
}
