// The data of shadow maps: making their textures, uploading and reading back.
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "base/error.h"
#include "gl/renderer_impl.h"

namespace noonmark::gl {
namespace {

// A cube of this side takes 400 MB, and so does its index texture (renderer_probe.cpp).
constexpr int largest_cube = 4096;

// Maps are uploaded and read in bands of at most 16 MiB, so that a large one is nowhere held a second time.
int rows_of_band(glm::ivec2 size) { return std::clamp((1 << 22) / size.x, 1, size.y); }

void require_size(glm::ivec2 size, const MapSettings& settings, bool cube) {
  const int faces = cube ? 6 : 1;
  const int most = cube ? faces * size.x : settings.rows(), least = cube || settings.aspect ? most : 1;
  if (size.x == settings.resolution && least <= size.y && size.y <= most) return;
  throw Error(ErrorKind::defect, fmt::format("upload_map: the image is {} x {}, the settings ask for {} face(s) of {} "
                                             "texels",
                                             size.x, size.y, faces, settings.resolution));
}

// OpenGL may clamp values outside [0, 1]; then the map would not be the uploaded one. The place of such a value is looked
// for only if there is one: a search that stops is several times slower than a count.
void require_depths(std::span<const float> depths) {
  const auto outside = [](float d) { return !((d >= 0) & (d <= 1)); };
  int outsiders = 0;
  for (const float d : depths) outsiders |= outside(d);
  if (!outsiders) return;
  const auto first = std::find_if(depths.begin(), depths.end(), outside);
  throw Error(ErrorKind::defect,
              fmt::format("upload_map: depth {} at texel index {} is outside [0,1]", *first, first - depths.begin()));
}

// The depth of the texels that are not in the map's set. Of a whole map it says nothing.
float checked_elsewhere(const MapDepths& map) {
  require_depths(map.depth);
  const glm::ivec2 size = map.size();
  if (map.texels->count() == static_cast<size_t>(size.x) * static_cast<size_t>(size.y)) return 1;
  require_depths({&map.elsewhere, 1});
  return map.elsewhere;
}

}  // namespace

GLint gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return GL_REPEAT;
    case Wrap::clamp_to_edge:
      return GL_CLAMP_TO_EDGE;
    case Wrap::clamp_to_border:
      return GL_CLAMP_TO_BORDER;
  }
  throw std::logic_error("a wrap mode without an OpenGL mode");
}

void Renderer::Impl::check_map_size(glm::ivec2 size, bool cube) const {
  if (cube && size.x > largest_cube)
    throw Error(ErrorKind::usage,
                fmt::format("a point light's cube map of six faces of {0} x {0} texels takes too much memory; "
                            "map.resolution goes up to {1} for point lights",
                            size.x, largest_cube));
  if (std::min(size.x, size.y) < 1 || std::max(size.x, size.y) > info.max_map_resolution)
    throw Error(ErrorKind::usage,
                fmt::format("a shadow map of {} x {} texels cannot be made; map.resolution{} from 1 to "
                            "{} on this OpenGL device ({})",
                            size.x, size.y, size.x == size.y ? " goes" : " and the rows of map.aspect go",
                            info.max_map_resolution, info.renderer));
}

Texture Renderer::Impl::make_map_texture(GLenum format, glm::ivec3 size, bool cube, Wrap wrap) {
  check_map_size(glm::ivec2(size), cube);
  if (cube) keep_spares_of(glm::ivec2(0));
  Texture texture = cube ? make_texture(format, size.x, size.y, GL_TEXTURE_CUBE_MAP) : make_array(format, size);
  check_memory(size.z > 1 && !cube ? fmt::format("{} shadow maps", size.z).c_str() : "a shadow map", size.x, size.y);
  set_sampling(texture, cube, wrap);
  return texture;
}

std::unique_ptr<ShadowMap::Impl> Renderer::Impl::make_flat(const std::shared_ptr<SpareMaps>& ends_in, GLenum format,
                                                           std::span<const glm::ivec2> sizes, Wrap wrap) {
  auto made = std::make_unique<ShadowMap::Impl>(context, ends_in, wrap, sizes);
  for (TiledMaps& array : made->arrays) {
    keep_spares_of(glm::ivec2(array.size));
    const size_t large_before = large->count();
    std::optional<TiledMaps> spare = ends_in ? ends_in->take(format, array.size) : std::nullopt;
    if (spare) {
      set_sampling(spare->texture, false, wrap);
      array = std::move(*spare);
    } else {
      if (large->count() < large_before) release_deleted();
      array.texture = make_map_texture(format, array.size, false, wrap);
      array.format = format;
      array.known.resize(static_cast<size_t>(array.size.z));
    }
  }
  return made;
}

