#include "scenes/gltf/document.h"

#include <utility>

#include "scenes/gltf/container.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/precheck.h"

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

}  // namespace

Document read_document(const std::string& file, std::optional<size_t> animation) {
  Container container = read_container(file);
  Document out;
  out.file = file;
  out.guarded = guard(file, container.json, animation);
  out.bin = std::move(container.bin);
  out.has_bin = container.has_bin;

  const std::string json = std::exchange(out.guarded.json, nullptr).dump();
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
