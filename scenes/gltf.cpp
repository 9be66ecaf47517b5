// load_gltf (scenes/library.h): container -> guard -> tinygltf -> structure -> nodes -> geometry -> camera and light.
// Each step is a file of its own, scenes/gltf_*.h, whose head says what it refuses.
#include <filesystem>
#include <new>

#include "scenes/gltf_buffers.h"
#include "scenes/gltf_document.h"
#include "scenes/gltf_error.h"
#include "scenes/gltf_mesh.h"
#include "scenes/gltf_nodes.h"
#include "scenes/gltf_view.h"
#include "scenes/library.h"

namespace noonmark {

Scene load_gltf(const std::string& path) {
  try {
    const gltf::Document document = gltf::read_document(path);
    const std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(document);
    gltf::Buffers buffers(document);
    Scene scene;
    scene.name = std::filesystem::path(path).stem().string();
    gltf::append_geometry(document, buffers, nodes, scene);
    if (scene.triangles.empty()) {
      gltf::refuse(path, "", "the scene that it shows holds no triangles",
                   "export meshes of triangles, in the default scene and with an area");
    }
    const std::optional<Camera> camera = gltf::find_camera(document, nodes, scene);
    scene.camera = camera ? *camera : fit_camera(scene);
    scene.light = gltf::find_light(document, nodes, scene).value_or(fit_light(scene));
    return scene;
  } catch (const std::bad_alloc&) {
    gltf::refuse(path, "", "does not fit into memory", "simplify it, or use a machine with more");
  }
}

}  // namespace noonmark
