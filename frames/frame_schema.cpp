// The JSON schema of frame.json, from the rows of its keys.
#include <nlohmann/json.hpp>
#include <string>

#include "frames/frame_file.h"
#include "frames/frame_keys.h"

namespace noonmark {

namespace {

using Json = nlohmann::ordered_json;
using Kind = FrameKeyKind;

}  // namespace

std::string frame_schema() {
  // A length has the renderer's unit, and its range is in metres.
  const auto number = [](const FrameKey& key) -> Json {
    const FrameRange range = range_of(key);
    if (!range.is_length())
      return {{"type", "number"}, {"minimum", range.numbers.least}, {"maximum", range.numbers.most}};
    if (range.numbers.least > 0) return {{"type", "number"}, {"exclusiveMinimum", 0}};
    if (range.numbers.least == 0) return {{"type", "number"}, {"minimum", 0}};
    return {{"type", "number"}};
  };
  const auto form = [&](const FrameKey& key) -> Json {
    switch (key.kind) {
      case Kind::object:
        return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
      case Kind::text:
        return {{"type", "string"}, {"minLength", 1}};
      case Kind::choice: {
        Json words = Json::array();
        for (const std::string_view choice : choices_of(key)) words.push_back(choice);
        return {{"enum", words}};
      }
      case Kind::number:
        return number(key);
      case Kind::flag:
        return {{"type", "boolean"}};
      case Kind::vector3:
        return {{"type", "array"}, {"items", number(key)}, {"minItems", 3}, {"maxItems", 3}};
      case Kind::axes:
        return {{"type", "array"},
                {"items", {{"enum", {"x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"}}}},
                {"minItems", 3},
                {"maxItems", 3}};
      case Kind::matrix:
        return {{"type", "array"}, {"items", number(key)}, {"minItems", 16}, {"maxItems", 16}};
      case Kind::settings:
        return {{"type", "object"}, {"additionalProperties", {{"type", {"string", "number", "boolean", "array"}}}}};
      case Kind::version:
        return {{"const", 1}};
      case Kind::texts:
        return {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}};
    }
    return {};
  };
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "frame.json of Noonmark: the frame of another renderer"},
              {"type", "object"},
              {"additionalProperties", false},
              {"required", {"noonmark_frame", "visibility"}},
              {"properties", Json::object()}};
  for (const FrameKey& key : frame_keys()) {
    Json& owner = key.object.empty() ? schema : schema["properties"][std::string(key.object)];
    Json one = form(key);
    one["description"] = key.help;
    owner["properties"][std::string(key.name)] = std::move(one);
    if (!key.object.empty() && key.name == "file") owner["required"].push_back("file");
  }
  return schema.dump(2) + "\n";
}

}  // namespace noonmark
