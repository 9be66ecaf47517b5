// The input is the text of formulas, one per line. Each is tried alone, then as a side of a law. A formula must be
// refused with Error(usage) or have the same value each time. If a value is unknown (NaN), the result must be unknown
// too. A law must give one verdict.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "compare/judge/formula.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "tests/fuzz/names.h"
#include "tests/fuzz/targets.h"
#include "tests/support/sample_results.h"

namespace noonmark::fuzz {
namespace {

void require_usage(const Error& error) {
  require(error.kind() == ErrorKind::usage, std::string("an error of another kind: ") + error.what());
  require(*error.what() != '\0', "an error without a message");
}

bool same_bits(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

void run_formula(const std::string& text) {
  try {
    const Formula formula(text);
    for (size_t i = 1; i < formula.names().size(); ++i)
      require(formula.names()[i - 1] < formula.names()[i], "names out of order, or twice: " + text);
    const auto by_length = [](const std::string& name) { return 0.25 * static_cast<double>(name.size()); };
    const double first = formula.value(by_length);
    require(same_bits(first, Formula(text).value(by_length)), "another value when read again: " + text);
    if (!formula.names().empty()) {
      const double unknown = formula.value([&](const std::string& name) {
        return name == formula.names().back() ? std::numeric_limits<double>::quiet_NaN() : 1.0;
      });
      require(std::isnan(unknown), "a value although a name has none: " + text);
    }
  } catch (const Error& error) {
    require_usage(error);
  }
}

void run(const std::string& bytes) {
  std::vector<std::string> lines;
  std::istringstream in(bytes);
  for (std::string line; std::getline(in, line) && lines.size() < 6;) lines.push_back(line);
  for (const std::string& line : lines) run_formula(line);
  if (lines.size() < 2) return;

  static const std::vector<PointRecord> points = {sample_point(0), sample_point(1, false), sample_point(2)};
  Law law;
  law.name = "fuzzed";
  law.measured = lines[0];
  law.predicted = lines[1];
  if (lines.size() > 2) law.found = lines[2];
  if (lines.size() > 3) law.slack = lines[3];
  for (size_t i = 4; i < lines.size(); ++i) law.let.emplace_back(std::string(1, static_cast<char>('a' + i)), lines[i]);
  try {
    check_law(law);
    const std::vector<LawResult> results = evaluate_laws(points, {&law, 1}, [](const PointRecord&) { return "x"; });
    require(results.size() == 1, "not one result for one law");
    const LawResult& result = results[0];
    require(result.worst < static_cast<int>(result.samples.size()), "a worst sample that there is none of");
    if (result.held) {
      require(result.worst >= 0, "held without a sample");
      for (const LawResult::Sample& s : result.samples)
        require(std::isfinite(s.measured) && std::isfinite(s.predicted) && s.allowed >= 0, "held by what is no number");
    }
    law_text(result);
    predicted_text(result);
    ratio_text(result);
    law_table(results);
  } catch (const Error& error) {
    require_usage(error);
  }
}

std::vector<std::string> seeds() {
  return {"(k + 0.5) * texel_m * tan_deg(scene.theta_deg)",
          "acne_free_bias_m\n0.5 * texel_m * A\n{100 * acne} % are acne, {against: 100 * acne} % without.\n3 * 2^-25 * "
          "map_range_m\n(filter.size - 1) / 2 + 0.5\nabs(cos_deg(scene.phi_deg)) + e",
          "acne\nmin(1, max(0, error, 0.2)) > 0.1 ? hypot(1, 2) : atan2(-1, pi)\n\nfloor(exp(-ln(2)) / 0)",
          "a && b || !(c != d) ? 1e-5 ^ -2 : sqrt(log2(8) + log10(.1))"};
}

std::vector<std::string> words() {
  std::vector<std::string> all = {
      "sin(",      "cos(",   "tan(",   "asin(", "acos(",      "atan(", "atan2(", "sin_deg(", "cos_deg(",    "tan_deg(",
      "atan_deg(", "hypot(", "sqrt(",  "exp(",  "ln(",        "log2(", "log10(", "abs(",     "min(",        "max(",
      "floor(",    "pi",     "==",     "!=",    "<=",         ">=",    "&&",     "||",       "?",           ":",
      "^",         "1e308",  "1e-320", "0x1",   "{against: ", "{",     "}",      "\n",       "view.eye_m.x"};
  for (const std::string& name : program_names()) all.push_back(name);
  return all;
}

}  // namespace

const Target formula_target = {"formula", run, seeds, words, mutate_text<words>};

}  // namespace noonmark::fuzz
