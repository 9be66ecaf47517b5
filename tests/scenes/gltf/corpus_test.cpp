// load_gltf against files that others made: the corpus of the Khronos glTF-Validator with its verdicts, and two real
// models. Both are next to the project; without them the tests are skipped.
#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "tests/scenes/gltf/expect.h"
#include "tests/scenes/gltf/files.h"
#include "tests/support/source_dir.h"

namespace noonmark::test {
namespace {

namespace fs = std::filesystem;

fs::path shared(const char* name) { return fs::path(noonmark::test::source_dir()).parent_path() / "shared" / name; }

json parse_file(const fs::path& path) { return json::parse(std::ifstream(path)); }

std::set<std::string> error_codes(const json& report) {
  std::set<std::string> codes;
  for (const json& message : report["issues"]["messages"]) {
    if (message["severity"] == 0) codes.insert(message["code"].get<std::string>());
  }
  return codes;
}

// The errors of the validator that the loader may accept, with the reason. The loader must refuse every other error of
// the validator, for a reason other than that the file draws nothing.
const std::map<std::string, std::string> tolerated = {
    {"ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "the loader reads the data, not min and max"},
    {"ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "the loader reads the data, not min and max"},
    {"ACCESSOR_MAX_MISMATCH", "the loader reads the data, not min and max"},
    {"ACCESSOR_MIN_MISMATCH", "the loader reads the data, not min and max"},
    {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "the loader reads the data, not min and max"},
    {"ACCESSOR_INVALID_FLOAT",
     "data are read, and refused if not finite, only where they are drawn; here they are not drawn"},
    {"ACCESSOR_INDEX_PRIMITIVE_RESTART",
     "data are read, and refused, only where they are drawn; here they are not drawn"},
    {"BUFFER_BYTE_LENGTH_MISMATCH", "buffers are read only where they are drawn; here they are not drawn"},
    {"BUFFER_DATA_URI_MIME_TYPE_INVALID", "buffers are read only where they are drawn; here they are not drawn"},
    {"BUFFER_MISSING_GLB_DATA", "buffers are read only where they are drawn; here they are not drawn"},
    {"EMPTY_ENTITY", "an empty list means the same as no list"},
    {"DUPLICATE_ELEMENTS", "an extension that is named twice is used, as if it were named once"},
    {"NON_REQUIRED_EXTENSION", "an extension that is used is read, required or not"},
    {"UNUSED_EXTENSION_REQUIRED", "a list of extensions may name more than is used"},
    {"BUFFER_VIEW_TARGET_OVERRIDE", "targets are a hint to a GPU"},
    {"MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
     "without a stride the elements are packed; there is no other reading"},
    {"MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "of the attributes only positions are read"},
    {"MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", "joints and weights are read under a skin"},
    {"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "of the attributes only positions are read"},
    {"MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
     "morph targets are read only where they are drawn; here they are not drawn"},
    {"MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
     "morph targets are read only where they are drawn; here they are not drawn"},
    {"MESH_INVALID_WEIGHTS_COUNT", "morph targets are read only where they are drawn; here they are not drawn"},
    {"NODE_WEIGHTS_INVALID", "morph targets are read only where they are drawn; here they are not drawn"},
    {"NODE_SKIN_WITH_NON_SKINNED_MESH", "skins are read only where they are drawn; here they are not drawn"},
    {"SCENE_NON_ROOT_NODE", "drawn once, where its parents put it, with a note"},
    {"UNEXPECTED_EXTENSION_OBJECT", "extensions that are not supported are not read"},
    {"NODE_MATRIX_NON_TRS", "a matrix that shears can be drawn"},
};

// Files that may be accepted although files with the same error codes must be refused elsewhere.
const std::map<std::string, std::string> tolerated_files = {
    {"base/data/node/skin_with_no_mesh.gltf", "a skin without a mesh draws nothing"},
    {"base/data/node/unresolved_skin.gltf", "a skin without a mesh draws nothing"},
    {"ext/KHR_materials_variants/data/primitive/dependency.gltf", "variants of materials are not read"},
    {"ext/KHR_materials_variants/data/primitive/unresolved_references.gltf", "variants of materials are not read"},
};

struct Row {
  int validator_errors = 0;
  std::set<std::string> codes;
  std::string message;  // empty: loaded
  // Refused because it is a fragment: most files of the corpus show one property and have no scene, or no triangles.
  bool nothing_drawn() const {
    return message.find("holds no triangles") != std::string::npos ||
           message.find("scenes: there is none") != std::string::npos;
  }
};

class GltfCorpus : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = shared("gltf-corpus");
    if (!fs::exists(root_)) GTEST_SKIP() << "no corpus at " << root_;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root_)) {
      const std::string extension = entry.path().extension();
      if (extension != ".gltf" && extension != ".glb") continue;
      const json report = parse_file(entry.path().string() + ".report.json");
      Row row{report["issues"]["numErrors"].get<int>(), error_codes(report), ""};
      try {
        const Scene scene = load_gltf(entry.path().string());
        EXPECT_EQ(defect_of(scene), "") << entry.path();
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::file) << e.what();
        row.message = std::string(e.what()).substr(entry.path().string().size() + 2);
      }
      rows_[fs::relative(entry.path(), root_).string()] = row;
    }
    ASSERT_GT(rows_.size(), 100u);
  }
  fs::path root_;
  std::map<std::string, Row> rows_;
};

TEST_F(GltfCorpus, EveryErrorThatTouchesWhatIsReadIsRefusedForAReasonOfItsOwn) {
  int agreed = 0;
  std::map<std::string, int> lenient;
  for (const auto& [name, row] : rows_) {
    if (row.validator_errors == 0) continue;
    if (!row.message.empty() && !row.nothing_drawn()) {
      ++agreed;
      continue;
    }
    const bool known =
        tolerated_files.contains(name) ||
        std::all_of(row.codes.begin(), row.codes.end(), [](const std::string& c) { return tolerated.contains(c); });
    std::string codes;
    for (const std::string& code : row.codes) codes += " " + code;
    EXPECT_TRUE(known) << name << " has errors for the validator:" << codes
                       << "\nbut not to the loader: " << row.message;
    for (const std::string& code : row.codes) ++lenient[code];
  }
  std::printf("%-52s %s\n", "the validator's error, not ours", "files");
  for (const auto& [code, count] : lenient) std::printf("%-52s %d\n", code.c_str(), count);
  std::printf("%-52s %d\n", "refused by both", agreed);
  EXPECT_GT(agreed, 30);
}

TEST_F(GltfCorpus, FilesInOrderAreRefusedOnlyWhereNothingIsDrawn) {
  int loaded = 0, nothing_drawn = 0;
  for (const auto& [name, row] : rows_) {
    if (row.validator_errors != 0) continue;
    ++(row.message.empty() ? loaded : nothing_drawn);
    EXPECT_TRUE(row.message.empty() || row.nothing_drawn()) << name << ": " << row.message;
  }
  std::printf("without errors for the validator: %d loaded, %d draw nothing\n", loaded, nothing_drawn);
}

// The corpus file with a square added to its scene; nothing if the file is too broken to add one.
std::optional<json> grafted(json d) {
  const char* const lists[] = {"buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes"};
  if (!d.is_object()) return std::nullopt;
  for (const char* list : lists) {
    if (!d.contains(list)) d[list] = json::array();
    if (!d[list].is_array()) return std::nullopt;
  }
  const json which = d.value("scene", json(0u));
  if (d.contains("scene") && (!which.is_number_unsigned() || which.get<size_t>() >= d["scenes"].size()))
    return std::nullopt;
  const int positions = add_accessor(d, raw(square_positions), 5126, "VEC3", 4);
  const int indices = add_accessor(d, raw(square_indices), 5123, "SCALAR", 6);
  d["nodes"].push_back({{"mesh", d["meshes"].size()}});
  d["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
  if (d["scenes"].empty()) d["scenes"].push_back({{"nodes", json::array()}});
  json& scene = d["scenes"][which.get<size_t>()];
  if (!scene.is_object()) return std::nullopt;
  if (!scene.contains("nodes")) scene["nodes"] = json::array();
  if (!scene["nodes"].is_array()) return std::nullopt;
  scene["nodes"].push_back(d["nodes"].size() - 1);
  return d;
}

// A file that is valid but draws nothing by itself must be drawn when a square is added. A file with errors must be
// refused as before.
TEST_F(GltfCorpus, GraftedOntoASceneThatDraws) {
  TemporaryFolder folder;
  int drawn = 0, refused = 0, lenient = 0;
  for (const auto& [name, row] : rows_) {
    const fs::path from = root_ / name;
    // The square may supply the reference that such a file lacks, so it is left out.
    if (from.extension() != ".gltf" || row.codes.contains("UNRESOLVED_REFERENCE")) continue;
    const json document = json::parse(std::ifstream(from), nullptr, false);
    const std::optional<json> with_square = document.is_discarded() ? std::nullopt : grafted(document);
    if (!with_square) continue;
    fs::create_directories(folder.path() / from.stem());
    for (const fs::directory_entry& beside : fs::directory_iterator(from.parent_path())) {
      if (beside.path().extension() == ".bin")
        fs::copy(beside.path(), folder.path() / from.stem() / beside.path().filename(),
                 fs::copy_options::overwrite_existing);
    }
    const std::string path = folder.write(from.stem().string() + "/scene.gltf", with_square->dump());
    std::string message;
    try {
      const Scene scene = load_gltf(path);
      EXPECT_EQ(defect_of(scene), "") << name;
      EXPECT_GE(scene.triangles.size(), 2u) << name;
    } catch (const Error& e) {
      message = e.what();
    }
    if (row.validator_errors == 0) {
      ++drawn;
      EXPECT_EQ(message, "") << name << " is valid";
    } else if (!message.empty()) {
      ++refused;
    } else {
      ++lenient;
      EXPECT_TRUE(tolerated_files.contains(name) ||
                  std::all_of(row.codes.begin(), row.codes.end(),
                              [](const std::string& code) { return tolerated.contains(code); }))
          << name << " has errors for the validator";
    }
  }
  std::printf("with a square: %d valid and drawn, %d refused by both, %d the validator's error alone\n", drawn, refused,
              lenient);
  EXPECT_GT(drawn, 15);
}

uint64_t triangles_of(const json& document, int node) {
  const json& here = document["nodes"][node];
  uint64_t sum = 0;
  if (here.contains("mesh")) {
    for (const json& primitive : document["meshes"][here["mesh"].get<int>()]["primitives"]) {
      EXPECT_EQ(primitive.value("mode", 4), 4);
      sum += document["accessors"][primitive["indices"].get<int>()]["count"].get<uint64_t>() / 3;
    }
  }
  for (const json& child : here.value("children", json::array())) sum += triangles_of(document, child.get<int>());
  return sum;
}

class RealModels : public ::testing::TestWithParam<const char*> {};

TEST_P(RealModels, LoadWithoutTheirTextures) {
  const fs::path path = shared("scenes") / GetParam() / (std::string(GetParam()) + ".gltf");
  if (!fs::exists(path)) GTEST_SKIP() << "no model at " << path;
  const json document = parse_file(path);
  uint64_t listed = 0;
  for (const json& node : document["scenes"][document.value("scene", 0)]["nodes"])
    listed += triangles_of(document, node.get<int>());
  const Scene scene = load_gltf(path.string());
  EXPECT_EQ(defect_of(scene), "");
  std::printf("%s: %zu of %lu triangles, %zu vertices, %zu parts\n", GetParam(), scene.triangles.size(),
              static_cast<unsigned long>(listed), scene.positions.size(), scene.parts.size());
  EXPECT_EQ(scene.triangles.size(), listed);
}

INSTANTIATE_TEST_SUITE_P(All, RealModels, ::testing::Values("FlightHelmet", "Lantern"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace noonmark::test
