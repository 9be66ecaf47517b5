#include "scenes/gltf_document.h"

#include "scenes/gltf_container.h"
#include "scenes/gltf_error.h"

namespace noonmark::gltf {
namespace {

// tinygltf has nothing to read: the guard leaves it neither buffers nor images. Should it try, it finds nothing.
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

Document read_document(const std::string& file) {
  Container container = read_container(file);
  GuardedDocument guarded = guard(file, container.json);
  Document out;
  out.file = file;
  out.buffers = std::move(guarded.buffers);
  out.bin = std::move(container.bin);
  out.has_bin = container.has_bin;
  out.quantized = guarded.quantized;

  const std::string json = guarded.json.dump();
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

}  // namespace noonmark::gltf
