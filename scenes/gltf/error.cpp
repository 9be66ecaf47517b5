#include "scenes/gltf/error.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"

namespace noonmark::gltf {

void refuse(std::string_view file, std::string_view place, std::string_view what, std::string_view remedy) {
  throw Error(ErrorKind::file, fmt::format("{}: {}{}{}; {}", file, place, place.empty() ? "" : ": ", what, remedy));
}

std::string printable(std::string_view text) {
  constexpr size_t longest = 80;
  std::string_view shown = text.substr(0, longest);
  // Does not cut within a character.
  while (shown.size() < text.size() && !shown.empty() && (text[shown.size()] & 0xc0) == 0x80) shown.remove_suffix(1);
  return noonmark::printable(shown) + (shown.size() < text.size() ? "..." : "");
}

}  // namespace noonmark::gltf
