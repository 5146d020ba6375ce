// SPDX-License-Identifier: Apache-2.0
// A camera {position, look_at, up, fov, height} that turns about the point it looks at. All functions return a new camera.
export const add = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);
export const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = a => Math.hypot(...a);
export const unit = a => a.map(v => v / length(a));

// Rotates a vector about a unit axis (Rodrigues' formula).
export function rotate(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(v.map(x => x * c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

export const distance = camera => length(add(camera.look_at, camera.position, -1));
export const forward = camera => unit(add(camera.look_at, camera.position, -1));

// Looks at the point in the same direction at a distance along the axis.
export function aimAt(camera, depth) {
  return Number.isFinite(depth) && depth > 0
    ? {...camera, look_at: add(camera.position, forward(camera), depth)} : camera;
}

const kNearest = 0.02;  // radians between the axis and `up`

export function orbit(camera, yaw, pitch) {
  const up = unit(camera.up), f = forward(camera);
  const angle = Math.acos(Math.min(Math.max(dot(f, up), -1), 1));
  const turned = Math.min(Math.max(angle - pitch, kNearest), Math.PI - kNearest);
  const arm = add(camera.position, camera.look_at, -1), right = unit(cross(f, up));
  const tilted = rotate(arm, right, angle - turned);
  return {...camera, position: add(camera.look_at, rotate(tilted, up, yaw))};
}

// Moves by parts of the picture's height, at the distance of the point in the centre.
export function pan(camera, right, up) {
  const f = forward(camera), r = unit(cross(f, camera.up)), u = cross(r, f);
  const height = camera.height || 2 * distance(camera) * Math.tan(camera.fov * Math.PI / 360);
  const shift = add(r.map(v => v * right * height), u, up * height);
  return {...camera, position: add(camera.position, shift), look_at: add(camera.look_at, shift)};
}

export const dolly = (camera, factor) =>
  ({...camera, position: add(camera.look_at, add(camera.position, camera.look_at, -1), factor)});
