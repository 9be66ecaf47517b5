#include "compare/judge/law_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "compare/judge/laws.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

constexpr size_t widest_name = 60;

std::string_view limit_sign(LawRelation relation) { return relation == LawRelation::at_most ? "<=" : ">="; }

std::string short_number(double value) {
  return std::isnan(value) ? std::string(not_measured) : fmt::format("{:.4g}", value);
}

}  // namespace

std::string law_text(const LawResult& law) {
  const std::string_view sign = law.relation == LawRelation::equal ? "=" : limit_sign(law.relation);
  const std::string joined = law.join == "each"   ? law.measured
                             : law.join == "mean" ? fmt::format("mean of {}", law.measured)
                                                  : fmt::format("{} of {}", law.join, law.measured);
  return fmt::format("{} {} {}{}", joined, sign, law.predicted,
                     law.tolerance.empty() ? "" : fmt::format(" ({})", law.tolerance));
}

std::string predicted_text(const LawResult& law) {
  if (law.worst < 0) return "-";
  const std::string value = short_number(law.samples[static_cast<size_t>(law.worst)].predicted);
  return law.relation == LawRelation::equal ? value : fmt::format("{} {}", limit_sign(law.relation), value);
}

std::string ratio_text(const LawResult& law) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  size_t told = 0;
  for (const LawResult::Sample& sample : law.samples) {
    if (std::abs(sample.predicted) <= sample.allowed) continue;  // a ratio to almost 0 has no meaning
    const double ratio = sample.measured / sample.predicted;
    if (!std::isfinite(ratio)) return "";
    ++told;
    low = std::min(low, ratio);
    high = std::max(high, ratio);
  }
  if (told == 0 || law.relation != LawRelation::equal) return "";
  return told == 1 ? fmt::format("{:.3f}", low) : fmt::format("{:.3f} .. {:.3f}", low, high);
}

std::string law_table(std::span<const LawResult> laws) {
  size_t width = 3;
  for (const LawResult& law : laws) width = std::min(widest_name, std::max(width, printable(law.name).size()));
  std::string text = fmt::format("{:<{}}  {:>7}  {:>12}  {:>10}  {:>16}  {}\n", "law", width, "samples", "predicted",
                                 "measured", "ratio", "verdict");
  for (const LawResult& law : laws) {
    const LawResult::Sample* worst = law.worst < 0 ? nullptr : &law.samples[static_cast<size_t>(law.worst)];
    text += fmt::format("{:<{}}  {:>7}  {:>12}  {:>10}  {:>16}  {}\n", printable(law.name), width, law.samples.size(),
                        predicted_text(law), worst ? short_number(worst->measured) : "-", ratio_text(law),
                        law.held ? "holds"
                        : worst  ? "BROKEN"
                                 : "NO POINT");
    if (law.held) continue;
    text += fmt::format("    {}\n", printable(law_text(law)));
    if (!worst)
      text += "    no point is left that it speaks of; change its where, or the swept values\n";
    else
      text += std::isnan(worst->measured - worst->predicted)
                  ? fmt::format("    point {}: a value that could not be measured breaks every law\n", worst->point)
                  : fmt::format("    point {}: off by {}, allowed {}\n", worst->point,
                                short_number(worst->measured - worst->predicted), short_number(worst->allowed));
    if (!law.reproduce.empty()) text += fmt::format("    reproduce: {}\n", law.reproduce);
  }
  return text + "(predicted and measured: the sample furthest off; ratio: measured / predicted over all samples)\n";
}

}  // namespace noonmark
