#include "compare/report/links.h"

#include <fmt/format.h>

#include <algorithm>

namespace noonmark::report {
namespace {

// The scheme may be in letters of either case (RFC 3986, section 3.1).
bool begins_any_case(std::string_view text, std::string_view beginning) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return text.size() >= beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), text.begin(), [&](char b, char c) { return lower(c) == b; });
}

}  // namespace

Markup web_link(std::string_view address, std::string_view text) {
  // No address has a space or a control character (RFC 3986, section 2): such a text is no address.
  const bool whole = std::all_of(address.begin(), address.end(), [](unsigned char c) { return c > ' ' && c != 0x7f; });
  if (!whole || (!begins_any_case(address, "http://") && !begins_any_case(address, "https://"))) return address;
  return element("a", Attribute("href", address), text);
}

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
