// The probe pass: the numbers that the lookup computes before it compares, read back from the GPU.
#include <algorithm>
#include <stdexcept>

#include "gl/lookup_parts.h"
#include "gl/renderer_impl.h"

namespace noonmark::gl {
namespace {

// The texture of texel indices: each texel holds its place in the image of LightFrame::map_size(), j * resolution + i.
Texture make_cube_index(int side) {
  Texture texture = make_texture(GL_R32UI, side, side, GL_TEXTURE_CUBE_MAP);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  std::vector<uint32_t> row(static_cast<size_t>(side));
  uint32_t next = 0;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < side; ++j) {
      for (uint32_t& texel : row) texel = next++;
      glTextureSubImage3D(texture.id(), 0, 0, j, face, side, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, row.data());
    }
  return texture;
}

// A picture is probed in bands of rows, so that what the device holds of the probe does not grow with it. This many pixels
// take 38 MB on the device, and a picture of 1280 x 720 is one band.
constexpr int most_probed_pixels = 1 << 20;

// Where the numbers of one target go: put(numbers, pixel), for the pixels of a band whose first one has index `first`.
template <class T, class Put>
void read_band(const Target& target, GLenum format, int rows, size_t first, std::vector<T>& band, const Put& put) {
  const size_t count = static_cast<size_t>(target.width) * static_cast<size_t>(rows);
  band.resize(count);
  glGetTextureSubImage(target.texture.id(), 0, 0, 0, 0, target.width, rows, 1, format, GL_FLOAT,
                       static_cast<GLsizei>(count * sizeof(T)), band.data());
  for (size_t i = 0; i < count; ++i) put(band[i], first + i);
}

}  // namespace

// Draws probe_scalars, probe_texels and probe_radius band by band: calls read(rows, first) while they hold `rows` rows of the
// picture, whose first pixel is number `first`.
template <class Read>
void Renderer::Impl::each_probed_band(const Technique& technique, const Read& read) {
  const LightFrame& frame = technique.frame;
  check_map_size(frame.tile_size(), frame.map_shape() == MapShape::cube);
  Program& program =
      programs.get({"shaders/screen.vert", "shaders/probe.frag"}, receiver_slots(programs, frame, technique.bias));
  set_receiver_uniforms(program, technique);
  const int width = position_image.width, height = position_image.height;
  const int band = std::clamp(most_probed_pixels / width, 1, height);
  require(probe_scalars, GL_RGBA32F, width, band);
  require(probe_texels, GL_RGBA32F, width, band);
  require(probe_radius, GL_R32F, width, band);
  for (int row = 0; row < height; row += band) {
    const int rows = std::min(band, height - row);
    draw_into({probe_scalars.texture.id(), probe_texels.texture.id(), probe_radius.texture.id()}, 0, width, rows);
    program.set("first_row", row);
    draw_screen(program);
    detach(3);
    read(rows, static_cast<size_t>(row) * static_cast<size_t>(width));
  }
}

Image<glm::vec2> Renderer::map_positions(const Technique& technique) {
  Impl& r = *impl_;
  r.context->make_current();
  if (technique.frame.map_shape() == MapShape::cube)
    throw std::logic_error("map_positions: a cube has no flat positions");
  Image<glm::vec2> positions(r.position_image.width, r.position_image.height);
  std::vector<glm::vec4> numbers;
  r.each_probed_band(technique, [&](int rows, size_t first) {
    read_band(r.probe_texels, GL_RGBA, rows, first, numbers, [&](glm::vec4 t, size_t i) { positions[i] = {t.x, t.y}; });
  });
  r.context->check("map_positions");
  return positions;
}

LookupProbe Renderer::probe(const Technique& technique, ProbeTaps taps) {
  Impl& r = *impl_;
  r.context->make_current();
  const LightFrame& frame = technique.frame;
  const bool cube = frame.map_shape() == MapShape::cube;
  const int width = r.position_image.width, height = r.position_image.height;

  LookupProbe probe;
  probe.pattern = technique.taps;
  probe.tap_reference = &technique.bias.reference();
  probe.plane_cap = technique.bias.plane_cap();
  const bool planes = !cube && probe.tap_reference->plane, by_view = probe.pattern.scaled_by_view;
  for (Image<float>* image : {&probe.reference, &probe.n_dot_l, &probe.bias_unit, &probe.tan_theta})
    *image = Image<float>(width, height);
  if (!cube) probe.map_texels = Image<glm::vec2>(width, height);
  if (planes) probe.gradient = Image<glm::vec2>(width, height);
  if (by_view) probe.radius = Image<float>(width, height);
  std::vector<glm::vec4> numbers;
  std::vector<float> radii;
  r.each_probed_band(technique, [&](int rows, size_t first) {
    read_band(r.probe_scalars, GL_RGBA, rows, first, numbers, [&](glm::vec4 s, size_t i) {
      probe.reference[i] = s.x;
      probe.n_dot_l[i] = s.y;
      probe.bias_unit[i] = s.z;
      probe.tan_theta[i] = s.w;
    });
    if (!cube)
      read_band(r.probe_texels, GL_RGBA, rows, first, numbers, [&](glm::vec4 t, size_t i) {
        probe.map_texels[i] = glm::vec2(t.x, t.y);
        if (planes) probe.gradient[i] = glm::vec2(t.z, t.w);
      });
    if (by_view)
      read_band(r.probe_radius, GL_RED, rows, first, radii, [&](float radius, size_t i) { probe.radius[i] = radius; });
  });
  if (cube) {
    probe.cube_resolution = frame.resolution;
    const int middle = probe.middle_tap();
    probe.cube_middle = Image<uint32_t>(width, height);
    probe.cube_middle.pixels = r.cube_texels(probe, technique, {0, height}, middle, middle + 1);
    if (taps == ProbeTaps::all) probe.cube_texel = r.cube_texels(probe, technique, {0, height}, 0, probe.taps());
  }
  r.context->check("probe");
  return probe;
}

