// The receivers: P and N of each pixel, from the triangle that it shows, in double, as scenes/receivers.cpp computes them.
function nearestInTriangle(p, a, b, c) {
  const ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const bp = minus(p, b), d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return add(a, times(d1 / (d1 - d3), ab));
  const cp = minus(p, c), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return add(a, times(d2 / (d2 - d6), ac));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return add(b, times((d4 - d3) / ((d4 - d3) + (d5 - d6)), minus(c, b)));
  return p;
}

// Where the ray of a pixel's centre begins, and its direction (scenes/camera_frame.cpp).
function pixelRay(camera, x, y, width, height) {
  const u = (2 * (x + 0.5) / width - 1) * camera.half_width, v = (1 - 2 * (y + 0.5) / height) * camera.half_height;
  const aside = add(times(u, camera.right), times(v, camera.up));
  return camera.perspective ? {origin: camera.eye, way: add(camera.forward, aside)} :
                              {origin: add(camera.eye, aside), way: camera.forward};
}

// The triangles that the pixels' centres show. drawn: as a rasteriser drew them, which moves corners to a grid of its own, so
// that at edges a neighbour's triangle may stand in a pixel. There the ray decides, in double, among those around it.
function exactPrimitives(mesh, camera, width, height, drawn, none) {
  const exact = Uint32Array.from(drawn), {positions, triangles} = mesh;
  const corner = (t, k) => {
    const v = triangles[3 * t + k];
    return [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
  };
  for (let y = 0, i = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, ++i) {
      const around = new Set();
      for (let dy = y > 0 ? -1 : 0; dy <= (y + 1 < height ? 1 : 0); ++dy)
        for (let dx = x > 0 ? -1 : 0; dx <= (x + 1 < width ? 1 : 0); ++dx) around.add(drawn[i + dy * width + dx]);
      if (around.size === 1) continue;
      const {origin, way} = pixelRay(camera, x, y, width, height);
      let nearest = Infinity, found = none;
      for (const t of around) {
        if (t === none) continue;
        const [a, b, c] = [0, 1, 2].map(k => minus(corner(t, k), origin));
        const sides = [dot(cross(a, b), way), dot(cross(b, c), way), dot(cross(c, a), way)];
        if (sides.some(s => s > 0) && sides.some(s => s < 0)) continue;
        const across = cross(minus(b, a), minus(c, a)), along = dot(across, a) / dot(across, way);
        if (along > 0 && along < nearest) {
          nearest = along;
          found = t;
        }
      }
      if (found !== none || around.has(none)) exact[i] = found;
    }
  }
  return exact;
}

// primitives: the triangle of each pixel, row 0 on top; `none` where there is none.
function receiversOf(mesh, camera, width, height, primitives, none) {
  const position = new Float32Array(4 * width * height), normal = new Float32Array(4 * width * height);
  const primitive = Uint32Array.from(primitives), {positions, triangles} = mesh, seen = new Map();
  const corner = v => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
  for (let y = 0, i = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, ++i) {
      const t = primitive[i];
      if (t === none) continue;
      if (!seen.has(t)) {
        const [a, b, c] = [0, 1, 2].map(k => corner(triangles[3 * t + k])), across = cross(minus(b, a), minus(c, a));
        const area = length(across);
        seen.set(t, {a, b, c, across, area, normal: times(1 / area, across).map(Math.fround)});
      }
      const s = seen.get(t);
      if (!(s.area > 0)) {
        primitive[i] = none;
        continue;
      }
      const {origin, way} = pixelRay(camera, x, y, width, height), slope = dot(s.across, way);
      let along = dot(s.across, minus(s.a, origin)) / slope;
      if (!(length(times(along, way)) < 0x4000000 * (length(minus(s.a, origin)) + Math.sqrt(s.area))))
        along = dot(minus(s.a, origin), way) / dot(way, way);
      let met = add(origin, times(along, way));
      met = minus(met, times(dot(minus(met, s.a), s.across) / (s.area * s.area), s.across));
      position.set(nearestInTriangle(met, s.a, s.b, s.c), 4 * i);
      position[4 * i + 3] = 1 + x;
      normal.set(slope > 0 ? times(-1, s.normal) : s.normal, 4 * i);
      normal[4 * i + 3] = y;
    }
  }
  return {position, normal, primitive};
}
