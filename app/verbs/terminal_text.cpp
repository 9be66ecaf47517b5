#include "app/verbs/terminal_text.h"

#include <fmt/color.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace noonmark {
namespace {

constexpr std::pair<std::string_view, fmt::terminal_color> verdict_colours[] = {
    {"held", fmt::terminal_color::green},     {"better", fmt::terminal_color::green},
    {"broken", fmt::terminal_color::red},     {"refused", fmt::terminal_color::red},
    {"worse", fmt::terminal_color::red},      {"missing", fmt::terminal_color::red},
    {"warning", fmt::terminal_color::yellow}, {"changed", fmt::terminal_color::yellow}};

constexpr int fewest_columns = 60;  // in fewer, a line of help would be a few words beside an empty column

}  // namespace

bool terminal_has_colours() {
  const char *const refused = std::getenv("NO_COLOR"), *const term = std::getenv("TERM");
  return isatty(STDOUT_FILENO) == 1 && (refused == nullptr || *refused == '\0') && term != nullptr &&
         std::string_view(term) != "dumb";
}

std::optional<size_t> terminal_columns() {
  winsize size{};
  if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < fewest_columns)
    return std::nullopt;
  return size.ws_col;
}

std::string with_coloured_verdicts(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    const std::string_view word = line.substr(0, line.find(':'));
    const auto colour = std::find_if(std::begin(verdict_colours), std::end(verdict_colours),
                                     [&](const auto& row) { return row.first == word && word.size() < line.size(); });
    if (colour != std::end(verdict_colours)) {
      out += fmt::format(fmt::fg(colour->second), "{}", word);
      line.remove_prefix(word.size());
    }
    out += line;
  }
  return out;
}

}  // namespace noonmark
