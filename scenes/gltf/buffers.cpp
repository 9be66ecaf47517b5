#include "scenes/gltf/buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "scenes/gltf/container.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/meshopt.h"

namespace noonmark::gltf {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// RFC 3986, section 2.1. A percent sign that is not an escape stays unchanged, as in browsers.
std::string percent_decoded(std::string_view uri) {
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    out += escape ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return out;
}

// Recognises "http:", "file:", "C:": letters, then digits + - . and a colon before any slash.
bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find_first_of(":/");
  if (colon == std::string_view::npos || uri[colon] != ':' || colon == 0) return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

// The file that the uri names, with links resolved. It is refused unless it lies below the scene file's folder.
// otherwise: ", or ...", what else can be done.
fs::path confined(const std::string& file, const std::string& uri, const std::string& place,
                  std::string_view otherwise = "") {
  const std::string shown = "'" + printable(uri) + "'";
  const std::string remedy = fmt::format("put the file beside the scene and name it without a path{}", otherwise);
  const std::string name = percent_decoded(uri);
  if (name.empty() || name.find('\0') != std::string::npos)
    refuse(file, place, shown + " is not a name of a file", remedy);
  if (has_scheme(name)) refuse(file, place, shown + " is not a file of this folder", remedy);
  const fs::path relative = fs::path(name).lexically_normal();
  if (relative.is_absolute() || *relative.begin() == "..")
    refuse(file, place, shown + " leads out of the scene's folder", remedy);

  std::error_code error;
  const fs::path parent = fs::path(file).parent_path();
  const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent, error);
  if (error) refuse(file, place, "the scene's folder cannot be read: " + error.message(), "check its permissions");
  const fs::path target = fs::canonical(folder / relative, error);
  if (error)
    refuse(file, place, fmt::format("{} cannot be found: {}", shown, error.message()),
           fmt::format("put it beside the scene{}", otherwise));
  const auto [in_folder, in_target] = std::mismatch(folder.begin(), folder.end(), target.begin(), target.end());
  if (in_folder != folder.end()) refuse(file, place, shown + " is a link out of the scene's folder", remedy);
  return target;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// RFC 4648, section 4, with or without padding. No value if the text is not base64. tinygltf's decoder is not used,
// because it stops silently at the first wrong character.
std::optional<std::vector<uint8_t>> base64_decoded(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int held = 0;
  for (char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xffffu;
    held += 6;
    if (held >= 8) {
      held -= 8;
      out.push_back(static_cast<uint8_t>(bits >> held));
    }
  }
  return out;
}

}  // namespace

std::span<const uint8_t> Buffers::bytes(size_t buffer) {
  if (!loaded_[buffer]) {
    const std::string place = fmt::format("buffers[{}]", buffer);
    count(document_.guarded.buffers[buffer].byte_length, place);
    loaded_[buffer] = load(buffer, place);
  }
  return *loaded_[buffer];
}

std::span<const uint8_t> Buffers::view(int view) {
  if (const auto known = decompressed_.find(view); known != decompressed_.end()) return known->second;
  const tinygltf::BufferView& v = document_.model.bufferViews[static_cast<size_t>(view)];
  const std::optional<MeshoptView> compressed = meshopt_view(document_, view);
  if (!compressed) return bytes(static_cast<size_t>(v.buffer)).subspan(v.byteOffset, v.byteLength);
  const std::span<const uint8_t> from = bytes(compressed->buffer).subspan(compressed->offset, compressed->length);
  count(v.byteLength, compressed->place);
  return decompressed_[view] = decompress(document_, *compressed, from);
}

std::vector<uint8_t> Buffers::image(size_t image) {
  const ImageInfo& info = document_.guarded.images[image];
  const std::string place = fmt::format("images[{}]", image);
  constexpr std::string_view remedy = "export the file again, or set scene.masks = false";
  if (info.view) {
    if (*info.view >= document_.model.bufferViews.size())
      refuse(document_.file, place + ".bufferView",
             fmt::format("{} refers beyond the {} bufferViews", *info.view, document_.model.bufferViews.size()),
             remedy);
    const std::span<const uint8_t> bytes = view(static_cast<int>(*info.view));
    return {bytes.begin(), bytes.end()};
  }
  if (!info.uri) refuse(document_.file, place, "has neither a uri nor a bufferView", remedy);
  if (!info.uri->starts_with("data:"))
    return read_bytes(confined(document_.file, *info.uri, place + ".uri", ", or set scene.masks = false"), 0,
                      document_.file, place + ".uri", printable(*info.uri));
  const size_t comma = info.uri->find(',');
  if (comma == std::string::npos || !info.uri->substr(0, comma).ends_with(";base64"))
    refuse(document_.file, place + ".uri", "is not an embedded image in base64", remedy);
  std::optional<std::vector<uint8_t>> decoded = base64_decoded(std::string_view(*info.uri).substr(comma + 1));
  if (!decoded) refuse(document_.file, place + ".uri", "holds text that is not base64", remedy);
  return std::move(*decoded);
}

void Buffers::count(uint64_t more, const std::string& place) {
  total_bytes_ += more;
  if (total_bytes_ > max_file_bytes) {
    refuse(document_.file, place + ".byteLength",
           fmt::format("{} bytes of buffers are more than the {} allowed", total_bytes_, max_file_bytes),
           "split the scene");
  }
}

std::vector<uint8_t> Buffers::load(size_t buffer, const std::string& place) const {
  const BufferInfo& info = document_.guarded.buffers[buffer];
  const std::string& file = document_.file;
  constexpr std::string_view remedy = "export the file again";
  std::vector<uint8_t> data;
  if (info.byte_length == 0) refuse(file, place + ".byteLength", "is 0", remedy);
  if (!info.uri) {
    if (buffer != 0 || !document_.has_bin)
      refuse(file, place, "has no uri, and there is no binary chunk for it", remedy);
    data = document_.bin;
  } else if (info.uri->starts_with("data:")) {
    const std::string_view uri = *info.uri;
    // The two types that glTF names (section 3.6.1.1).
    for (std::string_view head : {"data:application/octet-stream;base64,", "data:application/gltf-buffer;base64,"}) {
      if (!uri.starts_with(head)) continue;
      std::optional<std::vector<uint8_t>> decoded = base64_decoded(uri.substr(head.size()));
      if (!decoded) refuse(file, place + ".uri", "holds text that is not base64", remedy);
      data = std::move(*decoded);
      break;
    }
    if (data.empty()) {
      refuse(file, place + ".uri", fmt::format("'{}' is not an embedded buffer", printable(uri.substr(0, 40))),
             "use data:application/octet-stream;base64,");
    }
  } else {
    return read_bytes(confined(file, *info.uri, place + ".uri"), info.byte_length, file, place + ".uri",
                      printable(*info.uri));
  }
  if (data.size() < info.byte_length) {
    refuse(file, place + ".byteLength", fmt::format("{} bytes, but only {} are there", info.byte_length, data.size()),
           remedy);
  }
  data.resize(info.byte_length);
  return data;
}

}  // namespace noonmark::gltf
