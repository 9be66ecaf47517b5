#include "app/image_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "app/image_codec.h"
#include "scenes/digest.h"
#include "scenes/error.h"
#include "scenes/file.h"

namespace noonmark {
namespace {

// why: the loader's message, "/usr/lib/libX.so.1: cannot open shared object file: ...".
std::string what_to_install(const std::string& why) {
  const std::string path = why.substr(0, why.find(": "));
  const std::string library = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  if (library == image_module_file)
    return "it belongs beside the program, or in lib/noonmark where bin/ is installed; build or install again";
  if (library.starts_with("libOpenImageIO")) return "on Debian, apt install libopenimageio2.4";
  return fmt::format("{} is a library that OpenImageIO needs; install the package that contains it", library);
}

// The loader searches the program's RUNPATH, which names places beside the program (app/CMakeLists.txt).
EncodeImage* load_encoder() {
  void* const module = dlopen(image_module_file, RTLD_NOW | RTLD_LOCAL);  // never closed
  void* const function = module ? dlsym(module, image_module_function) : nullptr;
  if (!function) {
    const char* const said = dlerror();
    const std::string why = said ? said : image_module_file;
    throw Error(ErrorKind::device, fmt::format("pictures cannot be written: {}; {}", why, what_to_install(why)));
  }
  return reinterpret_cast<EncodeImage*>(function);
}

EncodeImage& encoder() {
  static EncodeImage* const function = load_encoder();
  return *function;
}

std::string write(const ImageToEncode& image) {
  struct Result {
    bool encoded = false;
    std::string bytes;
  } result;
  encoder()(image, &result, [](void* context, bool encoded, const char* bytes, size_t count) {
    *static_cast<Result*>(context) = {encoded, std::string(bytes, count)};
  });
  if (!result.encoded) throw Error(ErrorKind::file, fmt::format("cannot write {}: {}", image.path, result.bytes));
  write_file_atomically(image.path, result.bytes);
  return digest_of(result.bytes);
}

}  // namespace

void require_image_files() { encoder(); }

std::string write_png(const std::string& path, const Image<Color>& picture) {
  return write({path.c_str(), picture.width, picture.height, 3, nullptr, picture.pixels.data()});
}

std::string write_exr(const std::string& path, const std::vector<Channel>& channels) {
  const int width = channels.at(0).values.width, height = channels.at(0).values.height;
  const size_t count = channels.size();
  std::vector<const char*> names;
  std::vector<float> pixels(static_cast<size_t>(width) * static_cast<size_t>(height) * count);
  for (size_t c = 0; c < count; ++c) {
    names.push_back(channels[c].name.c_str());
    if (channels[c].values.width != width || channels[c].values.height != height)
      throw std::logic_error("channels of one image differ in size");
    for (size_t i = 0; i < channels[c].values.size(); ++i) pixels[i * count + c] = channels[c].values[i];
  }
  return write({path.c_str(), width, height, static_cast<int>(count), names.data(), pixels.data()});
}

}  // namespace noonmark