void Renderer::Impl::keep_spares_of(glm::ivec2 size) {
  const size_t large_before = large->count();
  uploaded->keep_only(size);
  drawn->keep_only(size);
  if (large->count() < large_before) release_deleted();
}

void Renderer::Impl::release_deleted() {
  // A draw without textures: what the driver has bound for the draw before is bound no longer.
  require(map_strip, GL_R32F, 1, 1);
  draw_into({map_strip.texture.id()}, 0, 1, 1);
  draw_screen(programs.get({"shaders/screen.vert", "shaders/depth.frag"}));
  detach(1);
  glFinish();
  context->check("release_deleted");
}

void Renderer::Impl::set_sampling(const Texture& map, bool cube, Wrap wrap) {
  // A direction always hits a cube. At an edge, rounding must not wrap to the other side of the face, so the mode is
  // clamp to edge.
  const GLint mode = gl_wrap(cube ? Wrap::clamp_to_edge : wrap);
  glTextureParameteri(map.id(), GL_TEXTURE_WRAP_S, mode);
  glTextureParameteri(map.id(), GL_TEXTURE_WRAP_T, mode);
  glTextureParameterfv(map.id(), GL_TEXTURE_BORDER_COLOR, lit_border);
  glTextureParameteri(map.id(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
}

void Renderer::Impl::upload_rows(GLuint texture, glm::ivec2 face_size, int first_layer, int faces,
                                 const std::function<void(int, float*)>& copy_row) {
  const int width = face_size.x, height = face_size.y, rows = rows_of_band(face_size);
  std::vector<float> band(static_cast<size_t>(width) * static_cast<size_t>(rows));
  for (int face = 0; face < faces; ++face)
    for (int first = 0; first < height; first += rows) {
      const int count = std::min(rows, height - first);
      for (int row = 0; row < count; ++row)
        copy_row(face * height + first + row, &band[static_cast<size_t>(row) * static_cast<size_t>(width)]);
      glTextureSubImage3D(texture, 0, 0, first, first_layer + face, width, count, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                          band.data());
    }
  context->check("upload_map");
}

ShadowMap Renderer::Impl::upload_cube(int side, const std::function<void(int, float*)>& copy_row) {
  Texture texture = make_map_texture(GL_DEPTH_COMPONENT32F, {side, side, 6}, true, Wrap::clamp_to_edge);
  upload_rows(texture.id(), glm::ivec2(side), 0, 6, copy_row);
  return ShadowMap(std::make_unique<ShadowMap::Impl>(context, std::move(texture), side));
}

ShadowMap Renderer::upload_map(const Image<float>& depth, const MapSettings& settings, MapShape shape) {
  Impl& r = *impl_;
  r.context->make_current();
  const bool cube = shape == MapShape::cube;
  require_size({depth.width, depth.height}, settings, cube);
  require_depths(depth.pixels);
  const auto copy_row = [&](int y, float* row) { std::copy_n(&depth.at(0, y), depth.width, row); };
  if (cube) return r.upload_cube(depth.width, copy_row);
  const glm::ivec2 size(depth.width, depth.height);
  auto made = r.make_flat(nullptr, GL_DEPTH_COMPONENT32F, {&size, 1}, settings.wrap);
  r.upload_rows(made->arrays[0].texture.id(), size, 0, 1, copy_row);
  return ShadowMap(std::move(made));
}

ShadowMap Renderer::upload_map(const MapDepths& map, const MapSettings& settings, MapShape shape) {
  Impl& r = *impl_;
  r.context->make_current();
  const bool cube = shape == MapShape::cube;
  require_size(map.size(), settings, cube);
  const glm::ivec2 size = map.size();
  const float elsewhere = checked_elsewhere(map);
  if (cube) return r.upload_cube(size.x, [&](int y, float* row) { map.copy_row(y, row); });
  auto made = r.make_flat(r.uploaded, GL_DEPTH_COMPONENT32F, {&size, 1}, settings.wrap);
  r.upload_tiles(map, elsewhere, made->arrays[0], 0);
  r.context->check("upload_map");
  return ShadowMap(std::move(made));
}

ShadowMap Renderer::upload_maps(std::span<const MapDepths* const> maps, std::span<const Technique> techniques) {
  Impl& r = *impl_;
  if (maps.size() != techniques.size() || maps.empty())
    throw std::logic_error(fmt::format("upload_maps: {} maps of {} techniques", maps.size(), techniques.size()));
  const MapSettings& first = techniques.front().settings.map;
  const MapShape shape = techniques.front().frame.map_shape();
  if (maps.size() == 1) return upload_map(*maps.front(), first, shape);
  r.context->make_current();
  std::vector<glm::ivec2> sizes;
  std::vector<float> elsewhere;
  for (size_t k = 0; k < maps.size(); ++k) {
    require_size(maps[k]->size(), techniques[k].settings.map, false);
    sizes.push_back(maps[k]->size());
    elsewhere.push_back(checked_elsewhere(*maps[k]));
  }
  auto made = r.make_flat(r.uploaded, GL_DEPTH_COMPONENT32F, sizes, first.wrap);
  for (size_t k = 0; k < maps.size(); ++k) {
    const int map = static_cast<int>(k);
    r.upload_tiles(*maps[k], elsewhere[k], made->array_of(map), made->layer_of(map));
  }
  r.context->check("upload_map");
  return ShadowMap(std::move(made));
}

void Renderer::release_deleted() {
  Impl& r = *impl_;
  r.context->make_current();
  r.release_deleted();
}

void Renderer::release_spares() {
  Impl& r = *impl_;
  r.context->make_current();
  r.keep_spares_of(glm::ivec2(0));
  r.release_deleted();
}

Image<float> Renderer::read_rows(const ShadowMap& map, int first_row, int count, int which) {
  Impl& r = *impl_;
  r.context->make_current();
  ShadowMap::Impl& m = *map.impl_;
  const int width = map.size(which).x, height = map.size(which).y;
  const int faces = m.faces(), band = rows_of_band(map.size(which));
  if (first_row < 0 || count < 0 || first_row + count > faces * height)
    throw Error(ErrorKind::defect,
                fmt::format("read_rows: {} rows from {} on of a map of {}", count, first_row, faces * height));
  r.require(r.map_strip, GL_R32F, width, band);
  Program& program = r.programs.get({"shaders/screen.vert", "shaders/read_map.frag"});
  Image<float> image(width, count);
  r.draw_into({r.map_strip.texture.id()}, 0, width, band);
  Texture view;  // the faces as flat maps with the same texels
  if (m.cube) view = make_view_of_faces(m.cube);
  for (int row = first_row; row < first_row + count;) {
    const int face = row / height, in_face = row % height;
    const int rows = std::min({band, height - in_face, first_row + count - row});
    glBindTextureUnit(2, view ? view.id() : m.array_of(which).texture.id());
    program.set("layer", view ? face : m.layer_of(which));
    program.set("first_row", in_face);
    r.draw_screen(program);
    const size_t texels = static_cast<size_t>(width) * static_cast<size_t>(rows);
    glGetTextureSubImage(r.map_strip.texture.id(), 0, 0, 0, 0, width, rows, 1, GL_RED, GL_FLOAT,
                         static_cast<GLsizei>(texels * sizeof(float)), &image.at(0, row - first_row));
    glBindTextureUnit(2, 0);
    row += rows;
  }
  r.detach(1);
  r.context->check("read_rows");
  return image;
}

Image<float> Renderer::read_map(const ShadowMap& map, int which) {
  return read_rows(map, 0, map.impl_->faces() * map.size(which).y, which);
}

MapDepths Renderer::read_map(const ShadowMap& map, const std::shared_ptr<const TexelSet>& texels, int which) {
  MapDepths found(texels, MapDepths::unknown);
  ShadowMap::Impl& m = *map.impl_;
  // A listed texel takes about as long as two of whole rows.
  if (!m.cube && 2 * texels->count() < map.texels(which)) {
    impl_->context->make_current();
    impl_->read_listed(m.array_of(which).texture.id(), m.layer_of(which), *texels, found.depth);
    return found;
  }
  const int band = rows_of_band(map.size(which));
  for (int first = 0; first < texels->size().y; first += band) {
    const Image<float> rows = read_rows(map, first, std::min(band, texels->size().y - first), which);
    for (int row = 0; row < rows.height; ++row)
      texels->each_in_row(first + row, [&](int x, size_t index) { found.depth[index] = rows.at(x, row); });
  }
  return found;
}

double map_bytes(double texels, bool kept, bool cube) {
  // A small one with the exact map and the tie map [12.6], the texture that probes a cube [4], a large one alone [4.3; with Mesa 25
  // 5.6]. The set of the texels that are asked for takes 2 bits of each.
  constexpr double per_kept_texel = 14, per_index_texel = 4, per_large_texel = 6;
  constexpr double per_band_texel = 12, most_bands = 60e6;
  const double each = kept ? per_kept_texel + (cube ? per_index_texel : 0) : per_large_texel;
  return texels * each + std::min(texels * per_band_texel, most_bands);
}

}  // namespace noonmark::gl
