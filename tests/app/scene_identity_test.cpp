// The identity of a scene must change if a change in its file changes a measurement. It need not change otherwise.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "app/sweep/identity.h"
#include "base/error.h"
#include "scenes/gltf/gltf.h"
#include "scenes/scene_digest.h"
#include "tests/scenes/gltf/files.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

using test::json;

// A floor, a board above it under nodes that translate, rotate and scale it, and a camera and a light that look down.
json rich_scene(const json& camera, const json& light) {
  json d = test::square();
  d["asset"]["generator"] = "none";
  d["asset"]["extras"] = {{"revision", 7}};
  d["extensionsUsed"] = {"KHR_lights_punctual"};
  d["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  d["cameras"] = {camera};
  d["materials"] = {{{"name", "paint"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}}};
  d["meshes"][0]["name"] = "board";
  d["meshes"][0]["primitives"][0]["material"] = 0;
  const double half =
      std::sqrt(0.5);  // rotation about +X by -90 degrees: +Z becomes up, and a view along -Z becomes a view down
  d["nodes"] = {{{"mesh", 0},
                 {"name", "floor"},
                 {"rotation", {-half, 0, 0, half}},
                 {"scale", {8, 8, 1}},
                 {"translation", {-4, 0, 4}}},
                {{"name", "turned"}, {"children", {2}}, {"rotation", {0, 0.6, 0, 0.8}}, {"extras", {{"weight", 3.5}}}},
                {{"mesh", 0}, {"name", "board"}, {"matrix", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, -0.5, 1, 0.5, 1}}},
                {{"camera", 0}, {"name", "view"}, {"rotation", {-half, 0, 0, half}}, {"translation", {0.5, 6, 0.25}}},
                {{"name", "lamp"},
                 {"rotation", {-half, 0, 0, half}},
                 {"translation", {0.4, 4, 0.1}},
                 {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  d["scenes"][0]["nodes"] = {0, 1, 3, 4};
  return d;
}
const json spot = {{"type", "spot"},
                   {"intensity", 20},
                   {"color", {1, 0.5, 0.25}},
                   {"range", 30},
                   {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.6}}}};
const json sun = {{"type", "directional"}, {"intensity", 3}};
const json lens = {{"type", "perspective"},
                   {"perspective", {{"yfov", 0.9}, {"znear", 0.5}, {"zfar", 40}, {"aspectRatio", 1.5}}}};
const json plan = {{"type", "orthographic"},
                   {"orthographic", {{"xmag", 3}, {"ymag", 3}, {"znear", 0.5}, {"zfar", 40}}}};

struct Edit {
  std::string place;
  json document;
};

// One edit for every number in the document and one for every coordinate in its vertex buffer.
std::vector<Edit> every_edit(const json& document) {
  std::vector<Edit> edits;
  const json flat = document.flatten();
  for (const auto& [place, value] : flat.items()) {
    if (!value.is_number()) continue;
    json edited = document;
    edited[json::json_pointer(place)] =
        value.is_number_integer() ? json(value.get<int>() + 1) : json(value.get<double>() * 1.01 + 0.01);
    edits.push_back({place, edited});
    if (value.is_number_integer()) {  // it may stand for a real number, for which 0.01 more is legal and 1 more is not
      edited[json::json_pointer(place)] = value.get<int>() + 0.01;
      edits.push_back({place + " (a little)", edited});
    }
  }
  for (size_t i = 0; i < test::square_positions.size(); ++i) {
    std::vector<float> positions = test::square_positions;
    positions[i] += 0.25f;
    json edited = document;
    edited["accessors"][0].erase("min");
    edited["accessors"][0].erase("max");
    edited["buffers"][0]["uri"] = test::data_uri(test::raw(positions) + test::raw(test::square_indices));
    edits.push_back({"position " + std::to_string(i), edited});
  }
  return edits;
}

// All numbers of a measurement except the times, as bytes.
std::string seen(Workbench& bench, const std::string& path) {
  const Measurement m =
      bench.measure(with({{"map.resolution", "64"}}, small(path, 48, 32)), CurveOptions{{}, {0, 0.01}});
  std::string bytes;
  const auto add = [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); };
  for (const auto& [name, lit] : m.ladder.rungs) add(lit.pixels.data(), lit.pixels.size() * sizeof(float));
  add(m.receivers.position.pixels.data(), m.receivers.position.pixels.size() * sizeof(glm::vec3));
  add(m.map().stored.depth.data(), m.map().stored.depth.size() * sizeof(float));
  for (const auto& [name, value] : m.record.metrics)
    if (!name.ends_with("_ms")) add(&value, sizeof value);
  return bytes;
}

TEST(SceneIdentity, SeesWhateverInTheFileChangesAMeasurement) {
  const TemporaryFolder folder;
  Workbench bench(gl::DebugMode::off);
  for (const json& document : {rich_scene(lens, spot), rich_scene(plan, sun)}) {
    const std::string first = folder.write("scene.gltf", document.dump());
    const std::string digest = scene_digest(load_gltf(first)), picture = seen(bench, first);
    size_t loaded = 0, anew = 0;
    const std::vector<Edit> edits = every_edit(document);
    for (size_t i = 0; i < edits.size(); ++i) {
      const std::string& place = edits[i].place;
      SCOPED_TRACE(place);
      const std::string path = folder.write("edit" + std::to_string(i) + ".gltf", edits[i].document.dump());
      std::string other;
      try {
        other = scene_digest(load_gltf(path));
      } catch (const Error&) {
        continue;  // the file is refused, so no old verdict can be reused
      }
      ++loaded;
      anew += other != digest;
      const bool label = place.find("extras") != std::string::npos;
      if (label) {
        EXPECT_EQ(other, digest);
      }
      if (other == digest) {
        EXPECT_TRUE(seen(bench, path) == picture) << "the identity is the same although the picture has changed";
      }
    }
    EXPECT_GT(loaded, 60u) << "too few edits were legal, so the test proves nothing";
    EXPECT_GT(anew, 40u) << "too few edits were noticed, so the test proves nothing";
  }
}

