// The data of flat maps at some of their texels: uploaded by tiles, and where a tile has few of them drawn by a list; read back
// by a list. A large map has many more texels than a picture asks for, so that all of them would take most of the time of a
// small picture.
#include <algorithm>
#include <array>
#include <bit>

#include "gl/renderer_impl.h"

namespace noonmark::gl {
namespace {

constexpr int tile_side = TexelSet::side;

// A tile with more texels to write is uploaded as a whole. Measured with llvmpipe for pictures of 64 x 64 and 320 x 180 pixels and
// maps of 1024 to 8192 texels: 8 to 400 differ by less than a third, and 24 is the best or near it.
constexpr size_t most_drawn = 24;

// Texels that are read, or written, with one draw: rows of the list, and texels in a row. 1024 x 1024 of them take 16 MiB on both
// sides of OpenGL.
constexpr int list_side = 1024;
constexpr size_t most_listed = size_t{list_side} * list_side;

uint32_t place_in_list(glm::ivec2 texel) {
  return static_cast<uint32_t>(texel.x) | static_cast<uint32_t>(texel.y) << 16;
}

// Texels of a map by column (the low 16 bits) and row, and their depths.
struct TexelList {
  std::vector<uint32_t> places;
  std::vector<float> depths;

  // Texels of tile n: those of the map, and of `before` those that are not the map's, which get the depth `elsewhere`.
  void add_tile(const MapDepths& map, const TexelSet* before, float elsewhere, size_t n) {
    const TexelSet& texels = *map.texels;
    const glm::ivec2 corner = texels.origin(n);
    size_t index = texels.first(n);
    for (int row = 0; row < tile_side; ++row) {
      const uint64_t now = texels.bits(n, row), old = before ? before->bits(n, row) & ~now : 0;
      for (uint64_t bits = now; bits; bits &= bits - 1)
        add(corner + glm::ivec2(std::countr_zero(bits), row), map[index++]);
      for (uint64_t bits = old; bits; bits &= bits - 1)
        add(corner + glm::ivec2(std::countr_zero(bits), row), elsewhere);
    }
  }

