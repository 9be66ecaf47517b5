// Joins the steps: container -> json -> guard -> tinygltf -> structure -> pose -> nodes -> geometry -> camera and
// light. Each step has its own file in scenes/gltf/, whose head says what it refuses.
#include "scenes/gltf/gltf.h"

#include <filesystem>
#include <new>
#include <optional>

#include "scenes/gltf/animation.h"
#include "scenes/gltf/buffers.h"
#include "scenes/gltf/contents.h"
#include "scenes/gltf/count_contents.h"
#include "scenes/gltf/document.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/mesh.h"
#include "scenes/gltf/nodes.h"
#include "scenes/gltf/notes.h"
#include "scenes/gltf/view.h"
#include "scenes/library.h"

namespace noonmark {

Model load_model(const std::string& path, const Pose& pose, bool masks) {
  try {
    std::optional<size_t> animation;
    if (pose.time_s) animation = static_cast<size_t>(pose.animation);
    gltf::Document document = gltf::read_document(path, animation);
    gltf::Buffers buffers(document);
    Scene scene;
    scene.name = std::filesystem::path(path).stem().string();
    scene.notes = document.guarded.notes;
    if (pose.time_s) {
      gltf::Readers readers(document, buffers);
      gltf::pose(document, readers, *pose.time_s, scene.notes);
    }
    const gltf::Placement placement = gltf::place_nodes(document, scene.notes);
    const uint64_t without_area = gltf::append_geometry(document, buffers, placement, masks, scene);
    if (scene.triangles.empty()) {
      gltf::refuse(path, "",
                   "the scene that it shows holds no triangles" +
                       gltf::instead_of_triangles(document, placement.nodes, without_area),
                   "export meshes of triangles, in the default scene and with an area");
    }
    gltf::note_contents(document, placement.nodes, masks, scene.notes);
    ModelContents contents = gltf::count_contents(document);
    scene.cameras = gltf::find_cameras(document, placement.nodes, scene);
    contents.gives_camera = !scene.cameras.empty();
    scene.camera = contents.gives_camera ? *scene.cameras.front().value : fit_camera(scene);
    scene.lights = gltf::find_lights(document, placement.nodes, scene);
    contents.gives_light = !scene.lights.empty();
    scene.light = contents.gives_light ? *scene.lights.front().value : fit_light(scene);
    return {std::move(scene), contents};
  } catch (const std::bad_alloc&) {
    gltf::refuse(path, "", "does not fit into memory", "simplify it, or use a machine with more");
  }
}

Scene load_gltf(const std::string& path, const Pose& pose, bool masks) { return load_model(path, pose, masks).scene; }

}  // namespace noonmark
