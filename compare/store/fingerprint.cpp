#include "compare/store/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

namespace noonmark {
namespace {

// The lines "name = value" of a fingerprint, in their order.
std::vector<std::pair<std::string, std::string>> named_lines(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.emplace_back(line.substr(0, line.find(" = ")), line);
  return lines;
}

auto find_name(const std::vector<std::pair<std::string, std::string>>& lines, const std::string& name) {
  return std::find_if(lines.begin(), lines.end(), [&](const auto& line) { return line.first == name; });
}

}  // namespace

bool same_facts(const std::string& here, const std::string& there) {
  const auto a = named_lines(here), b = named_lines(there);
  const auto all_in = [](const auto& lines, const auto& others) {
    return std::all_of(lines.begin(), lines.end(), [&](const auto& line) {
      const auto other = find_name(others, line.first);
      return other == others.end() ? line.first.starts_with("scene ") : other->second == line.second;
    });
  };
  return all_in(a, b) && all_in(b, a);
}

std::string without_scenes(const std::string& facts) {
  std::string text;
  for (const auto& [name, line] : named_lines(facts))
    if (!name.starts_with("scene ")) text += line + "\n";
  return text;
}

std::string joined_facts(const std::string& here, const std::string& there) {
  const auto lines = named_lines(here);
  std::string text = here;
  for (const auto& [name, line] : named_lines(there))
    if (name.starts_with("scene ") && find_name(lines, name) == lines.end()) text += line + "\n";
  return text;
}

std::string first_difference(const std::string& here, const std::string& there) {
  const auto a = named_lines(here), b = named_lines(there);
  for (const auto& [name, line] : a) {
    const auto other = find_name(b, name);
    if (other == b.end()) return fmt::format("now '{}', there nothing of the kind", line);
    if (other->second == line) continue;
    // A line like "scene street.glb (its settings) = a digest". The message leaves out the digests, because they mean
    // nothing to a reader.
    if (const size_t settings = name.rfind(" ("); name.starts_with("scene ") && settings != name.npos)
      return fmt::format("the contents of the {} have changed since these were stored", name.substr(0, settings));
    return fmt::format("now '{}', there '{}'", line, other->second);
  }
  for (const auto& [name, line] : b)
    if (find_name(a, name) == a.end()) return fmt::format("there '{}', now nothing of the kind", line);
  return "the same settings in another order";
}

}  // namespace noonmark
