// SPDX-License-Identifier: Apache-2.0
// The lights of the scene, drawn over the picture: the mouse selects and drags them, and a list adds and removes them.
import {command} from "./server.js";
import {offerText} from "./scene_text.js";
import {dragged, newLight, orbited, shapeOf, viewOf} from "./light_shapes.js";

const element = id => document.getElementById(id);
const kReach = 9;           // pixels of the screen around a handle
const kTurn = 0.008;        // radians per pixel of the screen
const kPatience_ms = 3000;  // without a picture of the last change, the next one is sent
const kTypes = ["rectangle", "disk", "sphere", "point", "spot", "sun"];

export class LightTool {
  // `view`: {state(), edit(), canvas, tell(message)}.
  constructor(view) {
    this.view = view;
    this.open = false;
    this.selected = null;     // name of a light
    this.moved = new Map();   // values that the state does not have yet, by the name of the light
    this.waiting = new Map();  // those that the server was not sent yet
    element("rig_type").replaceChildren(...kTypes.map(type => new Option(type)));
    element("rig_list").addEventListener("change", event => this.select(event.target.value));
    element("rig_add").addEventListener("click", () => this.add(element("rig_type").value));
    element("rig_remove").addEventListener("click", () => this.run({action: "remove", light: this.selected}));
    element("rig_reset").addEventListener("click", () => this.run({action: "reset"}));
    element("rig_text").addEventListener("click", () => offerText("Lights of this view", "rig.json", {}));
  }

  // The lights as the page shows them.
  lights() {
    return (this.view.state()?.lights ?? []).map(light => ({...light, values: {...light.values, ...this.moved.get(light.name)}}));
  }
  light(name) { return this.lights().find(light => light.name === name); }
  camera() { return this.view.camera() ?? this.view.state().camera; }
  viewOf() { return viewOf(this.camera(), this.view.state().width, this.view.state().height); }

  show(open) {
    this.open = open;
    this.view.canvas.setOverlay(open ? (context, place, ratio) => this.draw(context, place, ratio) : null);
  }

  select(name) {
    this.selected = name;
    element("rig_list").value = name ?? "";
    element("rig_remove").disabled = !name;
    this.view.canvas.draw();
  }

  async run(request) {
    try {
      return await command("rig.json", request);
    } catch (problem) {
      this.view.tell(problem.message);
      return null;
    }
  }

  async add(type) {
    const answer = await this.run({action: "add", type, values: newLight(type, this.camera(), this.viewOf())});
    if (answer) this.wanted = answer.light;
  }

  // The handle under the mouse: of the selected light first.
  handleAt(event) {
    const camera = this.camera(), view = this.viewOf(), {canvas} = this.view;
    const order = light => light.name === this.selected ? 0 : 1;
    let best = null;
    for (const light of this.lights().sort((a, b) => order(a) - order(b))) {
      for (const handle of shapeOf(light, camera)?.handles ?? []) {
        if (light.name !== this.selected && handle.key !== "position" && handle.key !== "direction") continue;
        const place = view.project(handle.point), screen = place && canvas.toScreen(...place);
        const far = screen ? Math.hypot(screen.x - event.offsetX, screen.y - event.offsetY) : Infinity;
        if (far <= kReach && (!best || far < best.far - 1)) best = {far, light, key: handle.key};
      }
    }
    return best;
  }

  // Whether a gesture is for the lights.
  takes(event) {
    if (!this.open || !this.view.state()?.width) return false;
    if (event.type === "wheel") return event.shiftKey && this.hasPlace();
    return event.button === 2 ? this.hasPlace() : event.button === 0 && this.handleAt(event) !== null;
  }
  hasPlace() {
    const light = this.light(this.selected);
    return light !== undefined && shapeOf(light, this.camera()) !== null;
  }

  down(event) {
    if (event.button === 2) {
      this.drag = {light: this.light(this.selected), x: event.offsetX, y: event.offsetY};
      return true;
    }
    const hit = this.handleAt(event);
    if (!hit) return false;
    this.select(hit.light.name);
    this.drag = hit;
    return true;
  }

