#include "compare/report/cascade_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/results/causes.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/bias_parts.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using Cascade = PointRecord::Cascade;

// |R5 - R1| summed over the counted receivers.
double error_sum(const Cascade& cascade) {
  const double counted = cascade.metrics.at("counted");
  return counted > 0 ? counted * cascade.metrics.at("error") : 0;
}

double whole_error(const PointRecord& point) {
  double sum = 0;
  for (const Cascade& cascade : point.cascades) sum += error_sum(cascade);
  return sum;
}

struct LargestCause {
  std::string_view label;
  double size = 0;    // mean step
  double of_all = 0;  // its share of the steps of all causes
};

// The cause, or the kind of cause that darkens and lightens, with the largest mean step. The light's size is no part of the
// error.
LargestCause largest_cause(const Cascade& cascade) {
  LargestCause largest;
  double all = 0;
  for (const CauseRow& row : cause_rows) {
    if (row.place == CausePlace::light || !row.sum.empty()) continue;  // a part is counted in its sum
    double size = 0;
    for (const CauseRow& part : cause_rows)
      if (part.cause && (part.name == row.name || part.sum == row.name))
        if (const auto metric = cascade.metrics.find(std::string(part.name)); metric != cascade.metrics.end())
          size += metric->second;
    all += size;
    if (size > largest.size) largest = {row.label, size, 0};
  }
  if (all > 0) largest.of_all = largest.size / all;
  return largest;
}

// cascades.bias_scales of a cascade; 1 where none is given, or where a damaged store has no such number.
double bias_scale_of(const PointRecord& point, size_t cascade) {
  const std::string text = setting_of(point, "cascades.bias_scales");
  size_t begin = 0;
  for (size_t k = 0; k < cascade && begin != std::string::npos; ++k) {
    begin = text.find(',', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (begin == std::string::npos) return 1;
  return number_of(text.substr(begin, text.find(',', begin) - begin)).value_or(1);
}

// The part of the bias that the curve varies; null without a curve. A damaged store may name a part that there is not.
const BiasPart* varied_part(const PointRecord& point) {
  if (!point.curve) return nullptr;
  const auto part = std::find_if(bias_parts().begin(), bias_parts().end(), [&](const BiasPart& one) {
    return point.curve->parameter == "bias." + std::string(one.name);
  });
  return part == bias_parts().end() ? nullptr : &*part;
}

}  // namespace

std::string cascade_bias_unit(const PointRecord& point) {
  const BiasPart* part = varied_part(point);
  if (!part) return "";
  if (part->unit == "bias.offset_unit") return setting_of(point, "bias.offset_unit") == "m" ? "m" : "texels";
  if (part->unit != "bias.unit") return std::string(part->unit);
  const std::string unit = setting_of(point, "bias.unit");
  return unit == "texel" ? "texels" : unit;
}

bool cascade_bias_unit_varies(const PointRecord& point) {
  const BiasPart* part = varied_part(point);
  return part && part->unit == "bias.unit" && setting_of(point, "bias.unit") != "m";
}

bool cascades_by_depth(const PointRecord& point) {
  const std::string select = setting_of(point, "cascades.select");
  // A band about the end of a slice takes receivers from both sides of it.
  const bool about_ends =
      setting_of(point, "cascades.blend_of") == "square" && setting_of(point, "cascades.blend") != "0";
  return (select.empty() || select == "depth") && !about_ends;
}

std::vector<CascadeRow> cascade_rows_of(const PointRecord& point) {
  std::vector<CascadeRow> rows;
  const double all = whole_error(point);
  const BiasPart* part = varied_part(point);
  const std::optional<double> set = part ? number_of(setting_of(point, point.curve->parameter)) : std::nullopt;
  for (const Cascade& cascade : point.cascades) {
    CascadeRow row;
    row.number = static_cast<int>(rows.size()) + 1;
    const bool of_slice = cascades_by_depth(point);
    row.begin_m = of_slice ? cascade.begin_m : cascade.metrics.at("nearest_receiver_m");
    row.end_m = of_slice ? cascade.end_m : cascade.metrics.at("farthest_receiver_m");
    row.texel_m = cascade.metrics.at("texel_m");
    row.receivers = cascade.metrics.at("counted");
    if (row.receivers > 0) row.error = cascade.metrics.at("error");
    if (all > 0) row.share = error_sum(cascade) / all;
    row.cause = largest_cause(cascade).label;
    if (cascade.metrics.at("seam_points") > 0) row.seam = cascade.metrics.at("seam_jump");
    if (set) {
      const double scale = bias_scale_of(point, rows.size());
      row.set = *set * scale;
      if (cascade.bias_needed) row.needed = *cascade.bias_needed * scale;
    }
    if (cascade_bias_unit_varies(point))
      row.m_per_unit = cascade.metrics.at(setting_of(point, "bias.unit") == "texel" ? "texel_m" : "map_range_m");
    rows.push_back(row);
  }
  return rows;
}

std::string cascade_depths_text(const CascadeRow& row) {
  if (!std::isfinite(row.begin_m)) return "-";
  return fmt::format("{:.3g} to {:.3g} m", row.begin_m, row.end_m);
}

std::string cascade_bias_text(const PointRecord& point, const CascadeRow& row, const std::optional<double>& amount) {
  if (!amount) return "-";
  if (*amount == 0) return "0";
  const std::string text = quantity_text(*amount, cascade_bias_unit(point), 3);
  return cascade_bias_unit_varies(point) ? fmt::format("{} = {}", text, quantity_text(*amount * row.m_per_unit, "m", 3))
                                         : text;
}

std::string worst_cascade(const PointRecord& point) {
  const std::vector<CascadeRow> rows = cascade_rows_of(point);
  const auto worst = std::max_element(rows.begin(), rows.end(), [](const CascadeRow& a, const CascadeRow& b) {
    return a.share.value_or(0) < b.share.value_or(0);
  });
  if (worst == rows.end() || !worst->share) return "";
  const LargestCause cause = largest_cause(point.cascades[static_cast<size_t>(worst - rows.begin())]);
  std::string text = fmt::format(
      "Cascade {} ({}{}, texel {:.2g} m) holds {:.0f}% of the error{}.", worst->number,
      cascades_by_depth(point) ? "" : "receivers from ", cascade_depths_text(*worst), worst->texel_m,
      100 * *worst->share,
      cause.size > 0 ? fmt::format("; its largest cause: {}, {:.0f}%", cause.label, 100 * cause.of_all) : "");
  if (worst->needed && *worst->set < *worst->needed)
    text += fmt::format(" Its {} is {} where {} is needed against acne.", point.curve->parameter,
                        cascade_bias_text(point, *worst, worst->set), cascade_bias_text(point, *worst, worst->needed));
  return text;
}

}  // namespace noonmark
