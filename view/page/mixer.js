// SPDX-License-Identifier: Apache-2.0
// The panel of lights, and the picture that it mixes.
import {readLayers} from "./server.js";
import {LightMix, lightsOf} from "./light_mix.js";
import {LightPanel} from "./light_panel.js";
import {offerText} from "./scene_text.js";

const element = id => document.getElementById(id);

export class Mixer {
  // `onChange`: called when the mixed picture changes.
  constructor(onChange) {
    this.onChange = onChange;
    this.mix = new LightMix();
    this.lights = new Map();
    this.applied = null;  // edit of the picture whose changes were written into the scene
    this.panel = new LightPanel(element("light_list"), () => { this.showButtons(); onChange(); });
    element("light_reset").addEventListener("click", () => this.panel.reset(true));
    element("light_apply").addEventListener("click", () => this.apply());
  }

  get open() { return !element("lights").hidden; }

  // Whether the mix differs from the picture, and can be shown.
  get mixes() { return !this.panel.isNeutral() && this.mix.has(this.lights); }

  showButtons() {
    element("light_apply").disabled = Object.keys(this.panel.changes()).length === 0;
    element("light_reset").disabled = this.panel.isNeutral();
  }

  // After each state of the server. Returns whether there are new layers.
  async update(state) {
    this.lights = lightsOf(state.layers);
    if (!this.open && this.panel.isNeutral()) return false;
    this.panel.show(this.lights);
    this.showButtons();
    element("light_message").textContent =
      state.layers.length && !this.lights.size ? "The scene has no light layers: set image.light_layers to true." : "";
    let changed = false;
    const isCurrent = this.mix.layers?.version === state.version && this.mix.has(this.lights);
    const layers = this.lights.size && !isCurrent &&
                   await readLayers([...this.lights.values()].flat().map(part => part.layer));
    if (layers) {
      this.mix.setLayers(layers);
      changed = true;
    }
    // The picture with the new values may arrive before the answer that they were written.
    if (this.applied !== null && this.mix.layers.edit > this.applied) {
      this.applied = null;
      this.panel.reset(false);
      changed = true;
    }
    return changed;
  }

  paint(stops, film) { return this.mix.paint(this.lights, this.panel.settings, this.panel.moved, stops, film); }

  valueAt(pixel) { return this.mix.valueAt(this.lights, this.panel.settings, pixel); }

  apply() {
    const edit = this.mix.layers.edit;
    offerText("Lights of this mix", "lights.json", {edit, lights: this.panel.changes()}, () => this.applied = edit);
  }
}
