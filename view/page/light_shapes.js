// SPDX-License-Identifier: Apache-2.0
// Where lights and magnets are in the picture: their outlines, and the handles that the mouse drags. A light is
// {name, type, block, values}; `block` is "lights" or "magnets".
import {add, cross, distance, dot, forward, length, rotate, unit} from "./camera.js";

const kSides = 40;  // of a polygon that stands for a circle

// The camera of the picture: {project(point): [x, y] in pixels or null behind the camera, unproject(x, y, depth), depthOf(point)}.
export function viewOf(camera, width, height) {
  const f = forward(camera), r = unit(cross(f, camera.up)), u = cross(r, f);
  const parallel = camera.height > 0;
  const scale = parallel ? height / camera.height : height / 2 / Math.tan(camera.fov * Math.PI / 360);
  const kNearest = 1e-3 * distance(camera);
  const depthOf = point => dot(add(point, camera.position, -1), f);
  return {
    f, r, u, depthOf,
    project(point) {
      const d = add(point, camera.position, -1), z = dot(d, f);
      if (z < kNearest) return null;
      const s = parallel ? scale : scale / z;
      return [width / 2 + dot(d, r) * s, height / 2 - dot(d, u) * s];
    },
    unproject(x, y, depth) {
      const s = parallel ? scale : scale / depth;
      return add(add(add(camera.position, f, depth), r, (x - width / 2) / s), u, -(y - height / 2) / s);
    },
  };
}

// Axes of something that faces a point, as in the renderer: z towards the point, y near `up`.
export function aim(position, target, up = [0, 1, 0]) {
  const z = unit(add(target, position, -1));
  let x = cross(up, z);
  if (length(x) < 1e-6 * length(up)) x = cross(Math.abs(z[0]) < 0.5 ? [1, 0, 0] : [0, 1, 0], z);
  x = unit(x);
  return {x, y: cross(z, x), z};
}

const at = (axes, center, x, y) => add(add(center, axes.x, x), axes.y, y);

function circle(axes, center, radius) {
  return Array.from({length: kSides + 1}, (_, i) => {
    const angle = 2 * Math.PI * i / kSides;
    return at(axes, center, radius * Math.cos(angle), radius * Math.sin(angle));
  });
}

// Where the arrow of a sun begins: before the point that the camera looks at.
const sunTail = (values, camera) => add(camera.look_at, unit(values.direction), -0.4 * distance(camera));

// {lines: lists of points, aims: the same, drawn thinner, handles: [{key, point}]}; null for lights without a place.
export function shapeOf({type, values}, camera) {
  const {position, look_at} = values;
  if (type === "sun") {
    const tail = sunTail(values, camera);
    return {lines: [[tail, camera.look_at]], aims: [], handles: [{key: "direction", point: tail}]};
  }
  if (!position) return null;
  const facing = look_at && distance({position, look_at}) > 0 ? aim(position, look_at, values.up) : null;
  const axes = facing ?? aim(position, camera.position, camera.up);
  const handles = [{key: "position", point: position}];
  if (look_at) handles.push({key: "look_at", point: look_at});
  const aims = look_at ? [[position, look_at]] : [];
  if (type === "rectangle") {
    const [w, h] = values.size.map(v => v / 2);
    handles.push({key: "size", point: at(axes, position, w, h)});
    return {lines: [[[-w, -h], [w, -h], [w, h], [-w, h], [-w, -h]].map(([x, y]) => at(axes, position, x, y))], aims, handles};
  }
  handles.push({key: "radius", point: at(axes, position, values.radius[0], 0)});
  const lines = [circle(axes, position, values.radius[0])];
  if (type === "spot" && facing) {
    const reach = distance({position, look_at}), wide = reach * Math.tan(values.cone[0] * Math.PI / 360);
    const rim = circle(axes, look_at, wide);
    handles.push({key: "cone", point: rim[kSides / 4]});
    aims.push(rim, ...[0, 1, 2, 3].map(i => [position, rim[i * kSides / 4]]));
  }
  return {lines, aims, handles};
}

