// SPDX-License-Identifier: Apache-2.0
// The lights and magnets of the scene, drawn over the picture: the mouse selects and drags them, and a list adds, copies and
// removes them. They are known by keys, "lights.NAME" and "magnets.NAME".
import {command} from "./server.js";
import {offerText} from "./scene_text.js";
import {dragged, freePlace, newLight, orbited, shapeOf, viewOf} from "./light_shapes.js";

const element = id => document.getElementById(id);
const kReach = 9;           // pixels of the screen around a handle
const kTurn = 0.008;        // radians per pixel of the screen
const kPatience_ms = 3000;  // without a picture of the last change, the next one is sent
const kPage = Math.random().toString(36).slice(2);  // gestures of other pages have other names
const kMaxNames = 8;        // lights whose names are all shown
const kTypes = {lights: ["rectangle", "disk", "sphere", "point", "spot", "sun"], magnets: ["rectangle", "sphere"]};
const titleOf = light => `${light.name} (${light.type}${light.block === "magnets" ? " magnet" : ""})`;

export class LightTool {
  // `view`: {state(), edit(), canvas, tell(message)}.
  constructor(view) {
    this.view = view;
    this.open = false;
    this.selected = null;     // key of a light
    this.hovered = null;      // key of the light under the mouse
    this.gesture = 0;         // number of the last one
    this.moved = new Map();   // values that the state does not have yet, by the key of the light
    this.waiting = new Map();  // those that the server was not sent yet
    element("rig_type").replaceChildren(...Object.entries(kTypes).flatMap(([block, types]) => types.map(
      type => new Option(block === "magnets" ? `${type} magnet` : type, `${block}.${type}`))));
    element("rig_list").addEventListener("change", event => this.select(event.target.value));
    element("rig_add").addEventListener("click", () => this.add(...element("rig_type").value.split(".")));
    element("rig_copy").addEventListener("click", () => this.copy());
    element("rig_remove").addEventListener("click", () => this.remove());
    element("rig_undo").addEventListener("click", () => this.run({action: "undo"}));
    element("rig_reset").addEventListener("click", () => this.run({action: "reset"}));
    element("rig_text").addEventListener("click", () => offerText("Lights of this view", "rig.json", {}));
  }

  // The lights as the page shows them.
  lights() {
    const state = this.view.state();
    return ["lights", "magnets"].flatMap(block => (state?.[block] ?? []).map(light => {
      const key = `${block}.${light.name}`;
      return {...light, block, key, values: {...light.values, ...this.moved.get(key)}};
    }));
  }
  light(key) { return this.lights().find(light => light.key === key); }
  places() { return this.lights().map(light => light.values.position).filter(place => place); }
  camera() { return this.view.camera() ?? this.view.state().camera; }
  viewOf() { return viewOf(this.camera(), this.view.state().width, this.view.state().height); }

  show(open) {
    this.open = open;
    this.view.canvas.setOverlay(open ? (context, place, ratio) => this.draw(context, place, ratio) : null);
  }

  select(key) {
    this.selected = key;
    element("rig_list").value = key ?? "";
    this.enable();
    this.view.canvas.draw();
  }
  enable() {
    element("rig_remove").disabled = !this.selected;
    element("rig_copy").disabled = !Object.values(kTypes).flat().includes(this.light(this.selected)?.type);
  }

  async run(request) {
    try {
      return await command("rig.json", request);
    } catch (problem) {
      this.view.tell(problem.message);
      return null;
    }
  }

  async add(block, type) {
    const values = newLight(type, block, this.places(), this.camera(), this.viewOf());
    const answer = await this.run({action: "add", block, type, values});
    if (answer) this.wanted = `${block}.${answer.light}`;
  }

  // A copy has all keys of the selected light, beside it. What was moved last must be there first.
  async copy() {
    const light = this.light(this.selected);
    await this.settled();
    const values = light.values.position ? {position: freePlace(light.values.position, this.places(), this.camera(), this.viewOf())} : {};
    const answer = await this.run({action: "copy", block: light.block, light: light.name, values});
    if (answer) this.wanted = `${light.block}.${answer.light}`;
  }

  remove() {
    const light = this.light(this.selected);
    if (light) this.run({action: "remove", block: light.block, light: light.name});
  }

  // Waits until the server has all changes.
  async settled() {
    const end = performance.now() + kPatience_ms;
    while (this.waiting.size && performance.now() < end) await new Promise(done => setTimeout(done, 20));
  }

