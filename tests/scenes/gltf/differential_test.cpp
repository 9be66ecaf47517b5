// load_gltf against a second reader (tests/scenes/gltf/second_reader.h): the same number of triangles, the same
// bounding box, the same area. The files are those that this test makes, the two real models next to the project if
// they are there, and every .gltf and .glb below the folder that NOONMARK_MODELS names:
//
//   NOONMARK_MODELS=~/models build/release/tests/test_gltf_differential --gtest_filter='*Folder*'
//
// This command lists each file with its outcome. A file that both readers read must agree. A file that is refused is
// listed with its reason.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <set>

#include "tests/scenes/gltf/expect.h"
#include "tests/scenes/gltf/files.h"
#include "tests/scenes/gltf/second_reader.h"
#include "tests/support/source_dir.h"

namespace noonmark::test {
namespace {

namespace fs = std::filesystem;

using Triangle = std::array<glm::dvec3, 3>;

struct Measure {
  size_t triangles = 0, thin = 0;  // all; those that may or may not be degenerate after rounding to float
  glm::dvec3 low{1e300}, high{-1e300};
  double area = 0;
  double size() const { return glm::distance(low, high); }
};

Measure measure(const std::vector<Triangle>& triangles) {
  Measure m;
  for (const auto& [a, b, c] : triangles) {
    const double twice = glm::length(glm::cross(b - a, c - a));
    const double edge = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    // A coordinate is rounded by 6e-8 of itself in each step of its computation.
    const double rounding = 1e-6 * std::max({glm::length(a), glm::length(b), glm::length(c), edge});
    m.thin += twice <= edge * rounding;
    ++m.triangles;
    m.area += twice / 2;
    for (const glm::dvec3& p : {a, b, c}) m.low = glm::min(m.low, p), m.high = glm::max(m.high, p);
  }
  return m;
}

std::vector<Triangle> triangles_of(const Scene& scene) {
  std::vector<Triangle> out;
  for (const glm::uvec3& t : scene.triangles)
    out.push_back({scene.positions[t.x], scene.positions[t.y], scene.positions[t.z]});
  return out;
}

// Empty, or how the two readings differ. Assimp transforms in float, and every product of matrices rounds once more.
std::string difference(const Scene& scene, const SecondReading& other) {
  const Measure ours = measure(triangles_of(scene)), theirs = measure(other.triangles);
  // We leave out triangles without an area.
  if (ours.triangles > theirs.triangles || ours.triangles + theirs.thin < theirs.triangles)
    return "triangles: " + std::to_string(ours.triangles) + " of ours, " + std::to_string(theirs.triangles) +
           " of Assimp's, " + std::to_string(theirs.thin) + " of them thin";
  const double largest = std::max(glm::length(glm::max(glm::abs(ours.low), glm::abs(ours.high))), ours.size());
  const double allowed = 1e-5 * largest;
  const double off = std::max(glm::length(ours.low - theirs.low), glm::length(ours.high - theirs.high));
  if (!(off <= allowed)) return "box: off by " + std::to_string(off) + ", size " + std::to_string(ours.size());
  // If rounding moves an edge of length l, the area changes by l times the movement.
  const double area_allowed = 1e-4 * theirs.area + 1e-12;
  if (!(std::abs(ours.area - theirs.area) <= area_allowed))
    return "area: " + std::to_string(ours.area) + " and " + std::to_string(theirs.area);
  return "";
}

// The JSON document in the file, parsed without load_gltf; a discarded value if it cannot be parsed.
json document_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.starts_with("glTF") && bytes.size() > 20) {
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    bytes = bytes.substr(20, length);
  }
  return json::parse(bytes, nullptr, false);
}

// Why Assimp 5.2 may differ from the glTF specification on this file; empty if no reason is known.
std::string unread_extension(const json& document) {
  static const std::set<std::string> unread = {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
                                               "KHR_mesh_quantization", "KHR_meshopt_compression",
                                               "KHR_node_visibility"};
  for (const json& name : document.value("extensionsUsed", json::array())) {
    if (unread.contains(name.get<std::string>())) return "Assimp does not read " + name.get<std::string>();
  }
  return "";
}

class GltfDifferential : public ::testing::Test {
 protected:
  void expect_agreement(const std::string& name, const std::string& path) {
    const SecondReading other = read_by_assimp(path);
    ASSERT_EQ(other.error, "") << name;
    EXPECT_EQ(difference(load_gltf(path), other), "") << name;
  }
  TemporaryFolder folder_;
};

