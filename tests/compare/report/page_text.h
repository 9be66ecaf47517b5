// What a page holds: its text, and the data of its charts.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace noonmark {

// The report without its scripts, as a reader without JavaScript sees it.
inline std::string without_scripts(const std::string& page) {
  std::string out;
  size_t at = 0;
  while (true) {
    const size_t open = page.find("<script", at);
    out += page.substr(at, open - at);
    if (open == std::string::npos) return out;
    at = page.find("</script>", open) + 9;
  }
}

inline nlohmann::json embedded_data(const std::string& page) {
  const std::string head = "<script type=\"application/json\" id=\"noonmark-data\">";
  const size_t open = page.find(head) + head.size();
  return nlohmann::json::parse(page.substr(open, page.find("</script>", open) - open));
}

}  // namespace noonmark
