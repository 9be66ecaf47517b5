#include "compare/report/links.h"

#include <fmt/format.h>

namespace noonmark::report {

Markup file_link(std::string_view path, const Markup& content) {
  return element("a", Attribute("href", file_address(path)), content);
}

// Only letters, digits and a few signs stand for themselves (RFC 3986, section 2.3), so no path has a scheme.
std::string file_address(std::string_view path) {
  std::string out;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

}  // namespace noonmark::report