 private:
  void add(glm::ivec2 texel, float depth) {
    places.push_back(place_in_list(texel));
    depths.push_back(depth);
  }
};

// The texels of tile n, in the image of a row of tiles whose first column is `left`.
void put_tile(const MapDepths& map, size_t n, int left, int width, std::vector<float>& image) {
  const TexelSet& texels = *map.texels;
  const auto column = static_cast<size_t>(texels.origin(n).x - left);
  size_t index = texels.first(n);
  for (int row = 0; row < tile_side; ++row) {
    const size_t first = static_cast<size_t>(row) * static_cast<size_t>(width) + column;
    for (uint64_t bits = texels.bits(n, row); bits; bits &= bits - 1, ++index)
      image[first + static_cast<size_t>(std::countr_zero(bits))] = map.depth[index];
  }
}

// Writes these tiles, neighbours in a row of tiles with one call.
void write_tiles(GLuint texture, int layer, const MapDepths& map, float elsewhere, const std::vector<uint8_t>& wanted) {
  const glm::ivec2 size = map.size();
  const size_t across = static_cast<size_t>((size.x + tile_side - 1) / tile_side);
  std::vector<float> image;
  for (size_t first = 0; first < wanted.size();) {
    const size_t end_of_row = (first / across + 1) * across;
    const auto is_wanted = [&](size_t n) { return n < end_of_row && wanted[n]; };
    size_t end = first;
    while (is_wanted(end)) ++end;
    if (end == first) {
      ++first;
      continue;
    }
    const glm::ivec2 corner = map.texels->origin(first);
    const int width = std::min(static_cast<int>(end - first) * tile_side, size.x - corner.x),
              height = std::min(tile_side, size.y - corner.y);
    image.assign(static_cast<size_t>(width) * static_cast<size_t>(height), elsewhere);
    for (size_t n = first; n < end; ++n)
      if (map.texels->count(n)) put_tile(map, n, corner.x, width, image);
    glTextureSubImage3D(texture, 0, corner.x, corner.y, layer, width, height, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                        image.data());
    first = end;
  }
}

}  // namespace

void Renderer::Impl::upload_tiles(const MapDepths& map, float elsewhere, TiledMaps& to, int layer) {
  const TexelSet& texels = *map.texels;
  TiledMaps::Known& known = to.known[static_cast<size_t>(layer)];
  if (known.elsewhere != elsewhere) {
    glClearTexSubImage(to.texture.id(), 0, 0, 0, layer, to.size.x, to.size.y, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                       &elsewhere);
    known.elsewhere = elsewhere;
    known.texels.reset();
  }
  const TexelSet* const before = known.texels == map.texels ? nullptr : known.texels.get();
  // Into large maps of several layers nothing is drawn: with llvmpipe an array of 3 x 6144 x 6144 texels then stayed in memory
  // beside the next one. Why is not known; one layer of 8192 x 8192 does not.
  const bool may_draw =
      to.size.z == 1 ||
      sizeof(float) * static_cast<size_t>(to.size.x) * static_cast<size_t>(to.size.y) <= SpareMaps::most_small_bytes;
  std::vector<uint8_t> whole(texels.tiles());
  TexelList list;
  for (size_t n = 0; n < texels.tiles(); ++n) {
    const size_t count = texels.count(n) + (before ? before->count(n) : 0);
    whole[n] = count > (may_draw ? most_drawn : 0);
    if (count > 0 && !whole[n]) list.add_tile(map, before, elsewhere, n);
  }
  write_tiles(to.texture.id(), layer, map, elsewhere, whole);
  if (!list.places.empty()) write_listed(to, layer, list.places, list.depths);
  known.texels = map.texels;
}

void Renderer::Impl::write_listed(const TiledMaps& to, int layer, std::span<const uint32_t> places,
                                  std::span<const float> depths) {
  require(listed_texels, GL_R32UI, list_side, list_side);
  require(listed_depths, GL_R32F, list_side, list_side);
  Program& program = programs.get({"shaders/write_texels.vert", "shaders/write_texels.frag"});
  program.set("map_size", glm::vec2(to.size));
  draw_into_layer(to.texture.id(), layer, glm::ivec2(to.size));
  glBindTextureUnit(6, listed_texels.texture.id());
  glBindTextureUnit(7, listed_depths.texture.id());
  glEnable(GL_DEPTH_TEST);  // without it no depth is written
  glDepthFunc(GL_ALWAYS);
  glUseProgram(program.id());
  glBindVertexArray(no_vertices.id());
  const auto upload = [](const Target& target, int y, int width, int rows, GLenum format, GLenum type,
                         const void* data) {
    glTextureSubImage2D(target.texture.id(), 0, 0, y, width, rows, format, type, data);
  };
  for (size_t first = 0; first < places.size(); first += most_listed) {
    const size_t count = std::min(most_listed, places.size() - first);
    const int rows = static_cast<int>(count / list_side), rest = static_cast<int>(count % list_side);
    for (const auto& [y, width, height] : {std::array{0, list_side, rows}, std::array{rows, rest, 1}}) {
      if (width == 0 || height == 0) continue;
      const size_t from = first + static_cast<size_t>(y) * list_side;
      upload(listed_texels, y, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, &places[from]);
      upload(listed_depths, y, width, height, GL_RED, GL_FLOAT, &depths[from]);
    }
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
  }
  glBindTextureUnit(7, 0);
  glBindTextureUnit(6, 0);
  detach(0);
}

void Renderer::Impl::read_listed(GLuint map, int layer, const TexelSet& texels, std::span<float> depth) {
  require(listed_texels, GL_R32UI, list_side, list_side);
  require(listed_depths, GL_R32F, list_side, list_side);
  Program& program = programs.get({"shaders/screen.vert", "shaders/read_texels.frag"});
  program.set("layer", layer);
  std::vector<uint32_t> list;
  list.reserve(std::min(texels.count(), most_listed));
  std::vector<float> found;
  size_t done = 0;
  const auto read = [&] {
    const size_t count = list.size();
    const int rows = static_cast<int>((count + list_side - 1) / list_side);
    list.resize(static_cast<size_t>(rows) * list_side);  // the rest of the last row reads texel (0, 0)
    found.resize(list.size());
    glTextureSubImage2D(listed_texels.texture.id(), 0, 0, 0, list_side, rows, GL_RED_INTEGER, GL_UNSIGNED_INT,
                        list.data());
    draw_into({listed_depths.texture.id()}, 0, list_side, rows);
    glBindTextureUnit(2, map);
    glBindTextureUnit(6, listed_texels.texture.id());
    draw_screen(program);
    glGetTextureSubImage(listed_depths.texture.id(), 0, 0, 0, 0, list_side, rows, 1, GL_RED, GL_FLOAT,
                         static_cast<GLsizei>(found.size() * sizeof(float)), found.data());
    std::copy_n(found.begin(), count, depth.begin() + static_cast<std::ptrdiff_t>(done));
    done += count;
    list.clear();
  };
  for (size_t n = 0; n < texels.tiles(); ++n) {
    if (!texels.count(n)) continue;
    const glm::ivec2 corner = texels.origin(n);
    for (int row = 0; row < tile_side; ++row)
      for (uint64_t bits = texels.bits(n, row); bits; bits &= bits - 1) {
        list.push_back(place_in_list(corner + glm::ivec2(std::countr_zero(bits), row)));
        if (list.size() == most_listed) read();
      }
  }
  if (!list.empty()) read();
  glBindTextureUnit(6, 0);
  glBindTextureUnit(2, 0);
  detach(1);
  context->check("read_map");
}

}  // namespace noonmark::gl
