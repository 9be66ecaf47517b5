// One measurement: the map is drawn, and each pixel's lookup is judged in the fragment shader.
const noPrimitive = 0xffffffff, tableWidth = 2048, formats = {
  '16': ['DEPTH_COMPONENT16', 'UNSIGNED_SHORT'],
  '24': ['DEPTH_COMPONENT24', 'UNSIGNED_INT'],
  '32f': ['DEPTH_COMPONENT32F', 'FLOAT']
};

class Meter {
  // shaders: {judge, map, map_boxes, mesh, screen} texts. Throws Error if the browser cannot do it.
  constructor(data, mesh, shaders) {
    this.data = data;
    this.mesh = mesh;
    this.adjacency = adjacencyOf(mesh);
    this.width = data.width;
    this.height = data.height;
    const gl = this.gl = document.createElement('canvas').getContext('webgl2', {antialias: false, depth: false});
    if (!gl) throw new Error('this browser has no WebGL 2');
    if (!gl.getExtension('EXT_color_buffer_float')) throw new Error('this WebGL cannot draw into float pictures');
    const head = '#version 300 es\nprecision highp float; precision highp sampler2D; precision highp sampler2DArray;\n';
    this.facesProgram = this.program(shaders.mesh, head + 'flat in float shown; out vec4 color; void main() { color = vec4(shown); }');
    this.mapProgram = this.program(shaders.map_boxes, shaders.map);
    this.readProgram = this.program(shaders.screen, head + `uniform sampler2DArray depths; uniform float side; out vec4 color;
void main() { color = vec4(textureLod(depths, vec3(gl_FragCoord.xy / side, 0.0), 0.0).r); }`);
    this.judgeProgram = this.program(shaders.screen, shaders.judge);
    this.loadMesh();
    this.takeView();
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error('a shader: ' + gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'position');
    gl.bindAttribLocation(program, 1, 'number');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error('a shader: ' + gl.getProgramInfoLog(program));
    return program;
  }

  // Sets a uniform if the program in use has it; kind: '1i', '1f', '2fv', '3fv' or 'm'.
  set(program, name, kind, value) {
    const gl = this.gl, at = gl.getUniformLocation(program, name);
    if (!at) return;
    if (kind === 'm') gl.uniformMatrix4fv(at, false, value);
    else gl['uniform' + kind](at, value);
  }

