// The input is the bytes of a .gltf or .glb for load_gltf, which must give a sound scene or one Error(file) in one
// line. The bytes are mutated as JSON; in a .glb the JSON chunk, the binary chunk and the header are mutated
// separately. The folder of the file also holds a buffer and a link to a buffer outside the folder. No file may read
// that outside buffer; otherwise its positions would appear in the scene.
#include <filesystem>

#include "base/error.h"
#include "scenes/gltf/gltf.h"
#include "tests/fuzz/json_mutator.h"
#include "tests/fuzz/targets.h"
#include "tests/scenes/gltf/compressed_files.h"
#include "tests/scenes/gltf/expect.h"
#include "tests/support/words.h"

namespace noonmark::fuzz {
namespace {

using nlohmann::json;
using test::add_accessor;
using test::raw;

// No seed contains the bytes of this float; only outside.bin does.
constexpr float outside_value = -8191.7734375f;
constexpr size_t buffer_bytes = 60;  // the buffer of the square: four positions, six indices

struct Files {
  Folder folder;
  Files() {
    std::filesystem::create_directory(folder.file("scene"));
    folder.write("scene/inside.bin", test::square_bytes());
    folder.write("outside.bin", raw(std::vector<float>(buffer_bytes / sizeof(float), outside_value)));
    std::filesystem::create_symlink("../outside.bin", folder.file("scene/link.bin"));
  }
};

void run(const std::string& bytes) {
  static const Files files;
  files.folder.write("scene/scene.glb", bytes);
  const std::string path = files.folder.file("scene/scene.glb");
  try {
    Pose pose;  // at rest, or at some time of the animation if the file has one
    if (bytes.find("\"animations\"") != std::string::npos && bytes.size() % 4 != 0)
      pose.time_s = 0.37 * static_cast<double>(bytes.size() % 5);
    const Scene scene = load_gltf(path, pose);
    const std::string defect = test::defect_of(scene);
    require(defect.empty(), "the scene is not sound: " + defect);
    for (const glm::vec3& p : scene.positions)
      for (int axis = 0; axis < 3; ++axis)
        require(p[axis] != outside_value, "a buffer outside of the scene's folder was read");
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::file, std::string("an error of another kind: ") + error.what());
    for (const unsigned char c : std::string_view(error.what()))
      require(c >= 0x20 && c != 0x7f, std::string("a control character in the message: ") + error.what());
    require(std::string_view(error.what()).starts_with(path + ": "), "a message that does not name the file first");
  }
}

std::vector<std::string> seeds() {
  json chunked = test::square();
  chunked["buffers"][0] = {{"byteLength", buffer_bytes}};
  json beside = test::square();
  beside["buffers"][0]["uri"] = "inside.bin";
  std::vector<std::string> all = {test::square().dump(), test::rich().dump(), test::moving().dump(), beside.dump(),
                                  test::glb(chunked.dump(), test::square_bytes())};
  const test::Grid grid = test::wavy(2);
  for (const test::Encoding how : {test::Encoding{draco::MESH_EDGEBREAKER_ENCODING, 0, true},
                                   test::Encoding{draco::MESH_SEQUENTIAL_ENCODING, 8, false}})
    all.push_back(test::draco_document(grid, test::draco_bytes(grid, how), how).dump());
  for (const bool sequence : {false, true}) all.push_back(test::meshopt_document(grid, sequence).dump());
  return all;
}

std::vector<std::string> words() {
  return test::words_of(R"(
accessors accessor asset version minVersion 2.0 attributes POSITION NORMAL JOINTS_0 WEIGHTS_0 bufferView bufferViews buffer
buffers byteLength byteOffset byteStride uri data:application/octet-stream;base64,
data:application/gltf-buffer;base64, inside.bin ../outside.bin link.bin %2e%2e/outside.bin ./inside.bin /dev/zero
scene.glb camera cameras perspective orthographic yfov znear zfar xmag ymag aspectRatio children component
componentType count type SCALAR VEC2 VEC3 VEC4 MAT4 normalized min max sparse indices values extensions extensionsUsed
extensionsRequired extras KHR_lights_punctual KHR_mesh_quantization KHR_node_visibility KHR_draco_mesh_compression
EXT_meshopt_compression EXT_mesh_gpu_instancing TRANSLATION ROTATION SCALE visible light lights directional spot point
innerConeAngle outerConeAngle range matrix mesh meshes mode name node nodes primitives rotation translation scale
scene scenes skin skins joints inverseBindMatrices skeleton targets weights animations channels samplers sampler
target path input output interpolation LINEAR STEP CUBICSPLINE materials material alphaMode MASK BLEND OPAQUE
alphaCutoff doubleSided pbrMetallicRoughness baseColorFactor baseColorTexture index textures images glTF
JSON)");
}

uint32_t word_at(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  if (at + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

// The bytes in a buffer's data: URI; those of the square if there is none.
std::string embedded_bytes(const json& buffer) {
  const std::string uri = buffer.contains("uri") && buffer["uri"].is_string() ? buffer["uri"].get<std::string>() : "";
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) return test::square_bytes();
  std::string out;
  uint32_t bits = 0;
  int held = 0;
  for (const char c : std::string_view(uri).substr(comma + 1)) {
    const size_t digit = std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string_view::npos) break;
    bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xffffu;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out += static_cast<char>(bits >> held & 0xff);
  }
  return out;
}

// Damages one of the embedded buffers, if there are any. They are decoded first, because base64 that is edited as text
// is refused at once.
void edit_a_buffer(json& document, Random& random, const EditBytes& edit) {
  if (!document.is_object() || !document.contains("buffers") || !document["buffers"].is_array()) return;
  json& buffers = document["buffers"];
  if (buffers.empty()) return;
  json& buffer = buffers[below(random, buffers.size())];
  if (!buffer.is_object()) return;
  const std::string data = edit(embedded_bytes(buffer), random);
  buffer["uri"] = test::data_uri(data);
  if (below(random, 4) == 0) buffer["byteLength"] = data.size();
}

std::string mutate_text(const std::string& text, Random& random, const EditBytes& edit) {
  static const std::vector<std::string> known = words();
  json document = json::parse(text, nullptr, false);
  if (document.is_discarded()) return edit(text, random);
  if (below(random, 5) == 0)
    edit_a_buffer(document, random, edit);
  else
    mutate_json(document, random, known, edit);
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  if (!bytes.starts_with("glTF")) {
    // Sometimes the same document as a .glb.
    return below(random, 16) == 0 ? test::glb(bytes, test::square_bytes()) : mutate_text(bytes, random, edit);
  }
  const size_t length = word_at(bytes, 12);
  if (length > bytes.size() || bytes.size() - length < 20) return edit(bytes, random);
  std::string text = bytes.substr(20, length);
  std::string bin = bytes.size() >= 28 + length ? bytes.substr(28 + length) : "";
  switch (below(random, 8)) {
    case 0:
      return edit(bytes, random);
    case 1: {
      std::string whole = bytes;  // damage the length or type of a chunk or of the whole file
      const size_t word = 4 * below(random, 5);
      const std::string edited = edit(whole.substr(word, 4), random);
      whole.replace(word, 4, (edited + std::string(4, '\0')).substr(0, 4));
      return whole;
    }
    case 2:
    case 3:
      return test::glb(text, edit(bin, random));
    default:
      return test::glb(mutate_text(text, random, edit), bin);
  }
}

}  // namespace

const Target gltf_target = {"gltf", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
