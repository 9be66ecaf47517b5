#include "scenes/gltf/animation.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <set>

#include "scenes/gltf/error.h"
#include "scenes/gltf/notes.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view animation_remedy = "export the animation again, or leave scene.time_s at auto";

enum class Path { translation, rotation, scale, weights, visible };

struct Target {
  Path path = Path::translation;
  size_t node = 0;
  std::optional<size_t> mesh;  // weights of a mesh rather than of a node
};

// Reads "/nodes/3/translation" and similar pointers (KHR_animation_pointer). No value for properties that do not change
// shadows.
std::optional<Target> pointed_at(const std::string& pointer) {
  size_t index = 0;
  int used = 0;
  const auto rest_after = [&](const char* pattern) {
    used = 0;
    return std::sscanf(pointer.c_str(), pattern, &index, &used) == 1 && used > 0
               ? pointer.substr(static_cast<size_t>(used))
               : std::string();
  };
  const std::string of_node = rest_after("/nodes/%9zu/%n");
  if (of_node == "translation") return Target{Path::translation, index, {}};
  if (of_node == "rotation") return Target{Path::rotation, index, {}};
  if (of_node == "scale") return Target{Path::scale, index, {}};
  if (of_node == "weights") return Target{Path::weights, index, {}};
  if (of_node == "extensions/KHR_node_visibility/visible") return Target{Path::visible, index, {}};
  if (rest_after("/meshes/%9zu/%n") == "weights") return Target{Path::weights, 0, index};
  return std::nullopt;
}

class Poser {
 public:
  Poser(Document& document, Readers& readers, double time_s, std::vector<std::string>& notes)
      : d_(document), readers_(readers), time_(time_s), notes_(notes) {}

