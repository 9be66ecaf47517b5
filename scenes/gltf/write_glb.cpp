#include "scenes/gltf/write_glb.h"

#include <tiny_gltf.h>

#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <sstream>
#include <stdexcept>

namespace noonmark {
namespace {

constexpr int float_type = TINYGLTF_COMPONENT_TYPE_FLOAT;

// Appends vectors to the one buffer, as a view and an accessor. Returns the accessor's index.
int add_vectors(tinygltf::Model& model, const std::vector<glm::vec3>& values, bool with_bounds) {
  std::vector<unsigned char>& bytes = model.buffers[0].data;
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = bytes.size();
  view.byteLength = values.size() * sizeof(glm::vec3);
  view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
  bytes.resize(view.byteOffset + view.byteLength);
  std::memcpy(bytes.data() + view.byteOffset, values.data(), view.byteLength);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size());
  accessor.componentType = float_type;
  accessor.type = TINYGLTF_TYPE_VEC3;
  accessor.count = values.size();
  if (with_bounds) {
    glm::vec3 low = values[0], high = values[0];
    for (const glm::vec3& v : values) low = glm::min(low, v), high = glm::max(high, v);
    accessor.minValues = {low.x, low.y, low.z};
    accessor.maxValues = {high.x, high.y, high.z};
  }
  model.bufferViews.push_back(std::move(view));
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size()) - 1;
}

// The triangles [first, end) of one material as a primitive without indices.
tinygltf::Primitive primitive_of(const Scene& scene, size_t first, size_t end, int material, tinygltf::Model& model) {
  std::vector<glm::vec3> positions, normals;
  for (size_t t = first; t < end; ++t) {
    const glm::uvec3 corners = scene.triangles[t];
    const glm::dvec3 a = scene.positions[corners.x], b = scene.positions[corners.y], c = scene.positions[corners.z];
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double area = glm::length(across);
    const glm::vec3 normal = area > 0 ? glm::vec3(across / area) : glm::vec3(0, 1, 0);  // glTF asks for a unit vector
    for (int k = 0; k < 3; ++k) {
      positions.push_back(scene.positions[corners[k]]);
      normals.push_back(normal);
    }
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = material;
  primitive.attributes["POSITION"] = add_vectors(model, positions, true);
  primitive.attributes["NORMAL"] = add_vectors(model, normals, false);
  return primitive;
}

// A node at `eye` that looks along its -Z at `target` (glTF 2.0, section 3.10.1).
tinygltf::Node looking(const char* name, glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up) {
  const glm::dvec3 back = glm::normalize(eye - target);
  glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 1e-6 * glm::length(up)))  // a light straight from above: any roll
    right = glm::cross(std::abs(back.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), back);
  right = glm::normalize(right);
  const glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
  tinygltf::Node node;
  node.name = name;
  node.translation = {eye.x, eye.y, eye.z};
  node.rotation = {q.x, q.y, q.z, q.w};
  return node;
}

void add_camera(const Camera& camera, tinygltf::Model& model) {
  if (!camera.near_m || !camera.far_m) throw std::logic_error("a glTF camera has near and far");
  tinygltf::Camera made;
  if (camera.projection == Projection::orthographic) {
    made.type = "orthographic";
    made.orthographic.xmag = made.orthographic.ymag = camera.height_m / 2;
    made.orthographic.znear = *camera.near_m;
    made.orthographic.zfar = *camera.far_m;
  } else {
    made.type = "perspective";
    made.perspective.yfov = glm::radians(camera.fov_y_deg);
    made.perspective.znear = *camera.near_m;
    made.perspective.zfar = *camera.far_m;
  }
  tinygltf::Node node = looking("camera", camera.eye_m, camera.target_m, camera.up);
  node.camera = 0;
  model.cameras.push_back(std::move(made));
  model.nodes.push_back(std::move(node));
}

void add_light(const Light& light, const std::string& name, tinygltf::Model& model) {
  tinygltf::Light made;
  made.name = name;
  made.intensity = light.power.intensity;
  made.color = {light.power.color.x, light.power.color.y, light.power.color.z};
  made.range = light.power.range_m.value_or(0);  // tinygltf writes no range of 0
  made.type = light.kind == LightKind::directional ? "directional" : light.kind == LightKind::spot ? "spot" : "point";
  if (light.kind == LightKind::spot) {
    made.spot.innerConeAngle = glm::radians(light.power.inner_cone_deg) / 2;
    made.spot.outerConeAngle = glm::radians(light.cone_deg) / 2;
  }
  tinygltf::Node node;
  if (light.kind == LightKind::point) {
    node.name = made.name;
    node.translation = {light.position_m.x, light.position_m.y, light.position_m.z};
  } else {
    node = looking(name.c_str(), light.position_m, light.target_m, {0, 1, 0});
  }
  const auto number = static_cast<int>(model.lights.size());
  node.extensions["KHR_lights_punctual"] = tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(number)}});
  // tinygltf 2.9 has a member for it, and leaves the extension out where that is not set.
  [number](auto& any) {
    if constexpr (requires { any.light; }) any.light = number;
  }(node);
  model.lights.push_back(std::move(made));
  model.nodes.push_back(std::move(node));
}

}  // namespace

std::string glb_of(const Scene& scene, const Camera& camera, const Light& light,
                   std::span<const Named<Light>> more_lights) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "Noonmark";
  model.buffers.emplace_back();
  for (const bool both : {true, false}) {
    tinygltf::Material material;
    material.name = both ? "seen from both sides" : "seen from the front";
    material.doubleSided = both;
    material.pbrMetallicRoughness.metallicFactor = 0;
    model.materials.push_back(std::move(material));
  }
  const auto material_of = [&](size_t t) { return scene.single_sided.empty() || !scene.single_sided[t] ? 0 : 1; };
  const auto add_part = [&](const std::string& name, size_t first, size_t end) {
    tinygltf::Mesh mesh;
    mesh.name = name;
    for (size_t t = first; t < end;) {
      size_t next = t + 1;
      while (next < end && material_of(next) == material_of(t)) ++next;
      mesh.primitives.push_back(primitive_of(scene, t, next, material_of(t), model));
      t = next;
    }
    if (mesh.primitives.empty()) return;
    tinygltf::Node node;
    node.name = name;
    node.mesh = static_cast<int>(model.meshes.size());
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
  };
  size_t written = 0;
  for (const Part& part : scene.parts) {
    add_part(part.name, part.first_triangle, part.first_triangle + part.triangle_count);
    written = part.first_triangle + part.triangle_count;
  }
  add_part("rest", written, scene.triangles.size());
  add_camera(camera, model);
  const auto name_of = [](const Named<Light>& one) { return one.name.empty() ? one.node : one.name; };
  add_light(light, more_lights.empty() || scene.lights.empty() ? "light" : name_of(scene.lights.front()), model);
  for (const Named<Light>& more : more_lights)
    if (more.value) add_light(*more.value, name_of(more), model);
  tinygltf::Scene all;
  for (size_t n = 0; n < model.nodes.size(); ++n) all.nodes.push_back(static_cast<int>(n));
  model.scenes.push_back(std::move(all));
  model.defaultScene = 0;
  std::ostringstream bytes;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, bytes, false, true))
    throw std::logic_error("tinygltf cannot write the scene");
  return std::move(bytes).str();
}

}  // namespace noonmark
