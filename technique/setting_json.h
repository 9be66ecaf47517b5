// Settings and numbers as JSON, for point.json, --json and the schema. Only source files include it, because the JSON
// library's header is large.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "technique/settings.h"

namespace noonmark {

// JSON has no NaN and no infinity. They are "nan", "inf" and "-inf".
inline nlohmann::json number_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

// A setting in the type of its row, from its canonical text. Text, points and auto are written as text.
inline nlohmann::json setting_json(const Setting& row, const std::string& text) {
  if (text == "auto") return text;
  switch (row.type) {
    case ValueType::integer:
      return std::stoll(text);
    case ValueType::real:
      return number_json(std::stod(text));
    case ValueType::flag:
      return text == "true";
    default:
      return text;
  }
}

// Paths and names may have bytes that are not UTF-8; JSON must not. Those bytes are replaced.
inline std::string readable_json(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace noonmark
