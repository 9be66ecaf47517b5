#include "scenes/gltf/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scenes/gltf/error.h"
#include "scenes/gltf/notes.h"
#include "scenes/number_ranges.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view node_remedy = "correct the node in the modelling program and export again";
// Exporters write quaternions as floats, or from 8-bit values. A quaternion further from unit length is not a rotation.
constexpr double unit_tolerance = 0.01;
constexpr int no_parent = -1;

std::string place_of(size_t node) { return fmt::format("nodes[{}]", node); }

std::vector<int> find_parents(const Document& document) {
  const auto& nodes = document.model.nodes;
  std::vector<int> parents(nodes.size(), no_parent);
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (int child : nodes[i].children) {
      int& parent = parents[static_cast<size_t>(child)];
      if (parent != no_parent) {
        refuse(document.file, place_of(i) + ".children",
               fmt::format("nodes[{}] is already a child of nodes[{}]", child, parent),
               "give every node one parent and name it once");
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

// Every node has at most one parent. So a walk from the roots meets every node once, except nodes on a cycle.
void refuse_cycles(const Document& document, const std::vector<int>& parents) {
  const auto& nodes = document.model.nodes;
  std::vector<bool> met(nodes.size(), false);
  std::vector<size_t> open;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] == no_parent) open.push_back(i);
  }
  while (!open.empty()) {
    const size_t node = open.back();
    open.pop_back();
    met[node] = true;
    for (int child : nodes[node].children) open.push_back(static_cast<size_t>(child));
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!met[i])
      refuse(document.file, place_of(i), "is its own ancestor, or below a node that is", "break the cycle of children");
  }
}

bool all_finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

// 1 for right angles between unit axes, 0 for axes in one plane. The transform's scale has no influence.
double relative_determinant(const glm::dmat4& m) {
  const glm::dmat3 axes(m);
  const double lengths = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return lengths > 0 && std::isfinite(lengths) ? std::abs(glm::determinant(axes)) / lengths : 0;
}

// Checks the parts of a node's transform that tinygltf does not check.
void check_local_transform(const Document& document, size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  if (const auto& m = node.matrix; !m.empty() && (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1))
    refuse(document.file, place_of(index) + ".matrix", "its last row is not 0 0 0 1", node_remedy);
  if (const auto& r = node.rotation; !r.empty()) {
    const double length = glm::length(glm::dquat(r[3], r[0], r[1], r[2]));
    if (!(std::abs(length - 1) <= unit_tolerance))
      refuse(document.file, place_of(index) + ".rotation",
             fmt::format("a quaternion of length {} instead of 1", length), node_remedy);
  }
}

glm::dmat4 local_transform(const tinygltf::Node& node) {
  glm::dmat4 m(1);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
    return m;
  }
  glm::dmat3 axes(1);
  if (!node.rotation.empty())
    axes = glm::mat3_cast(
        glm::normalize(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 column = axes[axis] * (node.scale.empty() ? 1.0 : node.scale[static_cast<size_t>(axis)]);
    m[axis] = glm::dvec4(column, 0);
    if (!node.translation.empty()) m[3][axis] = node.translation[static_cast<size_t>(axis)];
  }
  return m;
}

bool scaled_to_zero(const tinygltf::Node& node) {
  return node.matrix.empty() && node.scale.size() == 3 && node.scale[0] == 0 && node.scale[1] == 0 &&
         node.scale[2] == 0;
}

bool visible(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  return found == node.extensions.end() || !found->second.Has("visible") || found->second.Get("visible").Get<bool>();
}

void check_place(const Document& document, size_t node, const glm::dmat4& world) {
  if (!all_finite(world)) refuse(document.file, place_of(node), "its place in the world is not finite", node_remedy);
  if (!is_in_world(glm::dvec3(world[3])))
    refuse(document.file, place_of(node),
           fmt::format("stands more than {} m from the origin", ranges::coordinate_m.most),
           "scale the scene to metres");
}

