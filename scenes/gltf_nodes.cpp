#include "scenes/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scenes/gltf_error.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view remedy = "correct the node in the modelling program and export again";
// Exporters write quaternions as floats, or from 8-bit ones; what is further from unit length is no rotation.
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

// Every node has at most one parent, so a walk from the roots meets every node once, unless some are on a cycle.
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

// 1 for a right angle between unit axes, 0 for axes in one plane: free of the transform's scale.
double relative_determinant(const glm::dmat4& m) {
  const glm::dmat3 axes(m);
  const double lengths = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return lengths > 0 && std::isfinite(lengths) ? std::abs(glm::determinant(axes)) / lengths : 0;
}

glm::dmat4 local_transform(const Document& document, size_t index) {
  const tinygltf::Node& node = document.model.nodes[index];
  const std::string place = place_of(index);
  glm::dmat4 m(1);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) {
      refuse(document.file, place + ".matrix", "its last row is not 0 0 0 1", remedy);
    }
    return m;
  }
  glm::dmat3 axes(1);
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (!(std::abs(length - 1) <= unit_tolerance)) {
      refuse(document.file, place + ".rotation", fmt::format("a quaternion of length {} instead of 1", length), remedy);
    }
    axes = glm::mat3_cast(q / length);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 column = axes[axis] * (node.scale.empty() ? 1.0 : node.scale[static_cast<size_t>(axis)]);
    m[axis] = glm::dvec4(column, 0);
    if (!node.translation.empty()) m[3][axis] = node.translation[static_cast<size_t>(axis)];
  }
  return m;
}

bool hidden(const tinygltf::Node& node) {
  return node.matrix.empty() && node.scale.size() == 3 && node.scale[0] == 0 && node.scale[1] == 0 &&
         node.scale[2] == 0;
}

void check_transform(const Document& document, size_t node, const glm::dmat4& world) {
  // Below this the three axes lie in a plane as far as double arithmetic can tell (16 digits, less what products lose).
  constexpr double least_determinant = 1e-12;
  if (!all_finite(world)) refuse(document.file, place_of(node), "its place in the world is not finite", remedy);
  if (glm::any(glm::greaterThan(glm::abs(glm::dvec3(world[3])), glm::dvec3(max_coordinate_m)))) {
    refuse(document.file, place_of(node), fmt::format("stands more than {} m from the origin", max_coordinate_m),
           "scale the scene to metres");
  }
  if (!(relative_determinant(world) > least_determinant)) {
    refuse(document.file, place_of(node), "its transform cannot be inverted: it flattens what is below it",
           "give every axis a scale other than 0");
  }
}

}  // namespace

std::vector<PlacedNode> place_nodes(const Document& document) {
  const tinygltf::Model& model = document.model;
  const std::vector<int> parents = find_parents(document);
  refuse_cycles(document, parents);
  if (model.scenes.empty()) refuse(document.file, "scenes", "there is none", "export a scene, not a library of parts");
  const size_t shown = static_cast<size_t>(model.defaultScene == -1 ? 0 : model.defaultScene);

  std::vector<PlacedNode> open, placed;
  std::vector<bool> is_root(model.nodes.size(), false);
  const std::vector<int>& roots = model.scenes[shown].nodes;
  for (size_t i = 0; i < roots.size(); ++i) {
    const auto root = static_cast<size_t>(roots[i]);
    const std::string place = fmt::format("scenes[{}].nodes[{}]", shown, i);
    if (parents[root] != no_parent) {
      refuse(document.file, place, fmt::format("nodes[{}] is a child of nodes[{}], not a root", root, parents[root]),
             "list root nodes only");
    }
    if (is_root[root]) refuse(document.file, place, fmt::format("nodes[{}] is listed twice", root), "list it once");
    is_root[root] = true;
  }
  for (size_t i = roots.size(); i-- > 0;) open.push_back({static_cast<size_t>(roots[i]), glm::dmat4(1)});
  while (!open.empty()) {
    PlacedNode here = open.back();
    open.pop_back();
    const tinygltf::Node& node = model.nodes[here.node];
    if (hidden(node)) continue;
    here.world_from_node = here.world_from_node * local_transform(document, here.node);
    check_transform(document, here.node, here.world_from_node);
    placed.push_back(here);
    for (size_t i = node.children.size(); i-- > 0;) {
      open.push_back({static_cast<size_t>(node.children[i]), here.world_from_node});
    }
  }
  return placed;
}

}  // namespace noonmark::gltf
