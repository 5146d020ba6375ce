// SPDX-License-Identifier: Apache-2.0
// Asks why the pixel under the mouse is what it is, and shows the answer.
import {readWhy} from "./server.js";
import {showWhy} from "./why_panel.js";

const element = id => document.getElementById(id);

export class WhyTool {
  // `view`: {state(), canvas}. `onClose`: called when the panel is closed.
  constructor(view, onClose) {
    this.view = view;
    this.onClose = onClose;
    this.asked = 0;       // count of questions
    this.answer = null;   // shown now
    this.edit = -1;       // of the picture that it explains
    this.done = false;    // whether this picture was finished
    element("why_close").addEventListener("click", () => this.close());
  }

  down(event) {
    const pixel = event.button === 0 && this.view.canvas.pixelAt(event.offsetX, event.offsetY);
    if (!pixel) return false;
    this.ask(pixel);
    return true;
  }
  move() {}
  up() {}

  async ask({x, y}) {
    const question = ++this.asked;
    element("why").hidden = false;
    element("why_message").textContent = `pixel ${x} ${y}: waiting for the answer…`;
    this.view.canvas.setMarks({pixel: {x, y}, outline: this.answer?.strand?.outline ?? []});
    const {edits, done} = this.view.state();
    let answer = null, message = "";
    try {
      answer = await readWhy(x, y);
    } catch (problem) {
      message = problem.message;
    }
    if (question !== this.asked) return;  // another question was asked, or the panel was closed
    this.answer = answer;
    this.edit = edits;
    this.done = done;
    element("why_message").textContent = message;
    showWhy(element("why_answer"), answer);
    this.view.canvas.setMarks({pixel: {x, y}, outline: answer?.strand?.outline ?? []});
    document.body.dataset.why = answer ? `${x} ${y}` : "";
  }

  // After each state of the server.
  update() {
    if (!this.answer) return;
    const {edits, done} = this.view.state();
    if (this.edit !== edits) element("why_message").textContent = "The scene has changed since. Click again.";
    else if (done && !this.done)
      element("why_message").textContent = `This was the picture with ${this.answer.samples} samples here. Click again for the finished one.`;
  }

  close() {
    ++this.asked;
    this.answer = null;
    element("why").hidden = true;
    this.view.canvas.setMarks(null);
    document.body.dataset.why = "";
    this.onClose();
  }
}
