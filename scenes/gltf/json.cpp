#include "scenes/gltf/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view remedy = "export the file again, or correct it";

// Checks the first bytes for another encoding, because the parser's message would not name the encoding.
void check_encoding(const std::string& file, std::string_view text) {
  if (std::all_of(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }))
    refuse(file, "JSON", "there is none: the file is empty", remedy);
  // The parser skips a byte order mark; glTF forbids it (section 2.7).
  if (text.starts_with("\xef\xbb\xbf"))
    refuse(file, "byte 0 of the JSON", "a byte order mark", "save it as plain UTF-8");
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || text.substr(0, 4).find('\0') != text.npos) {
    const bool zeros = std::all_of(text.begin(), text.end(), [](char c) { return c == '\0'; });
    refuse(file, "JSON", zeros ? "the file holds nothing but zeros" : "the text is not UTF-8, but looks like UTF-16",
           zeros ? remedy : "save it as plain UTF-8");
  }
}

// "[json.exception.parse_error.101] parse error at line 3, column 7: syntax error while parsing value - unexpected end
// of input; expected ..." as {"line 3, column 7 of the JSON", "unexpected end of input"}.
struct Fault {
  std::string place = "JSON", what;
};
Fault fault_of(std::string_view text) {
  const auto skip_to = [&](std::string_view mark) {
    const size_t at = text.find(mark);
    if (at == text.npos) return std::string_view();
    const std::string_view before = text.substr(0, at);
    text.remove_prefix(at + mark.size());
    return before;
  };
  Fault fault;
  if (text.starts_with("[")) skip_to("] ");
  if (text.starts_with("parse error at ")) {
    skip_to("parse error at ");
    fault.place = std::string(skip_to(": ")) + " of the JSON";
  }
  if (text.starts_with("syntax error while parsing")) skip_to(" - ");
  fault.what = printable(text.substr(0, text.find("; ")));
  return fault;
}

// Checks the keys of the open objects while the parser reads the text.
class Keys {
 public:
  explicit Keys(const std::string& file) : file_(file) {}

  bool operator()(int, json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) {
      const bool free = !open_.empty() && (open_.back().free || open_.back().last == "extras");
      open_.push_back({free, {}, {}});
    } else if (event == json::parse_event_t::object_end) {
      open_.pop_back();
    } else if (event == json::parse_event_t::key) {
      Object& object = open_.back();
      object.last = parsed.get<std::string>();
      if (!object.free && !object.keys.insert(object.last).second) refuse_twice();
    }
    return true;
  }

 private:
  struct Object {
    bool free;  // in extras, where any keys are allowed
    std::set<std::string> keys;
    std::string last;
  };

  [[noreturn]] void refuse_twice() const {
    std::string place = "JSON";
    if (open_.size() > 1) {
      place = "an object in ";
      for (size_t i = 0; i + 1 < open_.size(); ++i) place += (i ? "." : "") + open_[i].last;
      place = printable(place);
    }
    refuse(file_, place, fmt::format("has the key '{}' twice", printable(open_.back().last)), remedy);
  }

  const std::string& file_;
  std::vector<Object> open_;
};

}  // namespace

json parse_json(const std::string& file, const std::string& text) {
  check_encoding(file, text);
  try {
    return json::parse(text, Keys(file));
  } catch (const json::exception& e) {
    const Fault fault = fault_of(e.what());
    refuse(file, fault.place, fault.what, remedy);
  }
}

}  // namespace noonmark::gltf
