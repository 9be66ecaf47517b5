// The text of a file is parsed once, by parse_json (json.h). tinygltf then parses another, shorter text: what the guard
// has left of the document. It cannot be given the document itself: TinyGLTF takes text and bytes only
// (LoadASCIIFromString, LoadBinaryFromMemory and the two that read a file), and the function that parses,
// TinyGLTF::LoadFromString, is private, makes its own nlohmann::json from the text and reads the model from that. No
// option of the header (TINYGLTF_...) changes this; they only choose another JSON library. It cannot be given the text
// of the file either, because what the guard refuses cannot be seen in the model: keys that stand twice, values of a
// wrong type, integers that do not fit.
#include "scenes/gltf/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>
#include <utility>

#include "base/memory.h"
#include "scenes/gltf/container.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/json.h"
#include "scenes/gltf/precheck.h"
#include "scenes/gltf/structure.h"

namespace noonmark::gltf {
namespace {

// tinygltf does not need to read files, because the guard leaves it neither buffers nor images. If it tries, it finds
// none.
tinygltf::FsCallbacks no_files() {
  tinygltf::FsCallbacks fs{};
  fs.FileExists = [](const std::string&, void*) { return false; };
  fs.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
  fs.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
  fs.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; };
  return fs;
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  return printable(text);
}

// Checks that tinygltf's model fits into memory, before the model is made. This is necessary because an empty material
// takes 2 bytes in a file and 2 kB in the model. document: what the guard has left; text_bytes: its length as text.
void require_room(const std::string& file, const nlohmann::json& document, size_t text_bytes) {
  struct Size {
    std::string_view list;
    size_t bytes;
  };
  constexpr std::array<Size, 9> sizes = {{{"accessors", sizeof(tinygltf::Accessor)},
                                          {"bufferViews", sizeof(tinygltf::BufferView)},
                                          {"cameras", sizeof(tinygltf::Camera)},
                                          {"materials", sizeof(tinygltf::Material)},
                                          {"meshes", sizeof(tinygltf::Mesh)},
                                          {"nodes", sizeof(tinygltf::Node)},
                                          {"primitives", sizeof(tinygltf::Primitive)},
                                          {"scenes", sizeof(tinygltf::Scene)},
                                          {"skins", sizeof(tinygltf::Skin)}}};
  constexpr double while_it_grows = 1.5;  // a list that doubles its capacity holds its old half too
  constexpr double text_to_tree = 14;     // measured peak per byte of text, for nodes, meshes and accessors
  double objects = 0;
  const auto add = [&](const nlohmann::json& lists) {
    for (const Size& size : sizes)
      if (const auto list = lists.find(size.list); list != lists.end())
        objects += while_it_grows * static_cast<double>(list->size() * size.bytes);
  };
  add(document);
  if (const auto meshes = document.find("meshes"); meshes != document.end())
    for (const nlohmann::json& mesh : *meshes) add(mesh);
  // The larger one, because the model is part of both.
  const double needed = std::max(objects, text_to_tree * static_cast<double>(text_bytes));
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes)) {
    refuse(file, "", fmt::format("its JSON takes about {} of memory and {}", bytes_text(needed), available.text()),
           "simplify it or split it, or use a machine with more memory");
  }
}

}  // namespace

Document read_document(const std::string& file, std::optional<size_t> animation) {
  Document out;
  out.file = file;
  nlohmann::json read;
  {
    Container container = read_container(file);
    read = parse_json(file, container.json, root_properties(animation.has_value()));
    out.bin = std::move(container.bin);
    out.has_bin = container.has_bin;
  }  // the text is not needed any more
  out.guarded = guard(file, std::move(read), animation);

  const std::string json = out.guarded.json.dump();
  require_room(file, out.guarded.json, json.size());
  out.guarded.json = nullptr;
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(no_files());
  parser.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  std::string error, warning;
  bool parsed = false;
  try {
    parsed = parser.LoadASCIIFromString(&out.model, &error, &warning, json.data(),
                                        static_cast<unsigned int>(json.size()), "");
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!parsed) {
    refuse(file, "", error.empty() ? "is not a usable glTF" : one_line(error), "export the file again, or correct it");
  }
  check_structure(out);
  return out;
}

int indices_of(const tinygltf::Primitive& primitive) {
  const auto found = primitive.attributes.find(indices_attribute);
  return found == primitive.attributes.end() ? -1 : found->second;
}

}  // namespace noonmark::gltf