  texture(internal, width, height) {
    const gl = this.gl, made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl[internal], width, height);
    for (const name of ['TEXTURE_MIN_FILTER', 'TEXTURE_MAG_FILTER']) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.NEAREST);
    for (const name of ['TEXTURE_WRAP_S', 'TEXTURE_WRAP_T']) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.CLAMP_TO_EDGE);
    return made;
  }

  // The map: the one layer of an array, as the lookup's shader reads it.
  mapTexture(internal, side) {
    const gl = this.gl, made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, made);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl[internal], side, side, 1);
    for (const name of ['TEXTURE_MIN_FILTER', 'TEXTURE_MAG_FILTER']) gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl[name], gl.NEAREST);
    return made;
  }

  // A texture of RGBA floats, or of single ones; `old` is freed.
  table(old, values, channels) {
    const gl = this.gl;
    if (old) gl.deleteTexture(old);
    const rows = Math.max(1, Math.ceil(values.length / channels / tableWidth)), all = new Float32Array(rows * tableWidth * channels);
    all.set(values);
    const made = this.texture(channels === 4 ? 'RGBA32F' : 'R32F', tableWidth, rows);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, tableWidth, rows, channels === 4 ? gl.RGBA : gl.RED, gl.FLOAT, all);
    return made;
  }

  picture(values) {
    const gl = this.gl, made = this.texture('RGBA32F', this.width, this.height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, this.width, this.height, gl.RGBA, gl.FLOAT, values);
    return made;
  }

  // Three vertices for each triangle, with its number, so that a pixel can say which one it shows.
  loadMesh() {
    const gl = this.gl, {positions, triangles, count} = this.mesh, vertices = new Float32Array(12 * count);
    for (let i = 0; i < 3 * count; ++i) {
      vertices.set(positions.subarray(3 * triangles[i], 3 * triangles[i] + 3), 4 * i);
      vertices[4 * i + 3] = 1 + Math.floor(i / 3);
    }
    this.drawn = gl.createVertexArray();
    gl.bindVertexArray(this.drawn);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 16, 0);
    gl.vertexAttribPointer(1, 1, gl.FLOAT, false, 16, 12);
    // The camera sees only the front of single-sided triangles; the map holds them all.
    const seen = [], {unseen} = this.mesh;
    for (let t = 0; t < count; ++t)
      if (!unseen.length || !(unseen[t >> 5] >>> (t & 31) & 1)) seen.push(3 * t, 3 * t + 1, 3 * t + 2);
    this.seenCount = seen.length;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(seen), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.screen = gl.createVertexArray();
  }

  target(colours, depth, map = null) {
    const gl = this.gl, made = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, made);
    colours.forEach((c, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, c, 0));
    gl.drawBuffers(colours.length ? colours.map((_, i) => gl.COLOR_ATTACHMENT0 + i) : [gl.NONE]);
    if (depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    if (map) gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, map, 0, 0);
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) throw new Error('this WebGL cannot draw into the page\'s pictures');
    return made;
  }

  read(attachment, width, height) {
    const gl = this.gl, values = new Float32Array(4 * width * height);
    gl.readBuffer(gl.COLOR_ATTACHMENT0 + attachment);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
    return values;
  }

  takeView() {
    const gl = this.gl, {width, height} = this;
    this.target([this.texture('RGBA32F', width, height)], this.texture('DEPTH_COMPONENT32F', width, height));
    gl.viewport(0, 0, width, height);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.facesProgram);
    this.set(this.facesProgram, 'clip_from_world', 'm', new Float32Array(this.data.camera.clip));
    gl.bindVertexArray(this.drawn);
    gl.drawElements(gl.TRIANGLES, this.seenCount, gl.UNSIGNED_INT, 0);
    const seen = this.read(0, width, height), primitives = new Uint32Array(width * height);
    for (let y = 0; y < height; ++y)  // OpenGL's row 0 is the lowest
      for (let x = 0; x < width; ++x) {
        const face = seen[4 * ((height - 1 - y) * width + x)];
        primitives[y * width + x] = face ? face - 1 : noPrimitive;
      }
    const {mesh, data: {camera}} = this, exact = exactPrimitives(mesh, camera, width, height, primitives, noPrimitive);
    const receivers = this.receivers = receiversOf(mesh, camera, width, height, exact, noPrimitive);
    this.positionImage = this.picture(receivers.position);
    this.normalImage = this.picture(receivers.normal);
    this.answers = [0, 1, 2].map(() => this.texture('RGBA32F', width, height));
    this.judged = this.target(this.answers, null);
  }

  // What depends on the light's direction: the tables of the mesh, and P as the light sees it.
  turnLight(light, frame) {
    const key = [...light.position, ...light.target].join();
    if (key === this.lightKey) return;
    this.lightKey = key;
    const {mesh, adjacency, receivers} = this, old = this.tables || {};
    const tables = surfaceTables(seenByLight(mesh, adjacency, frame), adjacency, mesh.count);
    this.tables = {face_node_count: tables.face_node_count, edge_node_count: tables.edge_node_count};
    for (const name of ['faces', 'beyond', 'face_nodes', 'edges', 'edge_nodes'])
      this.tables[name] = this.table(old[name], tables[name], 4);
    this.tables.face_items = this.table(old.face_items, tables.face_items, 1);
    const places = new Float32Array(receivers.position.length), {position, primitive} = receivers;
    for (let i = 0; i < primitive.length; ++i) {
      places[4 * i + 3] = -1;
      if (primitive[i] === noPrimitive) continue;
      places.set(frame.place(position[4 * i], position[4 * i + 1], position[4 * i + 2]), 4 * i);
      places[4 * i + 3] = adjacency.first[primitive[i]];
    }
    if (this.placeImage) this.gl.deleteTexture(this.placeImage);
    this.placeImage = this.picture(places);
  }

  drawMap(frame, format) {
    const gl = this.gl;
    if (frame.resolution > gl.getParameter(gl.MAX_TEXTURE_SIZE))
      throw new Error(`map.resolution = ${frame.resolution}: this WebGL's maps have at most ${gl.getParameter(gl.MAX_TEXTURE_SIZE)} texels on a side`);
    const key = [format, frame.resolution].join();
    if (key !== this.mapKey) {
      if (this.map) {
        gl.deleteTexture(this.map);
        gl.deleteFramebuffer(this.mapTarget);
      }
      this.map = this.mapTexture(formats[format][0], frame.resolution);
      this.mapTarget = this.target([], null, this.map);
      this.mapKey = key;
    }
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.map);
    const wrap = this.data.map.wrap === 0 ? gl.REPEAT : gl.CLAMP_TO_EDGE;
    for (const name of ['TEXTURE_WRAP_S', 'TEXTURE_WRAP_T']) gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl[name], wrap);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, null);  // it is drawn into
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.mapTarget);
    gl.viewport(0, 0, frame.resolution, frame.resolution);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.mapProgram);
    this.set(this.mapProgram, 'resolution', '1i', frame.resolution);
    this.setPlaces(this.mapProgram, frame);
    gl.bindTexture(gl.TEXTURE_2D, this.tables.faces);
    this.set(this.mapProgram, 'faces', '1i', 0);
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.mesh.count);
  }

  // Where the texels lie, and what window depth means, relative to the frame's middle.
  setPlaces(program, frame) {
    const corner = minus(frame.origin, frame.position);
    this.set(program, 'light_texel_m', '1f', frame.texel);
    this.set(program, 'first_texel_m', '2fv', [
      dot(corner, frame.right) - frame.middle[0] - frame.extent / 2, dot(corner, frame.up) - frame.middle[1] - frame.extent / 2
    ]);
    this.set(program, 'near_depth', '1f', frame.near - frame.middle[2]);
    this.set(program, 'depth_range', '1f', frame.far - frame.near);
  }

  judge(frame, numbers) {
    const gl = this.gl, {data, width, height} = this, program = this.judgeProgram, side = numbers.filterSize;
    const perUnit = [1, 1 / (frame.far - frame.near), frame.texel / (frame.far - frame.near)][data.bias.unit];
    gl.useProgram(program);
    const matrix = clipFromWorld(frame), set = (name, kind, value) => this.set(program, name, kind, value);
    set('clip_from_world', 'm', matrix);
    set('clip_from_world_planes', 'm', clipOfPlanes(frame));
    set('light_position', '3fv', frame.origin);
    set('bias_unit', '1i', data.bias.unit);
    set('light_bias_unit', '1f', perUnit);
    set('light_far_m', '1f', frame.far);
    set('map_size', '2fv', [frame.resolution, frame.resolution]);
    set('snapped_step', '1f', 0);
    set('direction_to_light', '3fv', times(-1, frame.forward));
    set('light_right', '3fv', frame.right);
    set('light_up', '3fv', frame.up);
    set('eye_m', '3fv', data.camera.eye);
    set('bias_plane_cap', '1f', data.bias.plane_cap);
    for (const part of data.bias.parts) {
      set('bias_' + part.name, '1f', part.name in numbers.bias ? numbers.bias[part.name] : part.amount);
      set(`bias_${part.name}_floor`, '1f', part.floor);
      set(`bias_${part.name}_cap`, '1f', part.cap);
    }
    set('wrap', '1i', data.map.wrap);
    set('lit_beyond_far', '1i', data.map.lit_beyond_far ? 1 : 0);
    set('ray_error_m', '1f', frame.rayError);
    set('program_error_m', '1f', frame.programError);
    this.setPlaces(program, frame);
    const step = Math.fround(Number(data.state['filter.step_texels'])), offsets = [];
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x) offsets.push(step * (x - (side >> 1)), step * (y - (side >> 1)), 0, 0);
    this.offsets = this.table(this.offsets, offsets, 4);
    set('taps', '1i', side * side);
    set('face_node_count', '1i', this.tables.face_node_count);
    set('edge_node_count', '1i', this.tables.edge_node_count);
    const images = {
      position_image: this.positionImage, normal_image: this.normalImage, place_image: this.placeImage, shadow_map: this.map,
      offsets: this.offsets
    };
    for (const name of ['faces', 'beyond', 'face_nodes', 'face_items', 'edges', 'edge_nodes']) images[name] = this.tables[name];
    Object.entries(images).forEach(([name, image], i) => {
      gl.activeTexture(gl.TEXTURE0 + i);
      gl.bindTexture(image === this.map ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, image);
      set(name, '1i', i);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.judged);
    gl.viewport(0, 0, width, height);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.screen);
    // In strips: a browser ends a draw call that takes seconds.
    const rows = Math.max(1, Math.floor((1 << 20) / (width * side * side)));
    gl.enable(gl.SCISSOR_TEST);
    for (let y = 0; y < height; y += rows) {
      gl.scissor(0, y, width, rows);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
    gl.disable(gl.SCISSOR_TEST);
    const [rungs, causes, others] = [0, 1, 2].map(i => this.read(i, width, height));
    return {taps: side * side, rungs, causes, others};
  }

  // The map as a square picture of depths, row 0 on top.
  mapPicture(side) {
    const gl = this.gl;
    if (!this.small) this.small = this.target([this.texture('RGBA32F', side, side)], null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.small);
    gl.viewport(0, 0, side, side);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(this.readProgram);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.map);
    this.set(this.readProgram, 'depths', '1i', 0);
    this.set(this.readProgram, 'side', '1f', side);
    gl.bindVertexArray(this.screen);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const values = this.read(0, side, side), depths = new Float32Array(side * side);
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x) depths[y * side + x] = values[4 * ((side - 1 - y) * side + x)];
    return depths;
  }

  // The answers of every pixel, the map's frame, and the metrics of compare/results/metrics.cpp.
  measure(state) {
    const numbers = checkedState(state), light = placedLight(this.data.light, numbers.azimuth, numbers.elevation);
    const frame = lightFrame(light, this.data.map, numbers, this.mesh.positions, this.data.largest_m);
    if (!(frame.near < frame.far)) throw new Error('the map\'s near plane is not before its far plane');
    this.turnLight(light, frame);
    this.drawMap(frame, numbers.format);
    const answers = this.judge(frame, numbers);
    return {answers, frame, light, metrics: metricsOf(answers)};
  }
}

