// The text of a file is parsed once, by parse_json (json.h). tinygltf then parses another, shorter text: what the guard
// has left of the document. It cannot be given the document itself: TinyGLTF takes text and bytes only
// (LoadASCIIFromString, LoadBinaryFromMemory and the two that read a file), and the function that parses,
// TinyGLTF::LoadFromString, is private, makes its own nlohmann::json from the text and reads the model from that. No
// option of the header (TINYGLTF_...) changes this; they only choose another JSON library. It cannot be given the text
// of the file either, because what the guard refuses cannot be seen in the model: keys that stand twice, values of a
// wrong type, integers that do not fit.
#include "scenes/gltf/document.h"

#include <utility>

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
