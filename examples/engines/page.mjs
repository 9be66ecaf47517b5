// What the pages of all adapters share: settings from the address, and pictures and frame.json to shoot.mjs.
const query = new URLSearchParams(location.search);
export const model = query.get("model"); // its address
export const settings = JSON.parse(query.get("settings")); // each by its name, checked; null is "not given" (settings.mjs)
export const { width, height } = settings;

// Ends the page with one message and no frame.
export function refuse(message) {
  throw Object.assign(Error(message), { refused: true });
}
// The direction of a light to be made, or null: then the file's first directional light, `found`, is the light.
export function direction_beside(found) {
  if (settings.light === "file" && settings.direction) refuse("light=file and direction are given, and a frame has one light. Leave one of them out.");
  if (settings.light === "file" && !found) refuse(`light=file: ${decodeURIComponent(model.slice("/model/".length))} has no directional light (KHR_lights_punctual). Give direction=x,y,z in place of it.`);
  return settings.direction ?? (found ? null : [-0.4, -0.8, -0.3]);
}

// Runs the text that `noonmark recommend` prints for the engine as it is, in a page that was drawn before. values: the variables that
// it reads, by their names.
export async function run_lines(file, values) {
  const typed = await (await fetch("/lines")).text();
  try {
    new Function(...Object.keys(values), typed)(...Object.values(values));
  } catch (error) {
    refuse(`lines=${file}: ${error.message}. Give the lines that noonmark recommend prints for this engine, without its name.`);
  }
}

// Prints a line on the terminal.
export const note = (line) => send("note", line);

function send(name, body) {
  return fetch("/save/" + name, { method: "POST", body });
}
// An NPY file of floats: rows x columns, or rows x columns x channels. Of a picture the top row comes first.
export async function save(name, floats, channels = 1, columns = width, rows = height) {
  const shape = channels === 1 ? `(${rows}, ${columns})` : `(${rows}, ${columns}, ${channels})`;
  let header = `{'descr': '<f4', 'fortran_order': False, 'shape': ${shape}, }`;
  header = header.padEnd(Math.ceil((header.length + 11) / 64) * 64 - 11) + "\n";
  const head = new Uint8Array(10 + header.length);
  head.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, header.length & 255, header.length >> 8]);
  head.set(new TextEncoder().encode(header), 10);
  await send(name, new Blob([head, floats]));
}
// Pixels as WebGL reads them, RGBA with the bottom row first: one or three of their channels, the top row first. Where
// `covered` (RGBA too) has alpha 0 there is no surface.
export function picked(rgba, channels, covered = rgba) {
  const picture = new Float32Array(width * height * channels.length);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const from = ((height - 1 - y) * width + x) * 4, to = (y * width + x) * channels.length;
      channels.forEach((c, i) => (picture[to + i] = covered[from + 3] === 0 ? NaN : rgba[from + c]));
    }
  return picture;
}
// The values of a square depth texture of WebGL 2, the bottom row first. Engines let none be read back, and theirs compare as they
// are sampled. The state of the context is another one afterwards, so this comes last.
export function depths_of(gl, texture, side) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, "void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0.0, 1.0); }"],
    [gl.FRAGMENT_SHADER, "precision highp float; uniform highp sampler2D map; out vec4 depth; void main() { depth = vec4(texelFetch(map, ivec2(gl_FragCoord.xy), 0).r); }"]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, "#version 300 es\n" + source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  const copy = gl.createTexture(), sampler = gl.createSampler(), pixels = new Float32Array(4 * side * side);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, copy);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, side, side);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, copy, 0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.samplerParameteri(sampler, name, gl.NEAREST);
  gl.bindSampler(0, sampler);
  for (const state of [gl.DEPTH_TEST, gl.CULL_FACE, gl.BLEND, gl.SCISSOR_TEST, gl.RASTERIZER_DISCARD]) gl.disable(state);
  gl.colorMask(true, true, true, true);
  gl.viewport(0, 0, side, side);
  gl.useProgram(program);
  gl.bindVertexArray(gl.createVertexArray());
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.FLOAT, pixels);
  return pixels.filter((_, i) => i % 4 === 0);
}
// What the engine made of its cascades, the nearest first, as laid.json beside the frame, which judge does not read. Of each:
// begin_m and end_m, the depths along the view where it is looked up; width_m and height_m of its map, depth_m between its near and
// far plane, resolution; what else the page knows.
export function cascades_of_engine(cascades) {
  const known = cascades.map((one) => ({ ...one, texel_m: one.width_m / one.resolution }));
  return send("laid.json", JSON.stringify({ cascades: known }, null, 1));
}
export async function done(frame) {
  await send("frame.json", JSON.stringify({ noonmark_frame: 1, scene: query.get("scene"), visibility: { file: "visibility.npy" }, positions: { file: "positions.npy" }, ...frame }, null, 1));
}
const ended = (error, otherwise) => (error?.refused ? send("refused", error.message) : send("failed", String(error?.stack ?? otherwise)));
window.addEventListener("error", (event) => ended(event.error, event.message));
window.addEventListener("unhandledrejection", (event) => ended(event.reason, event.reason));
