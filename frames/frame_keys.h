// The keys of frame.json: one row for each. The reader, the JSON schema and the documents are made from the rows.
#pragma once
#include <span>
#include <string_view>
#include <vector>

namespace noonmark {

enum class FrameKeyKind {
  object,
  text,
  choice,
  number,
  positive,
  flag,
  vector3,
  axes,
  matrix,
  settings,  // an object with settings' names and values
  version
};

struct FrameKey {
  std::string_view object;  // "": of the file itself; "camera": of that object
  std::string_view name;
  FrameKeyKind kind;
  std::string_view help;          // one sentence
  std::string_view choices = {};  // "linear|srgb"; the first is the default
};

std::span<const FrameKey> frame_keys();
std::vector<std::string_view> choices_of(const FrameKey& key);

}  // namespace noonmark
