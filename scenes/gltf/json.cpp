#include "scenes/gltf/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view json_remedy = "export the file again, or correct it";

struct Fault {
  std::string place = "JSON", what;
  std::string_view remedy = json_remedy;
};

// Looks at the first bytes for another encoding, because the parser's message would not name the encoding.
std::optional<Fault> fault_of_encoding(std::string_view text) {
  if (std::all_of(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }))
    return Fault{.what = "there is none: the file is empty"};
  // The parser skips a byte order mark; glTF forbids it (section 2.7).
  if (text.starts_with("\xef\xbb\xbf"))
    return Fault{"byte 0 of the JSON", "a byte order mark", "save it as plain UTF-8"};
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || text.substr(0, 4).find('\0') != text.npos) {
    if (std::all_of(text.begin(), text.end(), [](char c) { return c == '\0'; }))
      return Fault{.what = "the file holds nothing but zeros"};
    return Fault{"JSON", "the text is not UTF-8, but looks like UTF-16", "save it as plain UTF-8"};
  }
  return std::nullopt;
}

// "[json.exception.parse_error.101] parse error at line 3, column 7: syntax error while parsing value - unexpected end
// of input; expected ..." as {"line 3, column 7 of the JSON", "unexpected end of input"}.
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

// Throws with the place of the first bracket that is nested too deep. The parser does not tell where it is in the text,
// so this reads the text again, but only that of a file which is refused anyway.
void check_nesting(const std::string& file, std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > max_json_depth) {
        refuse(file, fmt::format("byte {} of the JSON", i), fmt::format("nested more than {} deep", max_json_depth),
               "remove the nested data (most likely `extras`)");
      }
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

// The property that the table has under this key in an object; null: it has none.
const Field* property(const Field& object, std::string_view key) {
  static constexpr Field index{"", Kind::integer};
  if (object.kind == Kind::references || object.kind == Kind::reference_lists)
    return is_read_reference(key) ? &index : nullptr;
  const auto found =
      std::find_if(object.fields.begin(), object.fields.end(), [&](const Field& field) { return field.name == key; });
  return found == object.fields.end() ? nullptr : &*found;
}

// Takes the parser's events. It checks keys and nesting, and makes the document of the properties in the table.
class Reader final : public nlohmann::json_sax<json> {
 public:
  Reader(const std::string& file, std::string_view text, std::span<const Field> properties)
      : file_(file), text_(text), whole_{"", Kind::object, true, 0, properties} {}

  json take() { return std::move(document_); }

  // Of several faults, nesting is the one that is named, wherever it stands in the text.
  [[noreturn]] void fail(const Fault& fault) const {
    check_nesting(file_, text_);
    refuse(file_, fault.place, fault.what, fault.remedy);
  }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(json::number_integer_t value) override { return put(value); }
  bool number_unsigned(json::number_unsigned_t value) override { return put(value); }
  bool number_float(json::number_float_t value, const std::string&) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(json::binary_t&) override { return true; }  // not in text

  bool start_object(size_t) override { return open(json::value_t::object); }
  bool start_array(size_t) override { return open(json::value_t::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& key) override {
    Open& object = open_.back();
    if (!object.free) {
      if (is_known(object, key)) fail_twice(key);
      keys_.push_back(key);
    }
    const Field* const field = object.value == nullptr ? nullptr : property(*object.field, key);
    member_ = field == nullptr ? nullptr : &(*object.value)[key];
    member_field_ = field;
    return true;
  }

  bool parse_error(size_t, const std::string&, const json::exception& e) override { fail(fault_of(e.what())); }

 private:
  // An object or array whose end has not been read.
  struct Open {
    json* value;         // null: not kept
    const Field* field;  // of an array: also of its elements; null: not kept
    bool is_object;
    bool free;         // in extras, where any keys are allowed
    size_t first_key;  // in keys_
    std::set<std::string> many{};
  };

  // Where the next value is kept; null: nowhere.
  json* place() {
    if (open_.empty()) return &document_;
    const Open& outer = open_.back();
    if (outer.is_object) return member_;
    return outer.value == nullptr ? nullptr : &outer.value->emplace_back(nullptr);
  }

  template <class T>
  bool put(T&& value) {
    if (json* const to = place()) *to = std::forward<T>(value);
    return true;
  }

  bool open(json::value_t type) {
    if (open_.size() >= size_t{max_json_depth}) check_nesting(file_, text_);
    Open next{place(), &whole_, type == json::value_t::object, false, keys_.size()};
    if (!open_.empty()) {
      const Open& outer = open_.back();
      next.field = outer.is_object ? member_field_ : outer.field;
      next.free = outer.free || (outer.is_object && keys_.back() == "extras");
    }
    if (next.value != nullptr) *next.value = type;
    open_.push_back(std::move(next));
    return true;
  }

  bool close() {
    keys_.resize(open_.back().first_key);
    open_.pop_back();
    return true;
  }

  // Most objects have few keys, for which a search is faster than a set.
  bool is_known(Open& object, const std::string& key) const {
    constexpr size_t few = 32;
    const auto first = keys_.begin() + static_cast<std::ptrdiff_t>(object.first_key);
    if (keys_.size() - object.first_key < few) return std::find(first, keys_.end(), key) != keys_.end();
    if (object.many.empty()) object.many.insert(first, keys_.end());
    return !object.many.insert(key).second;
  }

  [[noreturn]] void fail_twice(const std::string& key) const {
    std::vector<std::string_view> outer;
    for (size_t i = 0; i + 1 < open_.size(); ++i) {
      if (open_[i].is_object) outer.push_back(keys_[open_[i + 1].first_key - 1]);
    }
    fail({outer.empty() ? "JSON" : printable(fmt::format("an object in {}", fmt::join(outer, "."))),
          fmt::format("has the key '{}' twice", printable(key))});
  }

  const std::string& file_;
  const std::string_view text_;
  const Field whole_;
  json document_;
  std::vector<Open> open_;
  // Of the open objects outside of extras, from the outermost object inwards.
  std::vector<std::string> keys_;
  // The value of the last key.
  json* member_ = nullptr;
  const Field* member_field_ = nullptr;
};

}  // namespace

json parse_json(const std::string& file, std::string_view text, std::span<const Field> properties) {
  Reader reader(file, text, properties);
  if (const auto fault = fault_of_encoding(text)) reader.fail(*fault);
  json::sax_parse(text.begin(), text.end(), &reader);
  return reader.take();
}

}  // namespace noonmark::gltf
