// Trees over boxes in the light's plane, for queries of the shader: all triangles at a place, all silhouettes on a way. A
// node is two texels: its box (low u, low v, high u, high v); then the lowest depth below it, the next node if this one is
// left out, the first of its items, their number (0: an inner node, whose first child is the next node).

// boxes: for each item low u, low v, high u, high v, low depth. Returns {nodes: Float32Array, items: Float32Array}.
function treeOf(boxes) {
  const order = Array.from(boxes.keys()), nodes = [], items = [], mostItems = 4;
  const middle = (item, axis) => boxes[item][axis] + boxes[item][axis + 2];
  const build = (from, to) => {
    const at = nodes.length, box = [Infinity, Infinity, -Infinity, -Infinity, Infinity];
    const centres = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = from; i < to; ++i) {
      const b = boxes[order[i]];
      for (let k = 0; k < 2; ++k) {
        box[k] = Math.min(box[k], b[k]);
        box[k + 2] = Math.max(box[k + 2], b[k + 2]);
        centres[k] = Math.min(centres[k], middle(order[i], k));
        centres[k + 2] = Math.max(centres[k + 2], middle(order[i], k));
      }
      box[4] = Math.min(box[4], b[4]);
    }
    nodes.push({box, first: 0, count: 0, next: 0});
    if (to - from <= mostItems) {
      nodes[at].first = items.length;
      nodes[at].count = to - from;
      for (let i = from; i < to; ++i) items.push(order[i]);
    } else {
      const axis = centres[2] - centres[0] >= centres[3] - centres[1] ? 0 : 1;
      const sorted = order.slice(from, to).sort((p, q) => middle(p, axis) - middle(q, axis)), half = from + (to - from >> 1);
      for (let i = from; i < to; ++i) order[i] = sorted[i - from];
      // The part that is nearer to the light first: it ends most searches for the first hit.
      const nearest = (a, b) => {
        let least = Infinity;
        for (let i = a; i < b; ++i) least = Math.min(least, boxes[order[i]][4]);
        return least;
      };
      const parts = [[from, half], [half, to]];
      if (nearest(half, to) < nearest(from, half)) parts.reverse();
      for (const [a, b] of parts) build(a, b);
    }
    nodes[at].next = nodes.length;
  };
  if (boxes.length) build(0, boxes.length);
  const out = new Float32Array(8 * nodes.length);
  nodes.forEach((n, i) => out.set([...n.box.slice(0, 4), n.box[4], n.next, n.first, n.count], 8 * i));
  // Boxes are rounded outwards, so that rounding leaves nothing out.
  const outward = (x, way) => x + way * (Math.abs(x) * Math.pow(2, -22) + 1e-30);
  for (let i = 0; i < nodes.length; ++i) {
    for (let k = 0; k < 2; ++k) {
      out[8 * i + k] = outward(nodes[i].box[k], -1);
      out[8 * i + 2 + k] = outward(nodes[i].box[2 + k], 1);
    }
    out[8 * i + 4] = outward(nodes[i].box[4], -1);
  }
  return {nodes: out, count: nodes.length, items: Float32Array.from(items)};
}

// What the shader reads of the mesh as the light sees it: textures of RGBA floats by name (own_surface.glsl).
function surfaceTables(seen, adjacency, count) {
  const faces = new Float32Array(12 * count), boxes = [], members = [];
  for (let t = 0; t < count; ++t) {
    for (let i = 0; i < 3; ++i) faces.set(seen.corner(t, i), 12 * t + 4 * i);
    faces[12 * t + 3] = seen.turn[t] ? seen.gradient[2 * t] : 0;
    faces[12 * t + 7] = seen.turn[t] ? seen.gradient[2 * t + 1] : 0;
    faces[12 * t + 11] = seen.turn[t];
    if (!seen.turn[t] || adjacency.first[t] !== t) continue;
    const c = [0, 1, 2].map(i => seen.corner(t, i)), least = k => Math.min(c[0][k], c[1][k], c[2][k]);
    boxes.push([least(0), least(1), Math.max(c[0][0], c[1][0], c[2][0]), Math.max(c[0][1], c[1][1], c[2][1]), least(2)]);
    members.push(t);
  }
  const tree = treeOf(boxes), items = Float32Array.from(tree.items, item => members[item]);
  const edges = new Float32Array(4 * seen.silhouettes.length);
  const edgeTree = treeOf(seen.silhouettes.map(({a, b}) => [
    Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[0], b[0]), Math.max(a[1], b[1]), Math.min(a[2], b[2])
  ]));
  edgeTree.items.forEach((item, i) => {
    const {a, b} = seen.silhouettes[item];
    edges.set([a[0], a[1], b[0], b[1]], 4 * i);
  });
  return {
    faces, beyond: seen.beyond, face_nodes: tree.nodes, face_items: items, edges, edge_nodes: edgeTree.nodes,
    face_node_count: tree.count, edge_node_count: edgeTree.count
  };
}
