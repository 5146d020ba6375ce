// SPDX-License-Identifier: Apache-2.0
// A picture that can be zoomed and moved. A tool {down, move, up, wheel} may take the mouse instead.
export class PictureCanvas {
  // `toolOf(event)`: the tool that takes a gesture; null for none.
  constructor(canvas, onCursor, toolOf) {
    this.canvas = canvas;
    this.onCursor = onCursor;
    this.toolOf = toolOf;
    this.fitted = true;
    this.scale = 1;
    this.left = this.top = 0;
    this.box = null;
    this.marks = null;
    this.overlay = null;
    this.source = canvas.picture = document.createElement("canvas");
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener("wheel", event => this.wheel(event), {passive: false});
    canvas.addEventListener("pointerdown", event => this.down(event));
    canvas.addEventListener("pointermove", event => this.move(event));
    canvas.addEventListener("pointerup", () => this.up());
    canvas.addEventListener("pointercancel", () => this.up());
    canvas.addEventListener("pointerleave", () => this.onCursor(null));
    canvas.addEventListener("contextmenu", event => event.preventDefault());
  }

  show(image) {
    this.image = image;
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
    const tool = this.toolOf(event);
    if (tool?.wheel) tool.wheel(event);
    else this.zoom(2 ** (-event.deltaY / 250), event.offsetX, event.offsetY);
  }

  down(event) {
    const tool = this.toolOf(event);
    this.tool = tool?.down(event) ? tool : null;
    this.drag = this.tool ? null : {x: event.offsetX, y: event.offsetY};
    this.canvas.setPointerCapture?.(event.pointerId);
  }

  up() {
    this.tool?.up();
    this.tool = this.drag = null;
  }

  move(event) {
    this.tool?.move(event);
    if (this.drag) {
      this.left += event.offsetX - this.drag.x;
      this.top += event.offsetY - this.drag.y;
      this.drag = {x: event.offsetX, y: event.offsetY};
      this.fitted = false;
      this.draw();
    }
    this.onCursor(this.pixelAt(event.offsetX, event.offsetY));
  }

  toPicture(x, y) { return {x: (x - this.left) / this.scale, y: (y - this.top) / this.scale}; }

  toScreen(x, y) { return {x: this.left + x * this.scale, y: this.top + y * this.scale}; }

  // Height of the whole picture in pixels of the screen.
  shownHeight() { return this.source.height * this.scale; }

  pixelAt(x, y) {
    const place = this.toPicture(x, y), column = Math.floor(place.x), row = Math.floor(place.y);
    const inside = column >= 0 && row >= 0 && column < this.source.width && row < this.source.height;
    return inside ? {x: column, y: row} : null;
  }

  // Frames the pixels [x0, y0, x1, y1]; null for none.
  setBox(box) {
    if (JSON.stringify(box) === JSON.stringify(this.box)) return;
    this.box = box;
    this.draw();
  }

  // Marks a pixel {x, y}, and draws a line through the points [x, y] of `outline`; null for neither.
  setMarks(marks) {
    this.marks = marks;
    this.draw();
  }

  // Draws over the picture: overlay(context, place, ratio), where place([x, y]) is the place of a point of the picture.
  setOverlay(overlay) {
    this.overlay = overlay;
    this.draw();
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
    if (this.box) this.drawBox(context, ratio);
    if (this.marks) this.drawMarks(context, ratio);
    const s = this.scale * ratio;
    this.overlay?.(context, ([x, y]) => [this.left * ratio + x * s, this.top * ratio + y * s], ratio);
  }

  drawBox(context, ratio) {
    const [x0, y0, x1, y1] = this.box, s = this.scale * ratio;
    context.lineWidth = Math.round(1.5 * ratio);
    context.setLineDash([6 * ratio, 4 * ratio]);
    context.strokeStyle = "#ffb454";
    context.strokeRect(this.left * ratio + x0 * s, this.top * ratio + y0 * s, (x1 - x0) * s, (y1 - y0) * s);
    context.setLineDash([]);
  }

  drawMarks(context, ratio) {
    const {pixel, outline} = this.marks, s = this.scale * ratio;
    const place = ([x, y]) => [this.left * ratio + x * s, this.top * ratio + y * s];
    const line = new Path2D();
    outline.forEach((point, i) => i ? line.lineTo(...place(point)) : line.moveTo(...place(point)));
    if (outline.length) line.arc(...place(outline.at(-1)), 0.01, 0, 1);
    const square = new Path2D(), [x, y] = place([pixel.x, pixel.y]), side = Math.max(s, 5 * ratio);
    square.rect(x + (s - side) / 2, y + (s - side) / 2, side, side);
    const root = new Path2D();
    if (outline.length) root.arc(...place(outline[0]), 3 * ratio, 0, 2 * Math.PI);
    context.lineJoin = context.lineCap = "round";
    for (const [color, more] of [["#000c", 2.5], ["#ffb454", 0]]) {
      context.strokeStyle = context.fillStyle = color;
      context.lineWidth = (1.5 + more) * ratio;
      context.stroke(line);
      context.stroke(root);
      context.fill(root);
      context.strokeStyle = more ? color : "#fff";
      context.stroke(square);
    }
  }
}
