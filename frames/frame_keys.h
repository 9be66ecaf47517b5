// The keys of frame.json: one row for each. The reader, the JSON schema and the documents are made from the rows.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/number_ranges.h"

namespace noonmark {

enum class FrameKeyKind {
  object,
  text,
  choice,
  number,
  flag,
  vector3,
  axes,
  matrix,
  settings,  // an object with settings' names and values
  version,
  texts
};

struct FrameKey {
  std::string_view object;  // "": of the file itself; "camera": of that object
  std::string_view name;
  FrameKeyKind kind;
  std::string_view help;          // one sentence
  std::string_view choices = {};  // "linear|srgb"; the first is the default
  // Of numbers: the setting that is the same quantity, whose range it has, or a range of its own.
  std::string_view setting = {};
  NumberRange own = {};
  std::string_view own_unit = {};

  std::string full_name() const;  // "camera.eye"
};

std::span<const FrameKey> frame_keys();
std::vector<std::string_view> choices_of(const FrameKey& key);
std::string taken_by(const FrameKey& key);  // in words: "number, 1 ... 170 deg"

// Of one number of the key. A length is given in the renderer's unit, and its range is in metres.
struct FrameRange {
  NumberRange numbers;
  std::string_view unit;  // "m", "deg" ... or empty
  bool is_length() const { return unit == "m"; }
  std::string text() const;  // "1 ... 170 deg"
};
FrameRange range_of(const FrameKey& key);
FrameRange range_of(std::string_view full_name);  // throws std::logic_error if there is no such key

// The same ranges where no file is read: options, the C interface, a program that calls judge_frame(). Throws Error(usage)
// that names the key and the range. value: in the range's unit.
void require_in_range(std::string_view full_name, double value);

}  // namespace noonmark
