#include "scenes/gltf_error.h"

#include <fmt/format.h>

#include "scenes/error.h"

namespace noonmark::gltf {

void refuse(std::string_view file, std::string_view place, std::string_view what, std::string_view remedy) {
  throw Error(ErrorKind::scene, fmt::format("{}: {}{}{}; {}", file, place, place.empty() ? "" : ": ", what, remedy));
}

std::string printable(std::string_view text) {
  constexpr size_t longest = 80;
  std::string shown;
  for (char c : text.substr(0, longest)) shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text.size() > longest ? shown + "..." : shown;
}

}  // namespace noonmark::gltf