// The values of a light whose handle `key` was dragged to the place (x, y) of the picture. `light`: before the drag.
export function dragged(light, key, camera, view, x, y) {
  const {values} = light, center = values.position;
  const handle = shapeOf(light, camera).handles.find(other => other.key === key);
  const point = view.unproject(x, y, view.depthOf(handle.point));
  if (key === "position" || key === "look_at") return {[key]: point};
  if (key === "direction") return {direction: unit(add(camera.look_at, point, -1))};
  if (key === "radius") return {radius: [Math.max(distance({position: center, look_at: point}), 1e-5)]};
  if (key === "cone") {
    const across = distance({position: values.look_at, look_at: point});
    return {cone: [Math.min(Math.max(360 / Math.PI * Math.atan2(across, distance(values)), 0.1), 170)]};
  }
  // The corner of a rectangle: where the line of sight meets its plane.
  const axes = aim(center, values.look_at, values.up);
  const eye = camera.height > 0 ? add(point, view.f, -1) : camera.position, ray = unit(add(point, eye, -1));
  const along = dot(ray, axes.z);
  if (Math.abs(along) < 0.05) return {};
  const local = add(add(eye, ray, dot(add(center, eye, -1), axes.z) / along), center, -1);
  return {size: [axes.x, axes.y].map(axis => Math.max(2 * Math.abs(dot(local, axis)), 1e-5))};
}

// The values of a light that is turned about the point it shines at, or moved to another distance from it. Points shine in
// all directions, with a profile, too.
export function orbited({type, values}, camera, view, yaw, pitch, factor = 1) {
  const turn = v => rotate(rotate(v, view.r, pitch), unit(camera.up), yaw).map(x => x * factor);
  if (values.direction) return {direction: unit(turn(values.direction))};
  const pivot = type === "point" ? camera.look_at : values.look_at ?? camera.look_at;
  return {position: add(pivot, turn(add(values.position, pivot, -1)))};
}

// A length that is a quarter of the height of the picture at a depth, or less with wide lenses.
const quarterOf = (camera, depth) =>
  Math.min(0.2 * depth, 0.25 * (camera.height > 0 ? camera.height : 2 * depth * Math.tan(camera.fov * Math.PI / 360)));

// A place near `wanted` where no light is: `taken` are their places.
export function freePlace(wanted, taken, camera, view) {
  const step = 0.2 * quarterOf(camera, Math.max(view.depthOf(wanted), 0.01 * distance(camera)));
  const isTaken = place => taken.some(other => distance({position: place, look_at: other}) < 0.6 * step);
  let place = wanted;
  while (isTaken(place)) place = add(place, view.r, step);
  return place;
}

// The factor of the radiance with which a new light gives the point that the camera looks at an irradiance of pi, as a white sky.
function brightness(type, values, camera) {
  const d = distance({position: values.position ?? camera.position, look_at: camera.look_at}), radius = values.radius?.[0];
  const radiance = {
    rectangle: () => Math.PI * d * d / (values.size[0] * values.size[1]),
    disk: () => d * d / (radius * radius),
    sphere: () => d * d / (radius * radius),
    point: () => Math.PI * 4 * Math.PI * d * d / 100,  // their power is 100 W
    spot: () => Math.PI * 4 * Math.PI * d * d / 100,
    sun: () => 1 / Math.sin(0.53 * Math.PI / 360) ** 2,
  }[type]();
  return Number(radiance.toPrecision(2));
}

// A new light or magnet between the camera and the point that it looks at, and large enough to see.
export function newLight(type, block, taken, camera, view) {
  const far = distance(camera), size = quarterOf(camera, 0.6 * far);
  const wanted = add(add(add(camera.look_at, view.f, -0.4 * far), view.r, size), view.u, size);
  const position = freePlace(wanted, taken, camera, view), values = {};
  if (type === "sun") values.direction = unit(add(camera.look_at, position, -1));
  else values.position = position;
  if (["rectangle", "disk", "spot"].includes(type)) values.look_at = camera.look_at;
  if (type === "rectangle") values.size = [size, size];
  else if (type !== "sun") values.radius = [type === "point" || type === "spot" ? size / 8 : size / 2];
  if (block === "lights") values.intensity = [brightness(type, values, camera)];
  return values;
}
