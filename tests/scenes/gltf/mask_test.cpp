// load_gltf on materials that mask by a texture: what stays of their triangles, and what each broken mask is told.
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/scenes/gltf/gltf_fixture.h"

namespace noonmark::test {
namespace {

// A PNG with these values of alpha; red, green and blue are 0. The first row is the top row, where v = 0.
std::string png(int width, int height, const std::vector<int>& alpha, bool with_alpha = true) {
  std::vector<uint8_t> pixels;
  for (int a : alpha) {
    pixels.insert(pixels.end(), {0, 0, 0});
    if (with_alpha) pixels.push_back(static_cast<uint8_t>(a));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<uint32_t>(width), image.height = static_cast<uint32_t>(height);
  image.format = with_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t bytes = 0;
  png_image_write_to_memory(&image, nullptr, &bytes, 0, pixels.data(), 0, nullptr);
  std::string out(bytes, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, out.data(), &bytes, 0, pixels.data(), 0, nullptr), 0) << image.message;
  out.resize(bytes);
  return out;
}

// One texel, under a header that declares another size. The header's checksum is right (PNG specification, section 5.3).
std::string declared(uint32_t width, uint32_t height) {
  std::string bytes = png(1, 1, {0});
  const auto put = [&](size_t at, uint32_t value) {
    for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 255);
  };
  put(16, width), put(20, height);
  const auto* const head = reinterpret_cast<const Bytef*>(bytes.data() + 12);  // "IHDR" and its 13 bytes
  put(29, static_cast<uint32_t>(crc32(0, head, 17)));
  return bytes;
}

class GltfMask : public GltfFile {
 protected:
  // The unit square with its texture coordinates (u, v) = (x, y), masked by an image.
  json masked(const std::string& image_bytes) {
    json d = square();
    const int coordinates = add_accessor(d, raw(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}), 5126, "VEC2", 4);
    d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = coordinates;
    d["meshes"][0]["primitives"][0]["material"] = 0;
    d["materials"] = {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    d["textures"] = {{{"source", 0}, {"sampler", 0}}};
    d["samplers"] = {{{"magFilter", 9728}}};
    d["images"] = {{{"uri", "data:image/png;base64," + base64(image_bytes)}}};
    return d;
  }
  static double area(const Scene& s) {
    double sum = 0;
    for (const glm::uvec3& t : s.triangles) {
      const glm::dvec3 a(s.positions[t.x]), b(s.positions[t.y]), c(s.positions[t.z]);
      sum += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return sum;
  }
  // Whether a triangle of the scene, seen along Z, holds the point.
  static bool holds(const Scene& s, double x, double y) {
    const auto side = [&](uint32_t i, uint32_t k) {
      const glm::dvec2 a(s.positions[i]), b(s.positions[k]);
      return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    };
    return std::any_of(s.triangles.begin(), s.triangles.end(), [&](const glm::uvec3& t) {
      return side(t.x, t.y) > 0 && side(t.y, t.z) > 0 && side(t.z, t.x) > 0;
    });
  }
};

// Two texels side by side, the left one opaque.
const std::string left_half = png(2, 1, {255, 0});

TEST_F(GltfMask, TheHiddenPartIsNotThere) {
  const Scene s = load(masked(left_half));
  EXPECT_NEAR(area(s), 0.5, 1e-7);
  EXPECT_TRUE(holds(s, 0.3, 0.65));
  EXPECT_FALSE(holds(s, 0.7, 0.65));
  EXPECT_EQ(s.parts.size(), 1u);
  EXPECT_EQ(s.single_sided.size(), s.triangles.size());
  EXPECT_TRUE(s.notes.empty());
}

TEST_F(GltfMask, TheTopRowIsWhereVIsZero) {
  const Scene s = load(masked(png(1, 2, {255, 0})));
  EXPECT_TRUE(holds(s, 0.6, 0.37));
  EXPECT_FALSE(holds(s, 0.6, 0.73));
}

TEST_F(GltfMask, WithoutMasksTheTrianglesAreWholeAndItIsSaid) {
  json d = masked("not an image");
  const Scene s = load(d, {}, false);
  EXPECT_EQ(s.triangles.size(), 2u);
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_EQ(s.notes[0], "1 material masked by a texture taken as opaque (scene.masks = false)");
}

// Linear is the default. Between the centres at u = 1/4 and u = 3/4 alpha falls from 1 to 0; beyond them it wraps.
TEST_F(GltfMask, SamplersDecideFilterAndWrap) {
  json d = masked(left_half);
  d["materials"][0]["alphaCutoff"] = 0.25;
  d["samplers"][0] = {{"wrapS", 33071}};  // clamp to the edge
  EXPECT_NEAR(area(load(d)), 0.25 + 0.75 * 0.5, 1e-6);
  d["textures"][0].erase("sampler");
  EXPECT_NEAR(area(load(d)), 0.75, 1e-6);                      // repeated: 1/8 on the right is opaque too
  d["samplers"][0] = {{"wrapS", 33648}, {"magFilter", 9728}};  // mirrored
  d["textures"][0]["sampler"] = 0;
  d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"scale", {2, 1}}};
  const Scene s = load(d);
  for (const auto& [x, opaque] : {std::pair(0.1, true), {0.4, false}, {0.6, false}, {0.9, true}})
    EXPECT_EQ(holds(s, x, 0.51), opaque) << x;
}