MapChoice Renderer::choose_maps(const Technique& technique) {
  Impl& r = *impl_;
  r.context->make_current();
  if (!technique.cascade) return only_map;
  if (!r.position_image.texture) throw std::logic_error("load_receivers comes before choose_maps");
  Program& program =
      r.programs.get({"shaders/screen.vert", "shaders/choose_cascade.frag"}, choice_slots(r.programs, technique));
  set_choice_uniforms(program, technique);
  program.set_if_used("eye_m", r.eye_m);
  glBindTextureUnit(0, r.position_image.texture.id());
  const int width = r.position_image.width, height = r.position_image.height;
  Target target;
  r.require(target, GL_RGBA32F, width, height);
  r.draw_into({target.texture.id()}, 0, width, height);
  r.draw_screen(program);
  r.detach(1);
  const Image<glm::vec4> read = read_back<glm::vec4>(target, GL_RGBA, GL_FLOAT);
  r.context->check("choose_maps");
  MapChoice chosen{Image<uint8_t>(width, height, no_map), {}, Image<uint8_t>(width, height, 0)};
  if (technique.cascade->blend > 0) chosen.next = Image<float>(width, height, 0);
  for (size_t i = 0; i < read.size(); ++i) {
    if (!(read[i].x >= 0)) continue;
    chosen.of[i] = static_cast<uint8_t>(read[i].x);
    if (chosen.blends()) chosen.next[i] = read[i].y;
    chosen.seam[i] = read[i].z != 0;
  }
  return chosen;
}

void Renderer::probe_strip(LookupProbe& probe, const Technique& technique, PixelRange strip) {
  if (technique.frame.map_shape() == MapShape::flat) return;
  Impl& r = *impl_;
  const auto width = static_cast<size_t>(r.position_image.width);
  if (strip.first % width != 0 || strip.end % width != 0) throw std::logic_error("a strip is of whole rows");
  r.context->make_current();
  std::vector<uint32_t>().swap(probe.cube_texel);  // before the next one is made, because it is large
  probe.cube_texel = r.cube_texels(
      probe, technique, {static_cast<int>(strip.first / width), static_cast<int>(strip.end / width)}, 0, probe.taps());
  probe.cube_first = strip.first;
  r.context->check("probe");
}

void Renderer::forget_cube_index() {
  Impl& r = *impl_;
  r.context->make_current();
  if (!r.cube_index) return;
  r.cube_index_resolution = 0;
  r.cube_index = {};
  release_spares();
}

std::vector<uint32_t> Renderer::Impl::cube_texels(const LookupProbe& probe, const Technique& technique, Rows rows,
                                                  int tap_begin, int tap_end) {
  const LightFrame& frame = technique.frame;
  if (cube_index_resolution != frame.resolution) {
    cube_index_resolution = 0;
    cube_index = {};  // first, so that memory never holds both
    cube_index = make_cube_index(frame.resolution);
    check_memory("a cube map's index", frame.resolution, 6 * frame.resolution);
    cube_index_resolution = frame.resolution;
  }
  Program& program =
      programs.get({"shaders/screen.vert", "shaders/probe_cube.frag"}, receiver_slots(programs, frame, technique.bias));
  set_receiver_uniforms(program, technique);
  set_pattern(program, probe.pattern);
  program.set("tap_begin", tap_begin);
  program.set("tap_count", tap_end - tap_begin);
  const int width = position_image.width, height = position_image.height;
  const size_t row_texels = static_cast<size_t>(width) * static_cast<size_t>(tap_end - tap_begin);
  // The rows are done in groups of at most 16 MiB, so that the device need not hold all of them. OpenGL guarantees 128
  // MiB for a shader's buffer.
  const int most = static_cast<int>(std::clamp<size_t>((size_t{1} << 24) / (row_texels * sizeof(uint32_t)), 1,
                                                       static_cast<size_t>(rows.end - rows.begin)));
  const Buffer buffer = make_buffer(nullptr, row_texels * static_cast<size_t>(most) * sizeof(uint32_t));
  check_memory("the texels of a cube map's taps", width, most);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.id());
  glBindTextureUnit(3, cube_index.id());
  require(lit, GL_R32F, width, height);
  draw_into({lit.texture.id()}, 0, width, height);  // only its size is used: the shader writes to the buffer
  std::vector<uint32_t> texels(row_texels * static_cast<size_t>(rows.end - rows.begin));
  for (int first = rows.begin; first < rows.end; first += most) {
    const int count = std::min(most, rows.end - first);
    glViewport(0, first, width, count);
    program.set("first_pixel", first * width);
    draw_screen(program);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer.id(), 0,
                            static_cast<GLsizeiptr>(row_texels * static_cast<size_t>(count) * sizeof(uint32_t)),
                            texels.data() + row_texels * static_cast<size_t>(first - rows.begin));
  }
  detach(1);
  glBindTextureUnit(3, 0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
  return texels;
}

}  // namespace noonmark::gl
