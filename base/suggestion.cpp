#include "base/suggestion.h"

#include <algorithm>
#include <vector>

#include "base/text.h"

namespace noonmark {

std::string did_you_mean(std::string_view wrong, std::span<const std::string_view> names) {
  constexpr size_t most = 3;
  std::vector<std::string> meant;
  if (wrong.find_first_not_of('-') != std::string_view::npos)  // "--" begins every option
    for (const std::string_view name : names)
      if (name.starts_with(wrong)) meant.emplace_back(name);
  if (meant.empty() || meant.size() > most) meant = {nearest_name(wrong, names)};
  if (meant.front().empty()) return "";
  std::string text = "; did you mean ";
  for (size_t i = 0; i < meant.size(); ++i)
    text += (i == 0 ? "'" : i + 1 < meant.size() ? ", '" : " or '") + meant[i] + "'";
  return text + "?";
}

}  // namespace noonmark
