// SPDX-License-Identifier: Apache-2.0
// The mouse moves the camera, and the render follows.
import {command, pixelFor, readLayers} from "./server.js";
import {aimAt, dolly, orbit, pan} from "./camera.js";

const kPatience_ms = 3000;  // without a picture of the last camera, the next one is sent
const kTurn = 0.008;        // radians per pixel of the screen
const kSettle_ms = 400;     // turns of the wheel within this time are one gesture

export class CameraTool {
  // `view`: {state(), edit(), canvas, tell(message)}.
  constructor(view) {
    this.view = view;
    this.camera = null;  // the one to show; null: the state's
    this.sent = null;
    this.depth = null;   // {edit, value} of the point in the centre
  }

  // The point in the centre of the picture, for the next gesture.
  async findDepth() {
    const edit = this.view.edit();
    if (this.depth?.edit === edit || this.drag) return;
    const layer = await readLayers(["Z"]);
    if (!layer) return;
    const x = layer.width >> 1, y = layer.height >> 1;
    this.depth = {edit: layer.edit, value: layer.channels[0].data[pixelFor(layer, x, y)]};
  }

  begin() {
    if (this.camera) return;
    const {camera, edits} = this.view.state();
    const isKnown = this.depth?.edit === edits && this.view.edit() === edits;
    this.camera = isKnown ? aimAt(camera, this.depth.value) : camera;
    this.sent = this.camera;  // no move yet
  }

  down(event) {
    if (event.button > 2) return false;
    this.begin();
    this.drag = {x: event.offsetX, y: event.offsetY, turns: event.button === 0};
    return true;
  }

  move(event) {
    if (!this.drag) return;
    const x = event.offsetX - this.drag.x, y = event.offsetY - this.drag.y;
    this.drag.x = event.offsetX;
    this.drag.y = event.offsetY;
    const height = this.view.canvas.shownHeight();
    this.set(this.drag.turns ? orbit(this.camera, -x * kTurn, y * kTurn) : pan(this.camera, -x / height, y / height));
  }

  up() { this.drag = null; }

  wheel(event) {
    if (!this.rolled || performance.now() - this.rolled > kSettle_ms) this.begin();
    this.rolled = performance.now();
    this.set(dolly(this.camera, 2 ** (event.deltaY / 600)));
  }

  set(camera) {
    this.camera = camera;
    this.follow();
  }

  // Sends the camera once the picture of the last one is there.
  async follow() {
    if (this.camera && this.camera !== this.sent && !this.waits) {
      this.waits = performance.now();
      this.sent = this.camera;
      this.sentEdit = this.view.edit();
      const {position, look_at} = this.camera;
      try {
        await command("camera.json", {action: "move", position, look_at});
      } catch (problem) {
        this.camera = null;
        this.waits = 0;
        this.view.tell(problem.message);
      }
    }
  }

  reset() {
    this.camera = this.sent = null;
    command("camera.json", {action: "reset"}).catch(problem => this.view.tell(problem.message));
  }

  // After each state of the server.
  update() {
    if (this.waits && (this.view.edit() > this.sentEdit || performance.now() - this.waits > kPatience_ms)) this.waits = 0;
    if (!this.waits && this.camera === this.sent && !this.drag) this.camera = null;  // the state has it now
    this.follow();
  }
}