// One opaque texel of four, whose border is four arcs around its centre. The texture is scaled and moved: u = 2 x + 0.25.
TEST_F(GltfMask, LinearFollowsTheTextureWithinTheScenesError) {
  json d = masked(png(2, 2, {255, 0, 0, 0}));
  d["samplers"][0] = {{"magFilter", 9729}};
  d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"scale", {2, 1}}, {"offset", {0.25, 0}}};
  const Scene s = load(d);
  // A texel measures 1/4 m along x and 1/2 m along y.
  EXPECT_GT(s.mask_error_m, 0);
  EXPECT_LE(s.mask_error_m, 0.5 * 0x1p-11);
  const auto opaque = [](double x, double y) {  // between the centres alpha falls from 1 to 0 along each axis
    const auto weight = [](double t) { return std::abs(1 - 2 * std::abs(t - std::floor(t + 0.5))); };
    return weight(2 * x + 0.25 - 0.25) * weight(y - 0.25) >= 0.5;
  };
  int asked = 0, inside = 0;
  for (int j = 0; j < 60; ++j)
    for (int i = 0; i < 60; ++i) {
      const double x = (i + 0.37) / 60, y = (j + 0.61) / 60, e = s.mask_error_m + 1e-6;
      if (opaque(x + e, y) != opaque(x - e, y) || opaque(x, y + e) != opaque(x, y - e)) continue;
      // No triangle's side may run through the point.
      if (holds(s, x, y) != opaque(x, y) && holds(s, x + 1e-5, y + 2e-5) != opaque(x, y))
        ADD_FAILURE() << x << ", " << y;
      ++asked, inside += opaque(x, y);
    }
  EXPECT_GT(asked, 3500);
  EXPECT_GT(inside, 500);

  // Far from the origin the floats of the corners are coarser than that, and finer chords are lost in them.
  d["nodes"][0]["translation"] = {100000, 0, 0};
  const Scene far = load(d);
  EXPECT_LT(far.triangles.size(), s.triangles.size());
  EXPECT_LE(far.mask_error_m, 100001 * 0x1p-23);
}

TEST_F(GltfMask, FactorAndCutoff) {
  json d = masked(png(2, 1, {255, 100}));
  json& material = d["materials"][0];
  EXPECT_NEAR(area(load(d)), 0.5, 1e-7);
  material["alphaCutoff"] = 0.39;
  EXPECT_NEAR(area(load(d)), 1, 1e-7);
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  EXPECT_NEAR(area(load(d)), 0.5, 1e-7);
  material["alphaCutoff"] = 0.6;
  expect_refusal(d, "holds no triangles");
  material["pbrMetallicRoughness"].erase("baseColorTexture");
  expect_refusal(d, "holds no triangles: 1 primitive whose alphaMode MASK shows nothing");
}