// Places every node of the file.
std::vector<PlacedNode> place_all(const Document& document, const std::vector<int>& parents) {
  const auto& nodes = document.model.nodes;
  std::vector<PlacedNode> placed(nodes.size());
  std::vector<size_t> open;
  for (size_t i = nodes.size(); i-- > 0;) {
    if (parents[i] == no_parent) open.push_back(i);
  }
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    PlacedNode& here = placed[i];
    here = {i, local_transform(nodes[i]), visible(nodes[i]), scaled_to_zero(nodes[i])};
    if (parents[i] != no_parent) {
      const PlacedNode& parent = placed[static_cast<size_t>(parents[i])];
      here.world_from_node = parent.world_from_node * here.world_from_node;
      here.visible = here.visible && parent.visible;
      here.collapsed = here.collapsed || parent.collapsed;
    }
    for (int child : nodes[i].children) open.push_back(static_cast<size_t>(child));
  }
  return placed;
}

// The roots of the scene that is shown, each once.
std::vector<size_t> find_roots(const Document& document, const std::vector<int>& parents,
                               std::vector<std::string>& notes) {
  const tinygltf::Model& model = document.model;
  std::vector<size_t> roots;
  if (model.scenes.empty()) {
    for (size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == no_parent) roots.push_back(i);
    }
    notes.push_back("it lists no scenes, so all its nodes are shown");
    return roots;
  }
  const size_t shown = static_cast<size_t>(model.defaultScene == -1 ? 0 : model.defaultScene);
  if (model.scenes.size() > 1) notes.push_back(fmt::format("scene {} of {} is shown", shown, model.scenes.size()));

  std::vector<bool> listed(model.nodes.size(), false);
  uint64_t twice = 0, below = 0, children = 0;
  for (int root : model.scenes[shown].nodes) {
    if (listed[static_cast<size_t>(root)]) {
      ++twice;
      continue;
    }
    listed[static_cast<size_t>(root)] = true;
    roots.push_back(static_cast<size_t>(root));
  }
  // below_listed[i]: an ancestor of i is listed, so i is drawn with that ancestor.
  std::vector<bool> below_listed(model.nodes.size(), false);
  std::vector<size_t> open;
  for (size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == no_parent) open.push_back(i);
  }
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    for (int child : model.nodes[i].children) {
      below_listed[static_cast<size_t>(child)] = listed[i] || below_listed[i];
      open.push_back(static_cast<size_t>(child));
    }
  }
  std::erase_if(roots, [&](size_t root) {
    children += parents[root] != no_parent && !below_listed[root];
    below += below_listed[root];
    return below_listed[root];
  });
  if (twice > 0) notes.push_back(counted(twice, "node") + " that the scene lists twice, drawn once");
  if (below > 0) notes.push_back(counted(below, "node") + " that the scene lists beside an ancestor, drawn once");
  if (children > 0)
    notes.push_back(fmt::format("{} of the scene that {} parents, drawn where the parents place them",
                                counted(children, "root"), children == 1 ? "has" : "have"));
  return roots;
}

}  // namespace

Placement place_nodes(const Document& document, std::vector<std::string>& notes) {
  const std::vector<int> parents = find_parents(document);
  refuse_cycles(document, parents);
  const std::vector<PlacedNode> all = place_all(document, parents);
  std::vector<size_t> open = find_roots(document, parents, notes);
  std::reverse(open.begin(), open.end());
  Placement placement;
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    check_local_transform(document, i);
    check_place(document, i, all[i].world_from_node);
    placement.nodes.push_back(all[i]);
    const std::vector<int>& children = document.model.nodes[i].children;
    for (size_t k = children.size(); k-- > 0;) open.push_back(static_cast<size_t>(children[k]));
  }
  for (const PlacedNode& one : all) placement.world_from_node.push_back(one.world_from_node);
  return placement;
}

bool flattens(const glm::dmat4& transform) {
  // Below this value the three axes lie in a plane within double arithmetic (16 digits, minus the loss of the
  // products).
  constexpr double least_determinant = 1e-12;
  return !(relative_determinant(transform) > least_determinant);
}

void require_invertible(const Document& document, const PlacedNode& placed) {
  if (flattens(placed.world_from_node)) {
    refuse(document.file, place_of(placed.node),
           "its transform cannot be inverted, because it flattens the nodes below it",
           "give every axis a scale other than 0");
  }
}

}  // namespace noonmark::gltf
