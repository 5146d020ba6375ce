// SPDX-License-Identifier: Apache-2.0
import {command, pixelFor, readLayers, readState, valueAt} from "./server.js";
import {paint} from "./colors.js";
import {PictureCanvas} from "./canvas.js";
import {CameraTool} from "./camera_tool.js";
import {RegionTool} from "./region_tool.js";
import {LightTool} from "./light_tool.js";
import {WhyTool} from "./why_tool.js";
import {Mixer} from "./mixer.js";
import {FrameChoice} from "./frame_choice.js";
import {FlipBook} from "./flip_book.js";
import {offerText} from "./scene_text.js";

const element = id => document.getElementById(id);
const kPoll_ms = 120, kFastPoll_ms = 30, kNote_ms = 6000;
let state = null, layer = null, kept = null, showsKept = false, cursor = null, told = "", willDraw = false;

const view = {
  state: () => state,
  edit: () => layer?.edit ?? -1,
  tell: message => {
    element("note").textContent = message;
    element("note").hidden = !message;
    if (message) setTimeout(() => { if (element("note").textContent === message) element("note").hidden = true; }, kNote_ms);
  },
};
const camera = new CameraTool(view), region = new RegionTool(view);
view.camera = () => camera.camera;  // the one that is to be shown; null: the state's
const why = new WhyTool(view, () => toggle("why_mode", false)), frames = new FrameChoice(view.tell);
const book = new FlipBook(element("play"), frames, view.tell, () => draw());
const isOn = id => element(id).getAttribute("aria-pressed") === "true";
const takesClick = (event, id, key) => event.type === "pointerdown" && (event[key] || isOn(id));
const toolOf = event => takesClick(event, "region_mode", "shiftKey") ? region : takesClick(event, "why_mode", "altKey") ? why
                        : lights.takes(event) ? lights : isOn("camera_mode") ? camera : null;
const canvas = view.canvas =
  new PictureCanvas(element("canvas"), pixel => { cursor = pixel; showValues(); }, toolOf);
const lights = new LightTool(view);
canvas.canvas.addEventListener("pointermove", event => lights.hover(event));
const mixer = new Mixer(() => { chooseBeauty(); drawSoon(); });

function chooseBeauty() {
  if (element("layer").value === "beauty" || mixer.panel.isNeutral()) return;
  element("layer").value = "beauty";
  refresh().catch(() => {});
}

const mixes = shown => shown === layer && layer.name === "beauty" && mixer.mixes;

const shownLayer = () => showsKept && kept ? kept : book.shown ?? layer;

function draw() {
  const shown = shownLayer();
  if (!shown) return;
  const stops = Number(element("exposure").value), film = element("transform").value === "film";
  const mixed = mixes(shown), began = performance.now();
  canvas.show(mixed ? mixer.paint(stops, film) : shown.image ?? paint(shown, stops, film));
  document.body.dataset.layer = shown.name;
  document.body.dataset.mixed = mixed;
  document.body.dataset.draw_ms = performance.now() - began;
  showValues();
}

const copyOf = image => new ImageData(image.data.slice(), image.width, image.height);

function drawSoon() {
  if (willDraw) return;
  willDraw = true;
  requestAnimationFrame(() => { willDraw = false; draw(); });
}

function showValues() {
  const shown = shownLayer();
  if (!shown || !cursor || cursor.x >= shown.width || cursor.y >= shown.height) {
    element("values").textContent = "";
    return;
  }
  const pixel = pixelFor(shown, cursor.x, cursor.y);
  const mixed = mixes(shown) && Object.fromEntries(mixer.valueAt(pixel).map((value, c) => ["RGB"[c], value]));
  const values = shown.channels.map(channel => {
    const value = mixed?.[channel.name] ?? valueAt(channel, pixel);
    return `${channel.name} ${channel.type === "uint" ? value : value.toPrecision(4)}`;
  });
  element("values").textContent = `(${cursor.x}, ${cursor.y})  ${values.join("  ")}`;
}

function showState() {
  element("error").hidden = state.error === "";
  if (element("error").textContent !== state.error) element("error").textContent = state.error;
  const chooser = element("layer");
  if (state.layers.length && state.layers.join() !== [...chooser.options].map(o => o.value).join()) {
    const chosen = state.layers.includes(chooser.value) ? chooser.value : "beauty";
    chooser.replaceChildren(...state.layers.map(name => new Option(name, name, false, name === chosen)));
  }
  const samples = `${Number(state.samples.toFixed(1))} of ${state.wanted_samples} samples`;
  const memory = `${(state.memory_bytes / 2 ** 20).toFixed(0)} MiB`;
  const what = state.done ? `done in ${state.render_s.toFixed(1)} s` : state.error ? "waiting for an edit" : state.stage;
  element("status").textContent = `${state.width} × ${state.height} · ${what} · ${samples} · ${memory}`;
  element("progress").hidden = state.done;
  element("progress").value = state.progress;
  if (state.camera.note !== told) view.tell(told = state.camera.note);
  frames.update(state);
  element("shared").textContent = state.pages > 1 ? `${state.pages} pages share one camera, region and frame` : "";
  element("dual").setAttribute("aria-pressed", state.dual);
  element("camera_text").disabled = element("camera_reset").disabled = !state.camera.moved;
  if (!region.from) {
    canvas.setBox(state.region);
    element("region_mode").setAttribute("aria-pressed", isOn("region_mode") && !state.region);
    element("region_mode").textContent = state.region ? "Clear region" : "Region";
  }
}