  // The handle under the mouse: of the selected light first.
  handleAt(event) {
    const camera = this.camera(), view = this.viewOf(), {canvas} = this.view;
    const order = light => light.key === this.selected ? 0 : 1;
    let best = null;
    for (const light of this.lights().sort((a, b) => order(a) - order(b))) {
      for (const handle of shapeOf(light, camera)?.handles ?? []) {
        if (light.key !== this.selected && handle.key !== "position" && handle.key !== "direction") continue;
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

  // Whether a key is for the lights; then does what it says.
  takesKey(event) {
    const isTyping = ["TEXTAREA", "INPUT"].includes(event.target.tagName) && event.target.type !== "range";
    const button = event.key === "Delete" ? "rig_remove" : event.key === "z" && (event.ctrlKey || event.metaKey) ? "rig_undo" : null;
    if (isTyping || !button) return false;
    element(button).click();
    return true;
  }

  // Shows the name of the light under the mouse.
  hover(event) {
    const key = this.open && this.view.state()?.width ? this.handleAt(event)?.light.key ?? null : null;
    if (key === this.hovered) return;
    this.hovered = key;
    this.view.canvas.draw();
  }

  down(event) {
    ++this.gesture;
    if (event.button === 2) {
      this.drag = {light: this.light(this.selected), x: event.offsetX, y: event.offsetY};
      return true;
    }
    const hit = this.handleAt(event);
    if (!hit) return false;
    this.select(hit.light.key);
    this.drag = hit;
    return true;
  }

  move(event) {
    if (!this.drag) return;
    const {light, key, x, y} = this.drag;
    if (key) {
      const place = this.view.canvas.toPicture(event.offsetX, event.offsetY);
      this.change(light.key, dragged(light, key, this.camera(), this.viewOf(), place.x, place.y));
    } else {
      this.change(light.key, orbited(light, this.camera(), this.viewOf(), (event.offsetX - x) * kTurn, (event.offsetY - y) * kTurn));
    }
  }

  up() { this.drag = null; }

  wheel(event) {
    const factor = 2 ** ((event.deltaY || event.deltaX) / 600);
    const light = this.light(this.selected);
    if (!light.values.direction) this.change(light.key, orbited(light, this.camera(), this.viewOf(), 0, 0, factor));
  }

  change(key, values) {
    for (const map of [this.moved, this.waiting]) map.set(key, {...map.get(key), ...values});
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
    for (const [key, values] of changes) {
      const dot = key.indexOf("."), gesture = `${kPage} ${this.gesture}`;
      if (await this.run({action: "change", block: key.slice(0, dot), light: key.slice(dot + 1), values, gesture})) continue;
      this.moved.delete(key);
      this.waits = 0;
    }
  }

  // After each state of the server.
  update() {
    const {lights_changed, lights_undo} = this.view.state();
    if (this.waits && (this.view.edit() > this.sentEdit || performance.now() - this.waits > kPatience_ms)) this.waits = 0;
    if (!this.waits && !this.waiting.size && !this.drag) this.moved.clear();  // the state has them now
    this.follow();
    const lights = this.lights().sort((a, b) => a.key.localeCompare(b.key, "en", {numeric: true}));
    const keys = lights.map(light => light.key), list = element("rig_list");
    if (keys.join("\n") !== [...list.options].map(option => option.value).join("\n"))
      list.replaceChildren(...lights.map(light => new Option(titleOf(light), light.key)));
    if (this.wanted && keys.includes(this.wanted)) {
      this.select(this.wanted);
      this.wanted = null;
    } else if (this.selected && !keys.includes(this.selected)) {
      this.select(null);
    } else if (this.selected) {
      list.value = this.selected;
    }
    element("rig_text").disabled = element("rig_reset").disabled = !lights_changed;
    element("rig_undo").disabled = !lights_undo;
    this.enable();
    document.body.dataset.light = this.light(this.selected)?.name ?? "";
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
    const lights = this.lights();
    for (const light of lights) {
      const shape = shapeOf(light, camera), isSelected = light.key === this.selected;
      if (!shape) continue;
      const own = isSelected ? "#ffb454" : light.block === "magnets" ? "#7fd4ff" : "#fff";
      const stroke = (line, width, dash) => {
        context.setLineDash(dash);
        for (const [color, more] of [["#000a", 2], [own, 0]]) {
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
        context.fillStyle = own;
        context.fill(dot);
        context.strokeStyle = "#000";
        context.lineWidth = ratio;
        context.stroke(dot);
        if (!isCenter || !(isSelected || light.key === this.hovered || lights.length <= kMaxNames)) continue;
        context.font = `${12 * ratio}px sans-serif`;
        context.lineWidth = 3 * ratio;
        context.strokeStyle = "#000a";
        context.strokeText(light.name, x + 9 * ratio, y - 6 * ratio);
        context.fillText(light.name, x + 9 * ratio, y - 6 * ratio);
      }
    }
  }
}