  move(event) {
    if (!this.drag) return;
    const {light, key, x, y} = this.drag;
    if (key) {
      const place = this.view.canvas.toPicture(event.offsetX, event.offsetY);
      this.change(light.name, dragged(light, key, this.camera(), this.viewOf(), place.x, place.y));
    } else {
      this.change(light.name, orbited(light, this.camera(), this.viewOf(), (event.offsetX - x) * kTurn, (event.offsetY - y) * kTurn));
    }
  }

  up() { this.drag = null; }

  wheel(event) {
    const factor = 2 ** ((event.deltaY || event.deltaX) / 600);
    const light = this.light(this.selected);
    if (!light.values.direction) this.change(light.name, orbited(light, this.camera(), this.viewOf(), 0, 0, factor));
  }

  change(name, values) {
    for (const map of [this.moved, this.waiting]) map.set(name, {...map.get(name), ...values});
    this.view.canvas.draw();
    this.follow();
    this.tellWhetherItWaits();
  }

  tellWhetherItWaits() { document.body.dataset.light_waits = this.waits > 0 || this.waiting.size > 0; }

  // Sends changes once the picture of the last ones is there.
  async follow() {
    if (!this.waiting.size || this.waits) return;
    this.waits = performance.now();
    this.sentEdit = this.view.edit();
    const changes = [...this.waiting];
    this.waiting.clear();
    for (const [light, values] of changes) {
      if (await this.run({action: "change", light, values})) continue;
      this.moved.delete(light);
      this.waits = 0;
    }
  }

  // After each state of the server.
  update() {
    const {lights, lights_changed} = this.view.state();
    if (this.waits && (this.view.edit() > this.sentEdit || performance.now() - this.waits > kPatience_ms)) this.waits = 0;
    if (!this.waits && !this.waiting.size && !this.drag) this.moved.clear();  // the state has them now
    this.follow();
    const names = lights.map(light => light.name), list = element("rig_list");
    if (names.join("\n") !== [...list.options].map(option => option.value).join("\n"))
      list.replaceChildren(...lights.map(light => new Option(`${light.name} (${light.type})`, light.name)));
    if (this.wanted && names.includes(this.wanted)) {
      this.select(this.wanted);
      this.wanted = null;
    } else if (this.selected && !names.includes(this.selected)) {
      this.select(null);
    } else if (this.selected) {
      list.value = this.selected;
    }
    element("rig_text").disabled = element("rig_reset").disabled = !lights_changed;
    document.body.dataset.light = this.selected ?? "";
    this.tellWhetherItWaits();
    if (this.open) this.view.canvas.draw();
  }

  // `place([x, y])`: from pixels of the picture to those of the context.
  draw(context, place, ratio) {
    if (!this.view.state()?.width) return;
    const camera = this.camera(), view = this.viewOf();
    const path = points => {
      const line = new Path2D();
      let pen = false;
      for (const point of points) {
        const at = view.project(point);
        if (at && pen) line.lineTo(...place(at));
        else if (at) line.moveTo(...place(at));
        pen = at !== null;
      }
      return line;
    };
    for (const light of this.lights()) {
      const shape = shapeOf(light, camera), isSelected = light.name === this.selected;
      if (!shape) continue;
      const stroke = (line, width, dash) => {
        context.setLineDash(dash);
        for (const [color, more] of [["#000a", 2], [isSelected ? "#ffb454" : "#fff", 0]]) {
          context.strokeStyle = color;
          context.lineWidth = (width + more) * ratio;
          context.stroke(line);
        }
        context.setLineDash([]);
      };
      if (isSelected) for (const points of shape.aims) stroke(path(points), 1, [4 * ratio, 4 * ratio]);
      for (const points of shape.lines) stroke(path(points), 1.5, []);
      for (const {key, point} of shape.handles) {
        const at = view.project(point);
        const isCenter = key === "position" || key === "direction";
        if (!at || (!isCenter && !isSelected)) continue;
        const dot = new Path2D(), [x, y] = place(at), size = (isCenter ? 5 : 4) * ratio;
        if (isCenter) dot.arc(x, y, size, 0, 2 * Math.PI);
        else dot.rect(x - size, y - size, 2 * size, 2 * size);
        context.fillStyle = isSelected ? "#ffb454" : "#fff";
        context.fill(dot);
        context.strokeStyle = "#000";
        context.lineWidth = ratio;
        context.stroke(dot);
      }
    }
  }
}