async function refresh() {
  state = await readState();
  const name = element("layer").value;
  let changed = await mixer.update(state);
  if (state.version && (!layer || layer.version !== state.version || layer.name !== name)) {
    const read = await readLayers([name]);
    if (read) {
      layer = Object.assign(read, {name});
      changed = true;
    }
  }
  if (changed) draw();
  book.update(state, layer);
  camera.update();
  why.update();
  lights.update();
  if (isOn("camera_mode")) await camera.findDepth();
  showState();
  document.body.dataset.version = layer ? layer.version : 0;
  document.body.dataset.done = state.done;
  document.body.dataset.depth = camera.depth?.edit;
  document.body.dataset.waits = camera.camera !== null;
}

async function follow() {
  try {
    await refresh();
  } catch (problem) {
    element("status").textContent = "no answer: has `pelage view` ended?";
  }
  setTimeout(follow, camera.camera || lights.moved.size ? kFastPoll_ms : kPoll_ms);
}

// The modes that take clicks: each before those that come after it.
const clickModes = ["region_mode", "why_mode", "camera_mode"];

function toggle(id, on = !isOn(id)) {
  element(id).setAttribute("aria-pressed", on);
  // A mode that begins ends those that would take its clicks.
  if (on) for (const other of clickModes.slice(0, Math.max(clickModes.indexOf(id), 0))) element(other).setAttribute("aria-pressed", false);
  element("camera_bar").hidden = !isOn("camera_mode");
  element("canvas").classList.toggle("camera", isOn("camera_mode"));
  element("lights").hidden = !isOn("lights_mode");
  if (lights.open !== isOn("lights_mode")) lights.show(isOn("lights_mode"));
}

element("layer").addEventListener("change", () => refresh().catch(() => {}));
element("exposure").addEventListener("input", event => {
  element("stops").textContent = Number(event.target.value).toFixed(1);
  drawSoon();
});
element("transform").addEventListener("change", draw);
element("fit").addEventListener("click", () => canvas.fit());
element("one").addEventListener("click", () => canvas.one());
element("keep").addEventListener("click", () => {
  kept = layer && {...layer, image: document.body.dataset.mixed === "true" ? copyOf(canvas.image) : undefined};
  element("before").disabled = !kept;
});
const compare = shows => { if (showsKept !== shows) { showsKept = shows; draw(); } };
element("before").addEventListener("pointerdown", () => compare(true));
addEventListener("pointerup", () => compare(false));

element("frame").addEventListener("input", () => book.stop(false));
for (const id of ["camera_mode", "lights_mode", "why_mode"]) element(id).addEventListener("click", () => toggle(id));
element("region_mode").addEventListener("click", () => state?.region ? region.clear() : toggle("region_mode"));
element("dual").addEventListener("click", () => command("preview.json", {dual: !isOn("dual")}).catch(problem => view.tell(problem.message)));
element("camera_reset").addEventListener("click", () => camera.reset());
element("camera_text").addEventListener("click", () => offerText("Camera of this view", "camera.json", {}));

const keys = {d: "dual", f: "fit", 1: "one", k: "keep", c: "camera_mode", l: "lights_mode", w: "why_mode", r: "region_mode", p: "play"};
addEventListener("keydown", event => {
  if (lights.open && !element("scene_text").open && lights.takesKey(event)) {
    event.preventDefault();
    return;
  }
  const isTyping = ["SELECT", "TEXTAREA", "INPUT"].includes(event.target.tagName) && event.target.type !== "range";
  if (isTyping || event.ctrlKey || event.metaKey || event.altKey || element("scene_text").open) return;
  if (event.key in keys) element(keys[event.key]).click();
  if (event.key === "b") compare(true);
  if (event.key === "," || event.key === ".") {
    book.stop();
    frames.step(event.key === "." ? 1 : -1);
  }
  if (event.key === "Escape" && !element("why").hidden) why.close();
  else if (event.key === "Escape" && (state?.region || region.last)) region.clear();
});
addEventListener("keyup", event => { if (event.key === "b") compare(false); });
follow();