  void all() {
    const json& animation = d_.guarded.animation;
    uint64_t others = 0;
    for (size_t i = 0; i < animation["channels"].size(); ++i) {
      const json& channel = animation["channels"][i];
      place_ = fmt::format("the animation's channels[{}]", i);
      const size_t sampler = channel["sampler"].get<size_t>();
      if (sampler >= animation["samplers"].size())
        fail(fmt::format("sampler {} is beyond the {} samplers", sampler, animation["samplers"].size()));
      const std::optional<Target> target = target_of(channel["target"]);
      if (!target) {
        ++others;
        continue;
      }
      apply(*target, animation["samplers"][sampler]);
    }
    if (animation["channels"].empty()) notes_.push_back("the animation has no channels, so scene.time_s moves nothing");
    if (others > 0)
      notes_.push_back(counted(others, "channel") + " of the animation not read: not for nodes or morph targets");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { refuse(d_.file, place_, what, animation_remedy); }

  std::optional<Target> target_of(const json& target) const {
    const std::string path = target["path"].get<std::string>();
    Target out;
    if (path == "pointer") {
      const json::json_pointer inner("/extensions/KHR_animation_pointer/pointer");
      const std::optional<Target> found =
          target.contains(inner) ? pointed_at(target[inner].get<std::string>()) : std::nullopt;
      if (!found) return std::nullopt;
      out = *found;
    } else {
      if (!target.contains("node"))
        return std::nullopt;  // channels of extensions have to be ignored (glTF 2.0, section 5.3)
      out.node = target["node"].get<size_t>();
      if (path == "translation")
        out.path = Path::translation;
      else if (path == "rotation")
        out.path = Path::rotation;
      else if (path == "scale")
        out.path = Path::scale;
      else if (path == "weights")
        out.path = Path::weights;
      else
        return std::nullopt;
    }
    if (out.mesh ? *out.mesh >= d_.model.meshes.size() : out.node >= d_.model.nodes.size())
      fail(out.mesh ? fmt::format("mesh {} is beyond the {} meshes", *out.mesh, d_.model.meshes.size())
                    : fmt::format("node {} is beyond the {} nodes", out.node, d_.model.nodes.size()));
    return out;
  }

  const tinygltf::Accessor& accessor(const json& sampler, const char* name) const {
    const size_t index = sampler[name].get<size_t>();
    if (index >= d_.model.accessors.size())
      fail(fmt::format("{} {} is beyond the {} accessors", name, index, d_.model.accessors.size()));
    if (const auto unknown = d_.guarded.unknown_accessors.find(index); unknown != d_.guarded.unknown_accessors.end())
      refuse(d_.file, fmt::format("accessors[{}]", index), unknown->second, animation_remedy);
    return d_.model.accessors[index];
  }

  // The keys of a sampler. Their times are finite and strictly ascending. Each sampler is checked once, even if several
  // channels share it.
  const AccessorReader& times(const json& sampler) {
    const tinygltf::Accessor& a = accessor(sampler, "input");
    const int index = sampler["input"].get<int>();
    if (a.type != TINYGLTF_TYPE_SCALAR || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      fail(fmt::format("accessors[{}] is not a list of times (FLOAT, SCALAR)", index));
    const AccessorReader& keys = readers_(index);
    if (!checked_.insert(index).second) return keys;
    for (size_t i = 0; i < keys.count(); ++i) {
      const double here = keys.value(i, 0);
      if (std::isfinite(here) && (i == 0 || keys.value(i - 1, 0) < here)) continue;
      fail(fmt::format("accessors[{}]: time {} is {}, not finite or not after the one before", index, i, here));
    }
    return keys;
  }

  static size_t width_of(Path path) { return path == Path::rotation ? 4 : path == Path::visible ? 1 : 3; }

  bool fits(Path path, const tinygltf::Accessor& a) const {
    const bool is_float = a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
    switch (path) {
      case Path::translation:
      case Path::scale:
        return a.type == TINYGLTF_TYPE_VEC3 && is_float;
      case Path::rotation:
        return a.type == TINYGLTF_TYPE_VEC4 && (is_float || a.normalized);
      case Path::weights:
        return a.type == TINYGLTF_TYPE_SCALAR && (is_float || a.normalized);
      case Path::visible:
        return a.type == TINYGLTF_TYPE_SCALAR && a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    }
    return false;
  }

  // The number of values that a key has. For weights it is the number of targets.
  size_t width_of(const Target& target) const {
    if (target.path != Path::weights) return width_of(target.path);
    const int of_node = target.mesh ? -1 : d_.model.nodes[target.node].mesh;
    if (!target.mesh && of_node == -1) fail(fmt::format("weights of nodes[{}], which has no mesh", target.node));
    const tinygltf::Mesh& mesh = d_.model.meshes[target.mesh ? *target.mesh : static_cast<size_t>(of_node)];
    if (mesh.primitives.empty() || mesh.primitives[0].targets.empty()) fail("weights of a mesh without morph targets");
    return mesh.primitives[0].targets.size();
  }

  std::vector<double> sample(const Target& target, const json& sampler) {
    const AccessorReader& keys = times(sampler);
    const tinygltf::Accessor& a = accessor(sampler, "output");
    const int output = sampler["output"].get<int>();
    const std::string how = sampler.value("interpolation", "LINEAR");
    const bool cubic = how == "CUBICSPLINE";
    if (!cubic && how != "LINEAR" && how != "STEP")
      fail(fmt::format("interpolation '{}' is not defined by glTF", printable(how)));
    const size_t width = width_of(target);
    if (!fits(target.path, a))
      fail(fmt::format("accessors[{}] does not have the type of the property that it moves", output));
    // The elements of a key. Weights are SCALARs, one after the other.
    const size_t elements = target.path == Path::weights ? width : 1;
    const size_t each = elements * (cubic ? 3 : 1);
    if (a.count / each != keys.count() || a.count % each != 0)
      fail(fmt::format("accessors[{}] has {} values for {} keys of {}", output, a.count, keys.count(), each));
    const AccessorReader& values = readers_(output);
    // which: for a cubic key, 0 is its in-tangent, 1 its value, 2 its out-tangent.
    const auto read = [&](size_t key, size_t which) {
      std::vector<double> out(width);
      const size_t first = key * each + (cubic ? which * elements : 0);
      for (size_t k = 0; k < width; ++k) {
        out[k] = elements == 1 ? values.value(first, k) : values.value(first + k, 0);
        if (!std::isfinite(out[k])) fail(fmt::format("accessors[{}]: the value of key {} is not finite", output, key));
      }
      return out;
    };

    size_t low = 0, high = keys.count();  // the last key at or before the time is low, unless all are after it
    while (high - low > 1) {
      const size_t middle = low + (high - low) / 2;
      (keys.value(middle, 0) <= time_ ? low : high) = middle;
    }
    const double before = keys.value(low, 0);
    if (time_ <= before || low + 1 == keys.count() || how == "STEP") return read(low, 1);
    const double step = keys.value(low + 1, 0) - before, t = (time_ - before) / step;
    std::vector<double> from = read(low, 1);
    const std::vector<double> to = read(low + 1, 1);
    if (cubic) {
      const std::vector<double> out = read(low, 2), in = read(low + 1, 0);
      const double t2 = t * t, t3 = t2 * t;
      for (size_t k = 0; k < width; ++k)
        from[k] = (2 * t3 - 3 * t2 + 1) * from[k] + step * (t3 - 2 * t2 + t) * out[k] + (3 * t2 - 2 * t3) * to[k] +
                  step * (t3 - t2) * in[k];
    } else if (target.path == Path::rotation) {
      const glm::dquat q = glm::slerp(quaternion(from), quaternion(to), t);
      from = {q.x, q.y, q.z, q.w};
    } else {
      for (size_t k = 0; k < width; ++k) from[k] += t * (to[k] - from[k]);
    }
    return from;
  }

  glm::dquat quaternion(const std::vector<double>& q) const {
    const glm::dquat out(q[3], q[0], q[1], q[2]);
    if (!(glm::length(out) > 0)) fail("a quaternion of length 0");
    return glm::normalize(out);
  }

  void apply(const Target& target, const json& sampler) {
    std::vector<double> value = sample(target, sampler);
    if (target.mesh) {
      d_.model.meshes[*target.mesh].weights = std::move(value);
      return;
    }
    tinygltf::Node& node = d_.model.nodes[target.node];
    if (!node.matrix.empty() && target.path != Path::weights && target.path != Path::visible)
      fail(fmt::format("moves nodes[{}], which has a matrix", target.node));
    switch (target.path) {
      case Path::translation:
        node.translation = std::move(value);
        break;
      case Path::scale:
        node.scale = std::move(value);
        break;
      case Path::rotation: {
        const glm::dquat q = quaternion(value);
        node.rotation = {q.x, q.y, q.z, q.w};
        break;
      }
      case Path::weights:
        node.weights = std::move(value);
        break;
      case Path::visible: {
        tinygltf::Value::Object visibility{{"visible", tinygltf::Value(value[0] != 0)}};
        node.extensions["KHR_node_visibility"] = tinygltf::Value(std::move(visibility));
        break;
      }
    }
  }

  Document& d_;
  Readers& readers_;
  double time_;
  std::vector<std::string>& notes_;
  std::string place_;
  std::set<int> checked_;
};

}  // namespace

void pose(Document& document, Readers& readers, double time_s, std::vector<std::string>& notes) {
  Poser(document, readers, time_s, notes).all();
}

}  // namespace noonmark::gltf