// Scenes are loaded one after the other while a sweep runs. Meanwhile somebody may edit a file.
TEST(SceneIdentity, NoticesAFileThatIsEditedDuringTheSweep) {
  const TemporaryFolder folder;
  json document = rich_scene(lens, spot);
  const Settings first = small(folder.write("a.gltf", document.dump()), 48, 32),
                 second = small(folder.write("b.gltf", document.dump()), 48, 32);
  Workbench bench(gl::DebugMode::off);
  SceneDigests scenes;
  const Settings both[] = {first, second};
  for (const Settings& point : both) scenes.remember(bench, point);
  const auto facts = identity(bench, raytrace::tracer_info(), scenes);
  EXPECT_NO_THROW(scenes.require_unchanged(bench, first));
  EXPECT_NO_THROW(scenes.require_unchanged(bench, second));
  document["nodes"][2]["matrix"][13] = 1.5;
  folder.write("a.gltf", document.dump());
  EXPECT_NO_THROW(scenes.require_unchanged(bench, second));
  EXPECT_THROW(scenes.require_unchanged(bench, first), Error);

  // Besides the scenes, the identity names everything else that results depend on.
  std::set<std::string> names;
  for (const auto& [name, value] : facts) {
    if (name == "program") {
      EXPECT_GE(value.size(), 16u) << "this is not the hash of the linker: " << value;
    }
    names.insert(name.substr(0, name.find(' ')));
  }
  EXPECT_EQ(names, (std::set<std::string>{"noonmark", "program", "opengl", "embree", "machine", "scene"}));
}

TEST(SceneIdentity, DoesNotSeeNames) {
  const TemporaryFolder folder;
  json document = rich_scene(lens, spot);
  const std::string digest = scene_digest(load_gltf(folder.write("scene.gltf", document.dump())));
  const json flat = document.flatten();
  int names = 0;
  for (const auto& [place, value] : flat.items())
    if (place.ends_with("/name")) {
      document[json::json_pointer(place)] = "another";
      ++names;
    }
  ASSERT_GE(names, 7);
  EXPECT_EQ(scene_digest(load_gltf(folder.write("scene.gltf", document.dump()))), digest);
  EXPECT_EQ(scene_digest(load_gltf(folder.write("elsewhere.gltf", document.dump()))), digest);
}

TEST(SceneIdentity, SeesEveryMemberThatIsNoName) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.triangles = {{0, 1, 2}};
  scene.parts = {{"part", 0, 1}};
  scene.map = MapVolume{};
  std::set<std::string> digests = {scene_digest(scene)};
  EXPECT_EQ(scene_digest(scene), *digests.begin());
  const auto edited = [&](const char* what, const std::function<void(Scene&)>& edit) {
    Scene copy = scene;
    edit(copy);
    EXPECT_TRUE(digests.insert(scene_digest(copy)).second) << what;
  };
  edited("a position", [](Scene& s) { s.positions[1].x = std::nextafter(1.0f, 2.0f); });
  edited("an unused position", [](Scene& s) { s.positions.push_back({9, 9, 9}); });
  edited("a triangle's winding", [](Scene& s) { s.triangles[0] = {0, 2, 1}; });
  edited("a side", [](Scene& s) { s.single_sided = {true}; });
  edited("the other side", [](Scene& s) { s.single_sided = {false}; });
  edited("a note", [](Scene& s) { s.notes = {"a note"}; });
  edited("a part", [](Scene& s) { s.parts[0].triangle_count = 2; });
  edited("eye", [](Scene& s) { s.camera.eye_m.z = 4; });
  edited("target", [](Scene& s) { s.camera.target_m.x = 1; });
  edited("up", [](Scene& s) { s.camera.up.x = 1; });
  edited("projection", [](Scene& s) { s.camera.projection = Projection::orthographic; });
  edited("fov", [](Scene& s) { s.camera.fov_y_deg = 44; });
  edited("height", [](Scene& s) { s.camera.height_m = 9; });
  edited("near", [](Scene& s) { s.camera.near_m = 0.2; });
  edited("near at 0, where it was fitted", [](Scene& s) { s.camera.near_m = 0; });
  edited("far", [](Scene& s) { s.camera.far_m = 99; });
  edited("kind", [](Scene& s) { s.light.kind = LightKind::spot; });
  edited("position", [](Scene& s) { s.light.position_m.y = 11; });
  edited("light's target", [](Scene& s) { s.light.target_m.y = 1; });
  edited("diameter", [](Scene& s) { s.light.angular_diameter_deg = 0.53; });
  edited("radius", [](Scene& s) { s.light.radius_m = 0.1; });
  edited("shape", [](Scene& s) { s.light.shape = LightShape::disc; });
  edited("cone", [](Scene& s) { s.light.cone_deg = 59; });
  edited("no map", [](Scene& s) { s.map.reset(); });
  edited("extent", [](Scene& s) { s.map->extent_m = 19; });
  edited("map's near", [](Scene& s) { s.map->near_m = 2; });
  edited("map's far", [](Scene& s) { s.map->far_m = 9; });
}

}  // namespace
}  // namespace noonmark::acceptance