// Fractions of the receivers that face the light, the ambiguous ones among them.
function metricsOf({taps, rungs, causes, others}) {
  const sum = {
    error: 0, filter: 0, displacement: 0, aliasing_dark: 0, aliasing_light: 0, acne: 0, peter_panning: 0, coverage_dark: 0,
    coverage_light: 0, precision: 0, lit: 0, outside: 0
  };
  let facing = 0, ambiguous = 0;
  for (let i = 0; i < rungs.length; i += 4) {
    const flags = rungs[i];
    if (!flags) continue;
    ++facing;
    if (flags & 8) ++ambiguous;
    const truth = flags & 2 ? taps : 0;
    sum.lit += truth;
    sum.outside += flags & 4 ? taps : 0;
    sum.error += Math.abs(rungs[i + 3] - truth);
    sum.filter += Math.abs(rungs[i + 1] - truth);
    sum.displacement += Math.abs(others[i + 2] - rungs[i + 1]);
    sum.precision += Math.abs(rungs[i + 3] - rungs[i + 2]);
    sum.acne += causes[i];
    sum.peter_panning += causes[i + 1];
    sum.aliasing_dark += causes[i + 2];
    sum.aliasing_light += causes[i + 3];
    sum.coverage_dark += others[i];
    sum.coverage_light += others[i + 1];
  }
  const metrics = {};
  for (const name in sum) metrics[name] = sum[name] / (facing * taps);
  metrics.facing = facing;
  metrics.ambiguous = ambiguous / facing;
  metrics.aliasing = metrics.aliasing_dark + metrics.aliasing_light;
  metrics.coverage = metrics.coverage_dark + metrics.coverage_light;
  return metrics;
}
