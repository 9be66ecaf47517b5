#include "tests/scenes/gltf/second_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <map>

namespace noonmark::test {
namespace {

glm::dmat4 matrix(const aiMatrix4x4& m) {
  glm::dmat4 out;
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column)
      out[static_cast<int>(column)][static_cast<int>(row)] = static_cast<double>(m[row][column]);
  }
  return out;
}

glm::dvec3 point(const aiVector3D& p) { return {p.x, p.y, p.z}; }

using Worlds = std::map<std::string, glm::dmat4>;

void place(const aiNode& node, const glm::dmat4& parent, Worlds& worlds) {
  const glm::dmat4 world = parent * matrix(node.mTransformation);
  // Assimp identifies bones by name. If a joint and a node with a mesh have the same name, the name is the joint's.
  if (node.mNumMeshes == 0)
    worlds[node.mName.C_Str()] = world;
  else
    worlds.emplace(node.mName.C_Str(), world);
  for (unsigned i = 0; i < node.mNumChildren; ++i) place(*node.mChildren[i], world, worlds);
}

std::vector<glm::dvec3> positions(const aiMesh& mesh, const glm::dmat4& world, const Worlds& worlds) {
  std::vector<glm::dvec3> out;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    glm::dvec3 p = point(mesh.mVertices[v]);
    for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) {
      const aiAnimMesh& target = *mesh.mAnimMeshes[k];
      if (target.mVertices != nullptr)
        p += static_cast<double>(target.mWeight) * (point(target.mVertices[v]) - point(mesh.mVertices[v]));
    }
    out.push_back(p);
  }
  if (mesh.mNumBones == 0) {
    for (glm::dvec3& p : out) p = glm::dvec3(world * glm::dvec4(p, 1));
    return out;
  }
  std::vector<glm::dvec4> sum(out.size(), glm::dvec4(0));
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto joint = worlds.find(bone.mName.C_Str());
    if (joint == worlds.end()) continue;
    const glm::dmat4 m = joint->second * matrix(bone.mOffsetMatrix);
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      sum[weight.mVertexId] += static_cast<double>(weight.mWeight) * (m * glm::dvec4(out[weight.mVertexId], 1));
    }
  }
  for (size_t v = 0; v < out.size(); ++v) out[v] = glm::dvec3(sum[v]) / sum[v].w;
  return out;
}

void collect(const aiScene& scene, const aiNode& node, const glm::dmat4& parent, const Worlds& worlds,
             SecondReading& out) {
  const glm::dmat4 world = parent * matrix(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const std::vector<glm::dvec3> at = positions(mesh, world, worlds);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      out.triangles.push_back({at[face.mIndices[0]], at[face.mIndices[1]], at[face.mIndices[2]]});
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], world, worlds, out);
}

}  // namespace

SecondReading read_by_assimp(const std::string& path) {
  SecondReading out;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    out.error = importer.GetErrorString();
    if (out.error.empty()) out.error = "no scene";
    return out;
  }
  Worlds worlds;
  place(*scene->mRootNode, glm::dmat4(1), worlds);
  collect(*scene, *scene->mRootNode, glm::dmat4(1), worlds, out);
  return out;
}

}  // namespace noonmark::test
