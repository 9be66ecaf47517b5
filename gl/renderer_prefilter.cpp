// Maps of moments: what a lookup reads that compares no depths (technique/lookups.h). Two passes of a blur over what each
// texel of the shadow map stores.
#include <fmt/format.h>

#include "base/error.h"
#include "gl/lookup_parts.h"
#include "gl/renderer_impl.h"
#include "technique/lookups.h"

namespace noonmark::gl {
namespace {

constexpr size_t widest_blur = 31;  // shaders/prefilter/blur.frag

GLenum texture_format(MomentFormat format, int channels) {
  switch (format) {
    case MomentFormat::f32:
      return channels == 1 ? GL_R32F : channels == 2 ? GL_RG32F : GL_RGBA32F;
    case MomentFormat::f16:
      return channels == 1 ? GL_R16F : channels == 2 ? GL_RG16F : GL_RGBA16F;
    case MomentFormat::u16:
      return channels == 1 ? GL_R16 : channels == 2 ? GL_RG16 : GL_RGBA16;
  }
  throw std::logic_error("a format of moments that OpenGL has no texture for");
}

// shaders/prefilter/blur.frag uses these numbers.
static_assert(static_cast<int>(Wrap::repeat) == 0 && static_cast<int>(Wrap::clamp_to_edge) == 1 &&
              static_cast<int>(Wrap::clamp_to_border) == 2);

glm::ivec3 size_of_level(glm::ivec3 size, int level) { return {size.x >> level, size.y >> level, size.z}; }

// The texels of the next level that hold a texel of the set.
TexelSet halved(const TexelSet& texels) {
  TexelSet made(texels.size() / 2);
  for (int y = 0; y < texels.size().y; ++y) texels.each_in_row(y, [&](int x, size_t) { made.add({x / 2, y / 2}); });
  made.close();
  return made;
}

void set_taps(Program& program, std::span<const SpreadBlur::Tap> taps) {
  for (size_t k = 0; k < taps.size(); ++k) {
    program.set(fmt::format("tap_texel[{}]", k).c_str(), taps[k].texel);
    program.set(fmt::format("tap_next[{}]", k).c_str(), taps[k].next);
  }
}

}  // namespace

const std::vector<MomentTextures>& Renderer::Impl::moments_of(const ShadowMap& map, const Technique& technique,
                                                              double* time_ms) {
  ShadowMap::Impl& m = *map.impl_;
  const MomentLookup& lookup = technique.moments.value();
  if (m.cube) throw Error(ErrorKind::defect, "a map of moments of a cube");
  const std::string key = lookup.key();
  if (!m.moments.empty() && m.moments.front().key == key && !time_ms) return m.moments;
  m.moments.clear();
  const GLenum format = texture_format(lookup.format(), lookup.kind().channels);
  // A blur that stores spreads reads the depths of the map themselves.
  const GLenum stored_format = lookup.spread() ? texture_format(MomentFormat::f32, lookup.kind().channels) : format;
  const std::span<const double> kernel = lookup.kernel();
  if (kernel.size() > widest_blur)
    throw std::logic_error("a blur of more texels than shaders/prefilter/blur.frag takes");
  const glm::vec4 border = lookup.stored(1.0f);
  const int level = lookup.level();
  for (const TiledMaps& array : m.arrays) {
    MomentTextures made{key, {}};
    for (int pass = 0; pass < level + 3; ++pass) {
      const glm::ivec3 size = size_of_level(array.size, std::min(pass, level));
      made.passes.push_back(make_array(pass == 0 ? stored_format : format, size));
      check_memory("a map of moments", size.x, size.y);
    }
    m.moments.push_back(std::move(made));
  }
  Program& store =
      programs.get({"shaders/screen.vert", "shaders/prefilter/store.frag"}, moment_slots(programs, technique));
  set_lookup_uniforms(store, technique);
  Program& halve = programs.get({"shaders/screen.vert", "shaders/prefilter/halve.frag"});
  const SpreadBlur* const spread = lookup.spread();
  Program& blur =
      spread ? programs.get({"shaders/screen.vert", "shaders/prefilter/spread.frag"}, moment_slots(programs, technique))
             : programs.get({"shaders/screen.vert", "shaders/prefilter/blur.frag"});
  if (spread) {
    set_lookup_uniforms(blur, technique);
    blur.set("taps", static_cast<int>(spread->along_u.size()));
  } else {
    blur.set("blur_size", static_cast<int>(kernel.size()));
    for (size_t k = 0; k < kernel.size(); ++k)
      blur.set(fmt::format("kernel[{}]", k).c_str(), static_cast<float>(kernel[k]));
  }
  const bool half_floats = lookup.format() == MomentFormat::f16;
  store.set("half_floats", half_floats && !spread);
  halve.set("half_floats", half_floats);
  blur.set("half_floats", half_floats);
  blur.set("wrap", static_cast<int>(m.wrap));
  blur.set("border", border);
  run(time_ms, [&] {
    for (size_t n = 0; n < m.arrays.size(); ++n)
      for (int layer = 0; layer < m.arrays[n].size.z; ++layer) {
        const std::vector<Texture>& passes = m.moments[n].passes;
        // Draws pass `pass` from the one before it.
        const auto draw = [&](int pass, Program& program) {
          draw_into_colour_layer(passes[static_cast<size_t>(pass)].id(), layer,
                                 glm::ivec2(size_of_level(m.arrays[n].size, std::min(pass, level))));
          glBindTextureUnit(2, pass == 0 ? m.arrays[n].texture.id() : passes[static_cast<size_t>(pass) - 1].id());
          program.set("layer", layer);
          draw_screen(program);
        };
        draw(0, store);
        for (int halved = 1; halved <= level; ++halved) draw(halved, halve);
        for (const bool second : {false, true}) {
          const bool along_v = second != (spread != nullptr);
          blur.set("along", along_v ? glm::ivec2(0, 1) : glm::ivec2(1, 0));
          if (spread) set_taps(blur, along_v ? spread->along_v : spread->along_u);
          draw(level + (second ? 2 : 1), blur);
        }
      }
  });
  detach(1);
  glBindTextureUnit(2, 0);
  for (const MomentTextures& made : m.moments) {
    const GLuint last = made.passes.back().id();
    glTextureParameteri(last, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(last, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(last, GL_TEXTURE_WRAP_S, gl_wrap(m.wrap));
    glTextureParameteri(last, GL_TEXTURE_WRAP_T, gl_wrap(m.wrap));
    glTextureParameterfv(last, GL_TEXTURE_BORDER_COLOR, &border.x);
  }
  context->check("the passes over a map of moments");
  return m.moments;
}

std::optional<double> Renderer::time_prefilter(const ShadowMap& map, const Technique& technique) {
  if (!technique.moments) return std::nullopt;
  impl_->context->make_current();
  double time_ms = 0;
  impl_->moments_of(map, technique, &time_ms);
  return time_ms;
}

MomentEvidence Renderer::read_moments(const ShadowMap& map, std::span<const Technique> techniques,
                                      const TexelSet& texels, size_t which) {
  Impl& r = *impl_;
  r.context->make_current();
  const Technique& technique = techniques[which];
  const ShadowMap::Impl::Place place = map.impl_->places[which];
  const MomentTextures& textures = r.moments_of(map, technique, nullptr)[place.array];
  constexpr int band = 256;  // rows that are read at a time
  std::vector<glm::vec4> rows;
  // The texels of a set in a pass, whose texture has the size of the set's image.
  const auto read = [&](size_t pass, const TexelSet& of) {
    const glm::ivec2 size = of.size();
    std::vector<glm::vec4> moments(of.count());
    for (int first = 0; first < size.y; first += band) {
      const int count = std::min(band, size.y - first);
      rows.resize(static_cast<size_t>(size.x) * static_cast<size_t>(count));
      glGetTextureSubImage(textures.passes[pass].id(), 0, 0, first, place.layer, size.x, count, 1, GL_RGBA, GL_FLOAT,
                           static_cast<GLsizei>(rows.size() * sizeof(glm::vec4)), rows.data());
      for (int row = 0; row < count; ++row)
        of.each_in_row(first + row, [&](int x, size_t index) {
          moments[index] = rows[static_cast<size_t>(row) * static_cast<size_t>(size.x) + static_cast<size_t>(x)];
        });
    }
    return moments;
  };
  MomentEvidence evidence;
  const auto level = static_cast<size_t>(technique.moments->level());
  for (size_t n = 0; n <= level; ++n) {
    TexelSet of = n == 0 ? texels : halved(evidence.levels.back().texels);
    std::vector<glm::vec4> moments = read(n, of);
    evidence.levels.push_back({std::move(of), std::move(moments)});
  }
  const TexelSet& blurred = evidence.levels.back().texels;
  evidence.blurred_once = read(level + 1, blurred);
  evidence.blurred = read(level + 2, blurred);

  Program& fetch =
      r.programs.get({"shaders/screen.vert", "shaders/fetch_moments.frag"}, lookup_slots(r.programs, technique));
  r.set_receiver_uniforms(fetch, technique);
  fetch.set("moments_layer", place.layer);
  glBindTextureUnit(3, textures.passes.back().id());
  const int width = r.position_image.width, height = r.position_image.height;
  r.require(r.fetched, GL_RGBA32F, width, height);
  r.draw_into({r.fetched.texture.id()}, 0, width, height);
  r.draw_screen(fetch);
  r.detach(1);
  glBindTextureUnit(3, 0);
  evidence.fetched = read_back<glm::vec4>(r.fetched, GL_RGBA, GL_FLOAT);
  r.context->check("read_moments");
  return evidence;
}

double moment_bytes(const Settings& settings, double texels, double asked, double pixels) {
  constexpr double per_asked_texel = 3 * 16;  // as they are read back, of two maps one after the other
  constexpr double per_pixel = 2 * 16;        // the moments that each receiver fetches, on both sides of OpenGL
  const LookupKind& kind = find_lookup(settings.lookup.kind);
  const double each = stored_bytes(settings);
  const double stored = kind.spread ? 4 * kind.channels : each;  // what a blur of spreads reads has 32 bits
  const double block = texel_block(settings), level = texels / (block * block);
  const double halved = (texels - level) / 3;  // of all levels
  return 2 * (texels * stored + (halved + 2 * level) * each) + asked * per_asked_texel + pixels * per_pixel;
}

}  // namespace noonmark::gl
