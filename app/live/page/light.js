// The directional light and its map's frame, as technique/light_frame.cpp, technique/sun.cpp and
// technique/lights/directional.cpp make them.

// A right angle is exact, as in technique/sun.cpp.
function sineOfDeg(deg) {
  let reduced = deg - 360 * Math.round(deg / 360);
  if (Math.abs(reduced) > 90) reduced = Math.sign(reduced) * 180 - reduced;
  const radians = Math.PI / 180;
  if (Math.abs(reduced) <= 45) return Math.sin(reduced * radians);
  return Math.sign(reduced) * Math.cos((90 - Math.abs(reduced)) * radians);
}
const cosineOfDeg = deg => sineOfDeg(90 - Math.abs(deg));

// From the scene to the sun, unit. Azimuth 0 stands above +Z, 90 above +X.
function directionToSun(azimuth, elevation) {
  const level = cosineOfDeg(elevation);
  return [level * sineOfDeg(azimuth), sineOfDeg(elevation), level * cosineOfDeg(azimuth)];
}
function placeOfSun(direction) {
  const level = Math.hypot(direction[0], direction[2]), degrees = 180 / Math.PI;
  return {
    azimuth: level > 0 ? Math.atan2(direction[0], direction[2]) * degrees : 0,
    elevation: Math.atan2(direction[1], level) * degrees
  };
}

function uprightAxes(forward, hint) {
  let side = cross(forward, hint);
  if (!(length(side) > 1e-6 * length(hint))) side = cross(forward, [0, 0, -1]);
  if (!(length(side) > 1e-6)) side = cross(forward, [0, 1, 0]);
  const right = unit(side);
  return {right, up: cross(right, forward)};
}

// Position and target of the light when the sun stands at these angles, null: as the scene's light.
// given: live-data's "light".
function placedLight(given, azimuth, elevation) {
  const target = given.target || given.scene_target;
  let position = given.position || given.scene_position;
  if (azimuth !== null || elevation !== null) {
    const own = minus(given.scene_position, given.scene_target), distance = length(own), old = placeOfSun(own);
    const differs = (set, angle) => set !== null && !(Math.abs((set - angle) - 360 * Math.round((set - angle) / 360)) <= 1e-9);
    const moved = differs(azimuth, old.azimuth) || differs(elevation, old.elevation);
    const way = moved ? times(distance, directionToSun(azimuth === null ? old.azimuth : azimuth,
                                                       elevation === null ? old.elevation : elevation)) :
                        own;
    position = !moved && same(target, given.scene_target) ? given.scene_position : add(target, way);
  }
  return {position, target, scenesOwn: same(position, given.scene_position) && same(target, given.scene_target)};
}

// The frame of the light and its map. positions: Float32Array of the scene. map: live-data's "map". set: the state's
// resolution and extent (null: from the scene, or fitted). largest: live-data's "largest_m".
function lightFrame(light, map, set, positions, largest) {
  const direction = unit(minus(light.target, light.position)).map(Math.fround), forward = unit(direction);
  const {right, up} = uprightAxes(forward, [0, 1, 0]);
  const inLight = (x, y, z, origin) => {
    const d = [x - origin[0], y - origin[1], z - origin[2]];
    return [dot(d, right), dot(d, up), dot(d, forward)];
  };
  let reach = 0, near = Infinity, far = -Infinity;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    const p = inLight(positions[i], positions[i + 1], positions[i + 2], light.position);
    reach = Math.max(reach, Math.abs(p[0]), Math.abs(p[1]));
    near = Math.min(near, p[2]);
    far = Math.max(far, p[2]);
    for (let k = 0; k < 3; ++k) {
      low[k] = Math.min(low[k], p[k]);
      high[k] = Math.max(high[k], p[k]);
    }
  }
  const margin = 1 / 1024, depth = Math.max(far - near, reach * margin);
  const fitted = {extent_m: 2 * reach * (1 + margin), near_m: near - depth * margin, far_m: far + depth * margin};
  const volume = map.own && light.scenesOwn ? map.own : fitted, range = map.range_of_scene ? fitted : volume;
  const extent = (set.extent === null ? volume.extent_m : set.extent) * map.extent_scale;
  const texel = extent / set.resolution;
  const origin = add(light.position, add(times(map.shift[0] * texel, right), times(map.shift[1] * texel, up)));
  const middle = [0, 1, 2].map(k => (low[k] + high[k]) / 2);
  const size = length(minus(high, low));
  const rayError = farthest => Math.pow(2, -24) * (Math.sqrt(3) * farthest + 4 * size);
  let farthest = 0;
  for (let i = 0; i < positions.length; ++i) farthest = Math.max(farthest, Math.abs(positions[i]));
  return {
    forward, right, up, origin, position: light.position, extent, texel, resolution: set.resolution,
    near: map.near_m === null ? range.near_m : map.near_m, far: map.far_m === null ? range.far_m : map.far_m,
    fittedExtent: volume.extent_m * map.extent_scale,
    // The middle of the scene as the light sees it. The shader's places are relative to it, so that they are small.
    middle,
    // raytrace/light_view.h: how far a ray may pass beside its exact place, with these positions and in the program.
    rayError: rayError(farthest), programError: rayError(largest),
    // A point of the world, relative to the middle.
    place: (x, y, z) => minus(inLight(x, y, z, light.position), middle)
  };
}

// Column-major, as WebGL takes it: clip_from_world of an orthographic tile.
function clipFromWorld(frame) {
  const half = frame.extent / 2, range = frame.far - frame.near;
  const rows = [times(1 / half, frame.right), times(1 / half, frame.up), times(2 / range, frame.forward)];
  const offsets = [0, 0, -2 * frame.near / range - 1], matrix = new Float32Array(16);
  for (let row = 0; row < 3; ++row) {
    for (let column = 0; column < 3; ++column) matrix[4 * column + row] = rows[row][column];
    matrix[12 + row] = offsets[row] - dot(rows[row], frame.origin);
  }
  matrix[15] = 1;
  return matrix;
}

// The same for planes relative to the light: the inverse of the transposed matrix. Only its normals are read.
function clipOfPlanes(frame) {
  const half = frame.extent / 2, range = frame.far - frame.near, matrix = new Float32Array(16);
  const rows = [times(half, frame.right), times(half, frame.up), times(range / 2, frame.forward)];
  for (let row = 0; row < 3; ++row)
    for (let column = 0; column < 3; ++column) matrix[4 * column + row] = rows[row][column];
  matrix[15] = 1;
  return matrix;
}
