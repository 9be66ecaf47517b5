// The scene's triangles: unpacked, and which of them share an edge (raytrace/adjacency.h).

// The 32-bit values that live_page.cpp packed.
async function unpackedWords(text) {
  if (!text) return new Uint32Array(0);
  const bytes = await noonmarkUnpack(text), count = bytes.length / 4, words = new Uint8Array(bytes.length);
  for (let i = 0; i < count; ++i)
    for (let k = 0; k < 4; ++k) words[4 * i + k] = bytes[k * count + i];
  return new Uint32Array(words.buffer);
}

async function unpackedMesh(data) {
  const positions = new Float32Array((await unpackedWords(data.positions)).buffer);
  const steps = await unpackedWords(data.triangles), triangles = new Uint32Array(steps.length);
  let last = 0;
  for (let i = 0; i < steps.length; ++i) {
    last = (last + ((steps[i] >>> 1) ^ -(steps[i] & 1))) >>> 0;
    triangles[i] = last;
  }
  return {positions, triangles, count: triangles.length / 3, unseen: await unpackedWords(data.unseen)};
}

// welded: for each corner a number; equal numbers mean exactly equal positions. first: the first triangle with the same
// corners and the same winding. across: for each edge 3t + e the other triangles that have it.
function adjacencyOf(mesh) {
  const {positions, triangles, count} = mesh, numbers = new Map(), number = new Uint32Array(positions.length / 3);
  for (let i = 0; i < number.length; ++i) {
    const key = [positions[3 * i] + 0, positions[3 * i + 1] + 0, positions[3 * i + 2] + 0].join();
    if (!numbers.has(key)) numbers.set(key, numbers.size);
    number[i] = numbers.get(key);
  }
  const welded = Uint32Array.from(triangles, v => number[v]), first = new Uint32Array(count), known = new Map();
  const edges = new Map(), across = Array.from({length: 3 * count}, () => []);
  for (let t = 0; t < count; ++t) {
    const [a, b, c] = welded.subarray(3 * t, 3 * t + 3), least = Math.min(a, b, c);
    const key = (a === least ? [a, b, c] : b === least ? [b, c, a] : [c, a, b]).join();
    if (!known.has(key)) known.set(key, t);
    first[t] = known.get(key);
    if (first[t] !== t) continue;
    for (let e = 0; e < 3; ++e) {
      const p = welded[3 * t + e], q = welded[3 * t + (e + 1) % 3], edge = Math.min(p, q) + ',' + Math.max(p, q);
      if (!edges.has(edge)) edges.set(edge, []);
      edges.get(edge).push(3 * t + e);
    }
  }
  for (const slots of edges.values())
    if (slots.length <= 64)
      for (const slot of slots)
        for (const other of slots)
          if (Math.floor(other / 3) !== Math.floor(slot / 3)) across[slot].push(Math.floor(other / 3));
  return {welded, first, across};
}

// The mesh as the light sees it (frame: light.js): corners relative to the frame's middle, the depth's gradient of each
// triangle, the triangles in which a sheet goes on over each edge, and the silhouettes, edges over which none does
// (raytrace/own_surface.cpp, raytrace/silhouettes.cpp).
function seenByLight(mesh, adjacency, frame) {
  const {positions, triangles, count} = mesh, {welded, first, across} = adjacency;
  const places = new Float64Array(positions.length);
  for (let i = 0; i < positions.length; i += 3)
    places.set(frame.place(positions[i], positions[i + 1], positions[i + 2]), i);
  const corner = (t, i) => places.subarray(3 * triangles[3 * t + i], 3 * triangles[3 * t + i] + 3);
  const side = (p, q, x) => (p[0] - x[0]) * (q[1] - x[1]) - (p[1] - x[1]) * (q[0] - x[0]);
  const gradient = new Float64Array(2 * count), turn = new Float64Array(count);
  for (let t = 0; t < count; ++t) {
    const a = corner(t, 0), b = corner(t, 1), c = corner(t, 2), e = minus(b, a), f = minus(c, a);
    const area = e[0] * f[1] - e[1] * f[0];
    turn[t] = Math.sign(area);
    gradient[2 * t] = (e[2] * f[1] - f[2] * e[1]) / area;
    gradient[2 * t + 1] = (f[2] * e[0] - e[2] * f[0]) / area;
    // Edge-on to the light: no ray meets it.
    if (!Number.isFinite(gradient[2 * t]) || !Number.isFinite(gradient[2 * t + 1])) turn[t] = 0;
  }
  const beyond = new Float32Array(12 * count).fill(-1), silhouettes = [];
  for (let t = 0; t < count; ++t) {
    if (first[t] !== t) continue;
    const sign = turn[t] < 0 ? -1 : 1;
    for (let e = 0; e < 3; ++e) {
      const begin = welded[3 * t + e], end = welded[3 * t + (e + 1) % 3], a = corner(t, e), b = corner(t, (e + 1) % 3);
      let found = 0;
      for (const candidate of across[3 * t + e]) {
        if (turn[candidate] === 0) continue;
        let apex = 0;
        for (let i = 0; i < 3; ++i) {
          const v = welded[3 * candidate + i];
          if (v !== begin && v !== end) apex = i;
        }
        if (sign * side(a, b, corner(candidate, apex)) < 0 && found < 4) beyond[12 * t + 4 * e + found++] = candidate;
      }
      if (!found) silhouettes.push({a, b, triangle: t});
    }
  }
  return {places, gradient, turn, beyond, silhouettes, corner};
}
