// SPDX-License-Identifier: Apache-2.0
// A picture that can be zoomed and moved.
export class PictureCanvas {
  constructor(canvas, onCursor) {
    this.canvas = canvas;
    this.onCursor = onCursor;
    this.fitted = true;
    this.scale = 1;
    this.left = this.top = 0;
    this.source = document.createElement("canvas");
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener("wheel", event => this.wheel(event), {passive: false});
    canvas.addEventListener("pointerdown", event => this.drag = {x: event.offsetX, y: event.offsetY});
    canvas.addEventListener("pointermove", event => this.move(event));
    addEventListener("pointerup", () => this.drag = null);
    canvas.addEventListener("pointerleave", () => this.onCursor(null));
  }

  show(image) {
    if (this.source.width !== image.width || this.source.height !== image.height) {
      this.source.width = image.width;
      this.source.height = image.height;
    }
    this.source.getContext("2d").putImageData(image, 0, 0);
    this.draw();
  }

  fit() { this.fitted = true; this.draw(); }

  // One pixel of the picture for one of the screen, around the middle.
  one() {
    this.zoom(1 / (devicePixelRatio * this.scale), this.canvas.clientWidth / 2, this.canvas.clientHeight / 2);
  }

  zoom(factor, x, y) {
    const scale = Math.min(Math.max(this.scale * factor, 0.05), 64), applied = scale / this.scale;
    this.left = x - (x - this.left) * applied;
    this.top = y - (y - this.top) * applied;
    this.scale = scale;
    this.fitted = false;
    this.draw();
  }

  wheel(event) {
    event.preventDefault();
    this.zoom(2 ** (-event.deltaY / 250), event.offsetX, event.offsetY);
  }

  move(event) {
    if (this.drag) {
      this.left += event.offsetX - this.drag.x;
      this.top += event.offsetY - this.drag.y;
      this.drag = {x: event.offsetX, y: event.offsetY};
      this.fitted = false;
      this.draw();
    }
    this.onCursor(this.pixelAt(event.offsetX, event.offsetY));
  }

  pixelAt(x, y) {
    const column = Math.floor((x - this.left) / this.scale), row = Math.floor((y - this.top) / this.scale);
    const inside = column >= 0 && row >= 0 && column < this.source.width && row < this.source.height;
    return inside ? {x: column, y: row} : null;
  }

  draw() {
    const {canvas, source} = this, ratio = devicePixelRatio;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || !height) return;
    if (this.fitted) {
      this.scale = Math.min(width / source.width, height / source.height);
      this.left = (width - source.width * this.scale) / 2;
      this.top = (height - source.height * this.scale) / 2;
    }
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.imageSmoothingEnabled = this.scale < 1;
    context.drawImage(source, this.left * ratio, this.top * ratio, source.width * this.scale * ratio,
                      source.height * this.scale * ratio);
  }
}
