#include "compare/ladder/picture_stack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/ladder/live_arrays.h"
#include "compare/ladder/measure.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// The mean size of a cause's step over the counted receivers, the metric of its name. NaN if there are none.
double caused(const Ladder& ladder, Cause cause) {
  double sum = 0, counted = 0;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    sum += std::abs(static_cast<double>(ladder[cause][i]));
    ++counted;
  }
  return counted == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / counted;
}

}  // namespace

const BiasPart* stacked_part(const Settings& settings) {
  if (has_reduction_curve(settings)) return nullptr;
  if (const BiasPart* const part = curve_part(settings.bias)) return part;
  for (const BiasPart& part : bias_parts())
    if (settings.bias[part.name] != 0) return &part;
  return &bias_part("constant");
}

std::span<const Cause> stack_causes(std::string_view parameter) {
  static constexpr Cause of_bias[] = {Cause::acne, Cause::peter_panning},
                         of_reduction[] = {Cause::leak, Cause::over_darkening, Cause::reduction};
  return parameter == "lookup.reduction" ? std::span<const Cause>(of_reduction) : of_bias;
}

std::vector<double> stack_values(double most, double as_set, const std::vector<double>& marks, double otherwise) {
  std::vector<double> values{0};
  // The shader's amounts are floats: values that are the same float have the same picture.
  const auto add = [&](double value) {
    const auto same = [&](double known) { return static_cast<float>(known) == static_cast<float>(value); };
    if (values.size() < most_stacked && value >= 0 && value <= most && std::none_of(values.begin(), values.end(), same))
      values.push_back(value);
  };
  add(as_set);
  double middle = as_set;
  for (const double mark : marks) {
    add(mark);
    if (!(middle > 0) && mark > 0 && mark <= most) middle = mark;
  }
  if (!(middle > 0)) middle = std::min(otherwise, most);
  for (int step = 0; step < 2 * static_cast<int>(most_stacked); ++step)
    for (const int sign : {1, -1}) add(middle * std::exp2(0.5 * sign * step));
  std::sort(values.begin(), values.end());
  return values;
}

PictureStack empty_picture_stack(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                                 std::string parameter) {
  PictureStack stack;
  stack.parameter = std::move(parameter);
  stack.flags = Image<uint8_t>(receivers.width(), receivers.height(), 0);
  stack.n_dot_l = stack.flags;
  stack.answers.resize(stack.flags.size());
  for (size_t i = 0; i < stack.flags.size(); ++i) {
    stack.flags[i] = static_cast<uint8_t>((truth.facing[i] ? live_facing : 0) | (truth.lit[i] != 0 ? live_lit : 0) |
                                          (truth.ambiguous[i] ? live_ambiguous : 0) |
                                          (receivers.primitive[i] != no_primitive ? live_surface : 0));
    stack.n_dot_l[i] = live_cosine(probe.n_dot_l[i]);
  }
  return stack;
}

void add_picture(PictureStack& stack, double value, const Ladder& ladder) {
  const auto number = static_cast<uint8_t>(stack.values.size());
  PictureStack::Value told{value, error_of(ladder), {}};
  for (const Cause cause : stack_causes(stack.parameter)) told.causes.push_back(caused(ladder, cause));
  stack.values.push_back(std::move(told));
  for (size_t i = 0; i < stack.answers.size(); ++i) {
    if (!(stack.flags[i] & live_facing)) continue;
    const PictureStack::Answer answer{number, ladder.cause[i], ladder.shown()[i]};
    std::vector<PictureStack::Answer>& answers = stack.answers[i];
    if (answers.empty() || answers.back().cause != answer.cause || answers.back().light != answer.light)
      answers.push_back(answer);
  }
}

std::string stack_file(const PictureStack& stack) {
  std::vector<float> light;
  std::vector<uint8_t> from, cause, count;
  for (const std::vector<PictureStack::Answer>& answers : stack.answers) {
    count.push_back(static_cast<uint8_t>(answers.size()));
    for (const PictureStack::Answer& answer : answers) {
      light.push_back(answer.light);
      from.push_back(answer.from);
      cause.push_back(answer.cause);
    }
  }
  nlohmann::ordered_json head{{"kind", "stack"},         {"width", stack.flags.width},   {"height", stack.flags.height},
                              {"answers", light.size()}, {"parameter", stack.parameter}, {"unit", stack.unit},
                              {"why", stack.why}};
  for (const Cause one : stack_causes(stack.parameter)) head["told"].push_back(cause_name(one));
  for (const PictureStack::Value& one : stack.values) {
    nlohmann::ordered_json told{{"value", one.value}, {"error", one.error}};
    for (size_t k = 0; k < one.causes.size(); ++k) told[head["told"][k].get<std::string>()] = one.causes[k];
    head["values"].push_back(std::move(told));
  }
  if (stack.scale) {
    head["depth_per_unit"] = stack.scale->depth_per_unit;
    head["m_per_depth"] = stack.scale->m_per_depth;
    head["texels_per_depth"] = stack.scale->texels_per_depth;
  }
  std::string file = live_head(std::move(head));
  append_array(file, light);
  for (const std::vector<uint8_t>* values : std::initializer_list<const std::vector<uint8_t>*>{
           &from, &cause, &stack.flags.pixels, &stack.n_dot_l.pixels, &count})
    append_array(file, *values);
  return file;
}

}  // namespace noonmark
