#include <fmt/format.h>

#include "app/verbs/verbs.h"
#include "scenes/builtin.h"

namespace noonmark {
namespace {

int list_scenes() {
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const Scene scene = builtin.make({});
    fmt::print("{:<10} {:>6} triangles  {}\n", builtin.name, scene.triangles.size(), builtin.provokes);
  }
  fmt::print("\nOr the path of a .gltf, .glb or .vrm file: scene = \"models/tree.glb\"\n");
  return 0;
}

RunVerb add_scenes(CLI::App&) {
  return [](const std::string&) { return list_scenes(); };
}

}  // namespace

Verb verb_scenes() {
  return {"scenes", "List the built-in scenes and the artefacts that each provokes", "noonmark scenes", add_scenes};
}

}  // namespace noonmark