// A quarter turn with v down: u = y, v = -x (KhronosGroup/glTF issue 1563). The other set of coordinates is shifted.
TEST_F(GltfMask, TheTransformAndTheSetOfTheTexture) {
  json d = masked(left_half);
  json& texture = d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["extensions"]["KHR_texture_transform"] = {{"rotation", std::acos(-1.0) / 2}};
  Scene s = load(d);
  EXPECT_TRUE(holds(s, 0.7, 0.3));
  EXPECT_FALSE(holds(s, 0.3, 0.7));
  texture["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0}}};
  s = load(d);
  EXPECT_FALSE(holds(s, 0.3, 0.6));
  EXPECT_TRUE(holds(s, 0.7, 0.6));
  const int other =
      add_accessor(d, raw(std::vector<uint16_t>{0, 0, 0, 65535, 65535, 65535, 65535, 0}), 5123, "VEC2", 4);
  d["accessors"].back()["normalized"] = true;
  d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = other;  // u = y
  texture = {{"index", 0}, {"texCoord", 1}};
  s = load(d);
  EXPECT_TRUE(holds(s, 0.7, 0.3));
  EXPECT_FALSE(holds(s, 0.3, 0.7));
}

TEST_F(GltfMask, ImagesBesideTheFileAndInViews) {
  json d = masked(left_half);
  d["images"][0] = {{"uri", "a%20mask.png"}};
  folder_.write("a mask.png", left_half);
  EXPECT_NEAR(area(load(d)), 0.5, 1e-7);
  d["buffers"].push_back({{"byteLength", left_half.size()}, {"uri", data_uri(left_half)}});
  d["bufferViews"].push_back({{"buffer", d["buffers"].size() - 1}, {"byteLength", left_half.size()}});
  d["images"][0] = {{"bufferView", d["bufferViews"].size() - 1}, {"mimeType", "image/png"}};
  EXPECT_NEAR(area(load(d)), 0.5, 1e-7);
}

TEST_F(GltfMask, ImagesWithoutAlphaMaskNothing) {
  EXPECT_EQ(load(masked(png(2, 1, {0, 0}, false))).triangles.size(), 2u);
  EXPECT_EQ(load(masked("\xff\xd8\xff\xe0 a JPEG")).triangles.size(), 2u);
  const Scene s = load(masked("RIFF    WEBP"));
  EXPECT_EQ(s.triangles.size(), 2u);
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_EQ(s.notes[0], "materials[0] masked by images[0], which is neither PNG nor JPEG, taken as opaque");
  json d = masked(left_half);
  d["textures"][0].erase("source");
  EXPECT_EQ(load(d).notes.at(0), "materials[0] masked by an image that only an extension names, taken as opaque");
}

// An opaque material never asks for its texture, so what is broken there does not matter.
TEST_F(GltfMask, TexturesOfOtherMaterialsAreNotRead) {
  json d = masked("not an image");
  d["materials"][0]["alphaMode"] = "BLEND";
  d["images"][0]["uri"] = 7;
  d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 99;
  EXPECT_EQ(load(d).triangles.size(), 2u);
}

TEST_F(GltfMask, EachBrokenMaskIsToldWhereItIs) {
  const json good = masked(left_half);
  const auto told = [&](const std::string& what, auto&& change) {
    json d = good;
    change(d);
    const std::string message = expect_refusal(d, what);
    EXPECT_NE(message.find("scene.masks = false"), std::string::npos) << message;
  };
  told("images[0].uri: 'absent.png' cannot be found", [](json& d) { d["images"][0]["uri"] = "absent.png"; });
  told("images[0]: is a damaged PNG",
       [](json& d) { d["images"][0]["uri"] = "data:image/png;base64," + base64(left_half.substr(0, 50)); });
  const std::string bomb = declared(30000, 20000);
  EXPECT_LT(bomb.size(), 200u);
  told(
      "images[0]: is a damaged PNG: it has " + std::to_string(bomb.size()) + " bytes, too few for 30000 x 20000 texels",
      [&](json& d) { d["images"][0]["uri"] = "data:image/png;base64," + base64(bomb); });
  told("images[0].uri: holds text that is not base64",
       [](json& d) { d["images"][0]["uri"] = "data:image/png;base64,?"; });
  told("images[0]: has neither a uri nor a bufferView", [](json& d) { d["images"][0] = json::object(); });
  told("textures[0].source: 4 refers beyond the 1 images", [](json& d) { d["textures"][0]["source"] = 4; });
  told("baseColorTexture.index: 3 refers beyond the 1 textures",
       [](json& d) { d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 3; });
  told("textures[0]: wraps by 7", [](json& d) { d["samplers"][0]["wrapT"] = 7; });
  told("attributes.TEXCOORD_0: is missing",
       [](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0"); });
  told("texture coordinates of vertex 0 are not finite", [](json& d) {
    d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        add_accessor(d, raw(std::vector<float>{NAN, 0, 1, 0, 1, 1, 0, 1}), 5126, "VEC2", 4);
  });
  told("2 texture coordinates for 4 vertices", [](json& d) {
    d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        add_accessor(d, raw(std::vector<float>{0, 0, 1, 0}), 5126, "VEC2", 2);
  });
  told("repeats more often than can be cut", [](json& d) {
    d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"scale", {1e6, 1e6}}};
  });
}

}  // namespace
}  // namespace noonmark::test
