#include "app/pictures/image_file.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "app/pictures/png_encoder.h"
#include "app/pictures/exr_encoder.h"
#include "app/pictures/image_codec.h"
#include "app/pictures/image_head.h"
#include "app/pictures/npy.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"

namespace noonmark {
namespace {

// why: the loader's message, "/usr/lib/libX.so.1: cannot open shared object file: ...".
std::string what_to_install(const std::string& why) {
  const std::string path = why.substr(0, why.find(": "));
  const std::string library = path.substr(path.rfind('/') + 1);  // npos + 1 is 0
  if (library == image_module_file)
    return "it belongs in lib/noonmark, beside the program's folder; build or install again";
  const std::string soname = "libOpenImageIO.so.";  // and its version, which the package has in its name
  if (library.starts_with(soname)) return "on Debian, apt install libopenimageio" + library.substr(soname.size());
  return fmt::format("{} is a library that OpenImageIO needs; install the package that contains it", library);
}

// The loader searches the program's RUNPATH, which names a place relative to the program (app/CMakeLists.txt).
template <class Function>
Function* load(const char* name) {
  void* const module = dlopen(image_module_file, RTLD_NOW | RTLD_LOCAL);  // never closed
  void* const function = module ? dlsym(module, name) : nullptr;
  if (!function) {
    const char* const said = dlerror();
    const std::string why = said ? said : image_module_file;
    throw Error(ErrorKind::device, fmt::format("pictures cannot be read: {}; {}", why, what_to_install(why)));
  }
  return reinterpret_cast<Function*>(function);
}

DecodeImage& decoder() {
  static DecodeImage* const function = load<DecodeImage>(image_module_decoder);
  return *function;
}

// libpng prints a line of its own about a damaged file. Errors that are thrown say the same, so until this object ends,
// the standard error goes nowhere.
class Quiet {
 public:
  Quiet() : kept_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    if (kept_ >= 0) dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~Quiet() {
    if (kept_ < 0) return;
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  int kept_;
};

[[noreturn]] void throw_cannot_write(const std::string& path, const char* why) {
  throw Error(ErrorKind::file, fmt::format("cannot write {}: {}", path, why));
}

std::string png_of(const std::string& path, const Image<Color>& picture) {
  try {
    return encoded_png(picture);
  } catch (const std::runtime_error& error) {
    throw_cannot_write(path, error.what());
  }
}

// Returns the digest of the file. rows: as encode_exr() asks for them.
std::string write_exr(const std::string& path, int width, int height, const std::vector<std::string>& channels,
                      int rows_at_once, const std::function<ExrRows(int first_row, int count)>& rows) {
  AtomicFile file(path);
  try {
    encode_exr(width, height, channels, rows_at_once, rows,
               [&](uint64_t offset, std::string_view bytes) { file.write_at(offset, bytes); });
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw_cannot_write(path, error.what());
  }
  std::string digest = file.digest();
  file.keep();
  return digest;
}

// At most 16 MiB of rows at a time. EXR compresses 16 rows together.
int rows_at_a_time(size_t row_bytes) {
  return static_cast<int>(std::clamp<size_t>((size_t{1} << 24) / row_bytes / 16, 1, 4096)) * 16;
}

}  // namespace

void require_image_reader() { decoder(); }

void require_image_memory(const std::string& path, double bytes) {
  if (const AvailableMemory available = available_memory(); bytes > static_cast<double>(available.bytes))
    throw Error(ErrorKind::file, fmt::format("{}: takes {} of memory to read, and {}; write a smaller picture", path,
                                             bytes_text(bytes), available.text()));
}

DecodedImage read_image(const std::string& path, const WantedImage& wanted) {
  constexpr uint64_t of_a_pixel = 64, of_the_head = uint64_t{16} << 20;  // more than any picture of three floats
  std::error_code none;
  if (const std::uintmax_t size = std::filesystem::file_size(path, none); !none)
    require_image_memory(path, static_cast<double>(size));
  const std::string bytes = read_file(path, of_the_head + of_a_pixel * most_image_pixels);
  if (is_npy(bytes)) return read_npy(path, bytes, wanted);
  const char* const format = bytes.starts_with("\x89PNG\r\n\x1a\n")  ? "png"
                             : bytes.starts_with("\x76\x2f\x31\x01") ? "exr"
                                                                     : nullptr;
  if (!format)
    throw Error(ErrorKind::file,
                fmt::format("{}: is neither a PNG nor an EXR nor an NPY file; write one of these", path));
  require_possible_head(path, format, bytes);
  struct Result {
    const WantedImage& wanted;
    DecodedImage image;
    std::exception_ptr unwanted;
    std::string why;
  } result{wanted, {}, {}, {}};
  result.image.path = path;
  DecodeImage& decode = decoder();
  const Quiet quiet;
  decode({.format = format,
          .bytes = bytes.data(),
          .count = bytes.size(),
          .context = &result,
          .place_for = [](void* context, const ImageHead& head) -> float* {
            Result& into = *static_cast<Result*>(context);
            DecodedImage& image = into.image;
            try {
              image.width = head.width;
              image.height = head.height;
              image.channels.assign(head.channel_names, head.channel_names + head.channels);
              if (head.alpha_channel >= 0) image.alpha = static_cast<size_t>(head.alpha_channel);
              image.stored_as = head.stored_as;
              make_room(image, into.wanted);
              return image.values.data();
            } catch (...) {
              into.unwanted = std::current_exception();
              return nullptr;
            }
          },
          .refused = [](void* context, const char* why) { static_cast<Result*>(context)->why = why; }});
  if (result.unwanted) std::rethrow_exception(result.unwanted);
  if (!result.why.empty()) throw Error(ErrorKind::file, fmt::format("{}: {}", path, result.why));
  return std::move(result.image);
}

void make_room(DecodedImage& image, const WantedImage& wanted) {
  if (wanted) wanted(image);
  const double values = static_cast<double>(image.pixels()) * static_cast<double>(image.channels.size());
  // A decoder of whole pictures (interlaced PNG, tiles) has them once more, as they are stored.
  require_image_memory(image.path, 2 * values * sizeof(float));
  image.values.resize(image.pixels() * image.channels.size());
}

namespace {

std::vector<size_t> colours_of(const DecodedImage& image) {
  std::vector<size_t> colours;
  for (size_t c = 0; c < image.channels.size(); ++c)
    if (c != image.alpha) colours.push_back(c);
  return colours;
}

}  // namespace

void require_grey_channels(const DecodedImage& image) {
  if (const size_t colours = colours_of(image).size(); colours != 1 && colours != 3)
    throw Error(ErrorKind::file,
                fmt::format("{}: has {} channels; write visibility as one grey channel (or three equal ones)",
                            image.path, image.channels.size()));
}

std::vector<float> grey_values(const DecodedImage& image) {
  require_grey_channels(image);
  const std::vector<size_t> colours = colours_of(image);
  std::vector<float> grey(image.pixels());
  for (size_t i = 0; i < grey.size(); ++i) {
    grey[i] = image.at(i, colours[0]);
    for (const size_t c : colours)
      if (const float other = image.at(i, c); other != grey[i] && !(other != other && grey[i] != grey[i]))  // both NaN
        throw Error(ErrorKind::file,
                    image.path + ": has colours; write visibility as one grey channel (or three equal ones)");
  }
  return grey;
}

std::string write_png(const std::string& path, const Image<Color>& picture) {
  const std::string file = png_of(path, picture);
  write_file_atomically(path, file);
  return digest_of(file);
}

std::string write_animated_png(const std::string& path, const std::vector<Image<Color>>& frames, int frame_ms) {
  std::vector<std::string> files(frames.size());
  tbb::parallel_for(size_t{0}, frames.size(), [&](size_t i) { files[i] = png_of(path, frames[i]); });
  const std::string animated = animated_png(files, frame_ms);
  write_file_atomically(path, animated);
  return digest_of(animated);
}

std::string write_exr(const std::string& path, const LargeImage& image) {
  const size_t count = image.channels.size(), pixel_bytes = count * sizeof(float),
               row_bytes = static_cast<size_t>(image.width) * pixel_bytes;
  const int most = std::min(rows_at_a_time(row_bytes), image.height);
  std::vector<float> pixels(static_cast<size_t>(most) * static_cast<size_t>(image.width) * count);
  return write_exr(path, image.width, image.height, image.channels, most, [&](int first_row, int rows) {
    image.rows(first_row, rows, pixels.data());
    ExrRows from{{}, pixel_bytes, row_bytes};
    for (size_t c = 0; c < count; ++c) from.channels.push_back(pixels.data() + c);
    return from;
  });
}

std::string write_exr(const std::string& path, const std::vector<Channel>& channels) {
  const int width = channels.at(0).values.width, height = channels.at(0).values.height;
  ExrRows all{{}, sizeof(float), static_cast<size_t>(width) * sizeof(float)};
  std::vector<std::string> names;
  for (const Channel& channel : channels) {
    if (channel.values.width != width || channel.values.height != height)
      throw std::logic_error("channels of one image differ in size");
    names.push_back(channel.name);
    all.channels.push_back(channel.values.pixels.data());
  }
  return write_exr(path, width, height, names, height, [&](int, int) { return all; });
}

}  // namespace noonmark