// Files of the features that both readers read, one file for each.
std::map<std::string, json> made_files() {
  std::map<std::string, json> files;
  files["square"] = square();

  json nested = square();
  nested["nodes"] = {{{"children", {1}}, {"translation", {3, -2, 7}}, {"rotation", {0.5, 0.5, -0.5, 0.5}}},
                     {{"children", {2}}, {"scale", {-2, 0.25, 1.5}}},
                     {{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0.5, 0, 1, 0, 1, 2, 3, 1}}}};
  files["nested"] = nested;

  for (int mode : {4, 5, 6}) {
    json d = square();
    const std::vector<float> zigzag = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1, 0, 2, 0, 1, 2, 5};
    const int accessor = add_accessor(d, raw(zigzag), 5126, "VEC3", 6);
    d["accessors"].back()["min"] = {0, 0, 0}, d["accessors"].back()["max"] = {1, 2, 5};
    d["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}}, {"mode", mode}};
    files["mode" + std::to_string(mode)] = d;
  }

  json sparse = square();
  const int moved = add_accessor(sparse, raw(std::vector<uint16_t>{1, 2}), 5123, "SCALAR", 2);
  const int values = add_accessor(sparse, raw(std::vector<float>{5, 0, 0, 5, 1, 2}), 5126, "VEC3", 2);
  sparse["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", sparse["accessors"][moved]["bufferView"]}, {"componentType", 5123}}},
      {"values", {{"bufferView", sparse["accessors"][values]["bufferView"]}}}};
  files["sparse"] = sparse;

  json morphed = square();
  const int target =
      add_accessor(morphed, raw(std::vector<float>{0, 0, 1, 0, 2, 0, 3, 0, 0, 0, 0, -4}), 5126, "VEC3", 4);
  morphed["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
  morphed["meshes"][0]["weights"] = {0.75};
  files["morphed"] = morphed;

  // Two joints; one of them is turned and moved away from its bind pose.
  json skinned = square();
  auto& attributes = skinned["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      add_accessor(skinned, raw(std::vector<uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121, "VEC4", 4);
  attributes["WEIGHTS_0"] = add_accessor(
      skinned, raw(std::vector<float>{1, 0, 0, 0, 0.5, 0.5, 0, 0, 0.25, 0.75, 0, 0, 0, 1, 0, 0}), 5126, "VEC4", 4);
  const std::vector<float> bind = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
  skinned["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", add_accessor(skinned, raw(bind), 5126, "MAT4", 2)}}};
  skinned["nodes"][0]["skin"] = 0;
  skinned["nodes"].push_back({{"name", "hip"}, {"translation", {0, 3, 0}}, {"children", {2}}});
  skinned["nodes"].push_back({{"name", "knee"}, {"translation", {1, 0, 2}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}});
  skinned["scenes"][0]["nodes"] = {0, 1};
  files["skinned"] = skinned;
  return files;
}

TEST_F(GltfDifferential, FilesThatAreMadeHere) {
  for (const auto& [name, document] : made_files())
    expect_agreement(name, folder_.write(name + ".gltf", document.dump()));
}

// Tests the comparison itself: it must find a missing triangle, a moved node and a moved corner.
TEST_F(GltfDifferential, ADifferenceIsFound) {
  const json whole = made_files().at("nested");
  const std::string path = folder_.write("whole.gltf", whole.dump());
  const SecondReading other = read_by_assimp(path);
  const auto differs = [&](const json& d) {
    return difference(load_gltf(folder_.write("changed.gltf", d.dump())), other).substr(0, 4);
  };
  EXPECT_EQ(differs(whole), "");
  json fewer = whole;
  fewer["accessors"][1]["count"] = 3;
  EXPECT_EQ(differs(fewer), "tria");
  json moved = whole;
  moved["nodes"][0]["translation"][0] = 3.001;
  EXPECT_EQ(differs(moved), "box:");
  // The corner at (0, 1) is moved inwards: the number of triangles and the box stay the same, only the area changes.
  json smaller = square();
  const SecondReading plain = read_by_assimp(folder_.write("square.gltf", smaller.dump()));
  const std::vector<float> inwards = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0.25, 0.75, 0};
  smaller["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      add_accessor(smaller, raw(inwards), 5126, "VEC3", 4);
  EXPECT_EQ(difference(load_gltf(folder_.write("smaller.gltf", smaller.dump())), plain).substr(0, 5), "area:");
}

TEST_F(GltfDifferential, ModelsBesideTheProject) {
  const fs::path root = fs::path(noonmark::test::source_dir()).parent_path() / "shared" / "scenes";
  if (!fs::exists(root)) GTEST_SKIP() << "no models at " << root;
  for (const char* name : {"FlightHelmet", "Lantern"})
    expect_agreement(name, (root / name / (std::string(name) + ".gltf")).string());
}

TEST_F(GltfDifferential, FolderOfModels) {
  const char* folder = std::getenv("NOONMARK_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "NOONMARK_MODELS names no folder";
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::map<std::string, int> outcomes;
  for (const fs::path& path : paths) {
    std::string outcome, detail, drawn;
    try {
      const Scene scene = load_gltf(path.string());
      EXPECT_EQ(defect_of(scene), "") << path;
      const Measure m = measure(triangles_of(scene));
      drawn = " (" + std::to_string(m.triangles) + " triangles, size " + std::to_string(m.size()) + ", area " +
              std::to_string(m.area) + ")";
      const SecondReading other = read_by_assimp(path.string());
      if (!other.error.empty()) {
        outcome = "drawn, not read by Assimp", detail = other.error;
      } else if (const std::string differs = difference(scene, other); differs.empty()) {
        outcome = "drawn, agreed";
      } else if (detail = unread_extension(document_of(path)); !detail.empty()) {
        outcome = "drawn, not comparable";
      } else {
        outcome = "DIFFERENT", detail = differs;
        ADD_FAILURE() << path << ": " << differs;
      }
    } catch (const Error& e) {
      outcome = "refused", detail = std::string(e.what()).substr(path.string().size() + 2);
    }
    ++outcomes[outcome];
    std::printf("%-26s %s%s%s%s\n", outcome.c_str(), fs::relative(path, folder).c_str(), drawn.c_str(),
                detail.empty() ? "" : ": ", detail.c_str());
  }
  for (const auto& [outcome, count] : outcomes) std::printf("%6d %s\n", count, outcome.c_str());
}

}  // namespace
}  // namespace noonmark::test
