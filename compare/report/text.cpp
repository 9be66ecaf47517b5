#include "compare/report/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "compare/judge/curve_reading.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark::report {
namespace {

constexpr std::string_view thin_space = "\u202f";

// Groups of three digits from 10 000 on. 1234 is easy to read without them.
std::string grouped(double whole) {
  std::string digits = fmt::format("{:.0f}", whole);
  const size_t first = digits.find_first_of("0123456789");
  if (digits.size() - first < 5) return digits;
  for (size_t i = digits.size() - 3; i > first; i = i < 3 ? 0 : i - 3) digits.insert(i, thin_space);
  return digits;
}

// Whole numbers below 100 000 are whole, larger numbers have four significant digits.
double few_digits(double value) {
  if (!std::isfinite(value) || (std::abs(value) < 1e5 && value == std::round(value))) return value;
  return std::strtod(fmt::format("{:.{}e}", value, people_digits - 1).c_str(), nullptr);
}

// bias.unit and bias.offset_unit are settings that are the units of others.
bool is_given_by_a_setting(const std::string& unit) { return unit.starts_with("bias."); }

const Setting* row_of(const std::string& name) {
  for (const Setting& row : settings_table())
    if (row.name == name) return &row;
  return nullptr;
}

// The unit behind a number: "1 texel", "0.5 texels". bias.unit has the word "texel" for itself.
std::string_view unit_behind(std::string_view number, std::string_view unit) {
  return unit != "texel" && unit != "texels" ? unit : number == "1" ? "texel" : "texels";
}

std::string value_phrase(const std::string& value, const std::string& unit) {
  std::string out = value.empty() ? "unknown" : setting_text(value);
  // A fraction stands as a user types it, which is a number alone.
  if (!unit.empty() && unit != "fraction" && number_of(value))
    out += fmt::format("{}{}", thin_space, unit_behind(out, unit));
  return out;
}

void strip_suffix(std::string& text, std::string_view suffix) {
  if (text.ends_with(suffix)) text.resize(text.size() - suffix.size());
}

}  // namespace

std::string script_json(const nlohmann::json& value) {
  std::string out;
  for (char c : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    // These characters stand only inside strings, where JSON allows an escape.
    if (c == '<' || c == '>' || c == '&')
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "not finite";
  const double size = std::abs(value);
  if (size == 0) return "0";
  const int places = digits - 1 - static_cast<int>(std::floor(std::log10(size)));  // after the point
  if (size >= 999.5 && size < 1e9 && (places <= 0 || value == std::round(value))) return grouped(few_digits(value));
  if (size >= 1e-4 && size < 1e9) {
    std::string text = fmt::format("{:.{}f}", value, std::max(0, places));
    while (text.find('.') != std::string::npos && (text.back() == '0' || text.back() == '.')) {
      const bool point = text.back() == '.';
      text.pop_back();
      if (point) break;
    }
    return text;
  }
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);
  const size_t e = text.find('e');
  std::string mantissa = text.substr(0, e), power;
  while (mantissa.back() == '0') mantissa.pop_back();
  if (mantissa.back() == '.') mantissa.pop_back();
  constexpr std::string_view raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (char digit : fmt::format("{}", std::stoi(text.substr(e + 1)))) power += digit == '-' ? "⁻" : raised[digit - '0'];
  return mantissa + "×10" + power;
}

std::string_view head_unit(std::string_view unit) {
  if (unit == "fraction") return "%";
  if (unit == "bytes") return "MB";
  return unit == "count" ? "" : unit;
}

std::string cell(double value, std::string_view unit, int digits) {
  if (!std::isfinite(value)) return "not finite";
  if ((unit == "fraction" || unit.empty()) && std::abs(value) < least_share) return "0";
  if (unit == "count") return grouped(std::round(few_digits(value)));
  return number(unit == "fraction" ? 100 * value : unit == "bytes" ? 1e-6 * value : value, digits);
}

std::string quantity(double value, std::string_view unit, int digits) {
  const std::string text = cell(value, unit, digits);
  const std::string_view shown = head_unit(unit);
  return shown.empty() || !std::isfinite(value) ? text
                                                : fmt::format("{}{}{}", text, thin_space, unit_behind(text, shown));
}

std::string quantity(const MedianInterval& interval, std::string_view unit) {
  const std::string text = quantity(interval.middle, unit);
  if (interval.low == interval.high || !std::isfinite(interval.middle)) return text;
  return fmt::format("{} ({} … {})", text, cell(interval.low, unit), cell(interval.high, unit));
}

std::string setting_label(const std::string& name) {
  if (name == "given.frame") return "frame";
  std::string label = name.starts_with("map.") ? name.substr(4) : name;
  for (std::string_view suffix : {".kind", ".name", "_m", "_deg", "_px"}) strip_suffix(label, suffix);
  std::replace_if(
      label.begin(), label.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  return label;
}

std::string setting_unit(const std::string& name) {
  const Setting* row = row_of(name);
  return row ? std::string(row->unit) : std::string();
}

std::string swept_unit(const std::string& name, const Results& results) {
  const std::string unit = setting_unit(name);
  if (unit == "fraction") return "";  // its values stand as a user types them
  if (!is_given_by_a_setting(unit)) return unit;
  std::string same;
  for (const PointRecord& point : results.points) {
    const std::string one = setting_of(point, unit);
    if (!same.empty() && one != same) return "";
    same = one;
  }
  return same == "texel" ? "texels" : same;
}

std::string settings_phrase(const PointRecord& point, const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) {
    // The unit of a bias is a setting itself.
    std::string unit = setting_unit(name);
    if (is_given_by_a_setting(unit)) unit = setting_of(point, unit);
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", setting_label(name),
                       value_phrase(setting_of(point, name), unit));
  }
  return out;
}

std::vector<std::string> without_curve_parameter(const PointRecord& point, std::vector<std::string> names) {
  if (has_curve(point)) std::erase(names, curve_parameter(point));
  return names;
}

std::string bias_phrase(double depth, const BiasCurve& curve) {
  return fmt::format("{0}{1}m = {2}{1}texels = {3}{1}depth", number(depth * curve.m_per_depth), thin_space,
                     number(depth * curve.texels_per_depth), number(depth));
}

std::string bias_in_unit(double value, const std::string& unit) {
  return quantity(value, unit == "texel" ? "texels" : unit);
}

std::string metric_label(std::string_view name) {
  if (name == "peter_panning") return "Peter Panning";
  if (name == "flip") return "FLIP";
  std::string label(name);
  if (label.starts_with("pcf_")) label = "PCF" + label.substr(3);
  if (label.starts_with("peter_panning_")) label = "Peter Panning" + label.substr(13);
  for (std::string_view suffix : {"_ms", "_texels", "_pixels"}) strip_suffix(label, suffix);
  if (name.ends_with("_gap_m")) strip_suffix(label, "_m");
  std::replace(label.begin(), label.end(), '_', ' ');
  if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

std::string error_label(std::string_view name) {
  if (name == "error") return "Error against the hard truth";
  if (name == "error_soft") return "Error against the light's size";
  if (name == "aliasing_rms") return "Aliasing, root mean square";
  if (name == "shaded_rmse") return "Shaded frame, root mean square error";
  return metric_label(name);
}

}  // namespace noonmark::report
