#include "compare/judge/laws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "compare/judge/formula.h"
#include "compare/judge/undecided.h"
#include "compare/ladder/numbers.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

double number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? value : not_a_number;
}

bool is_number(const Setting& row) {
  return row.type == ValueType::integer || row.type == ValueType::real || row.type == ValueType::flag;
}

constexpr std::string_view axes[] = {".x", ".y", ".z"};

// Every name that a formula may use, except the law's own definitions.
std::vector<std::string> number_names() {
  std::vector<std::string> names;
  for (const Setting& row : settings_table()) {
    if (is_number(row)) names.emplace_back(row.name);
    if (row.type == ValueType::point)
      for (std::string_view axis : axes) names.push_back(std::string(row.name) + std::string(axis));
  }
  for (const Metric& row : metrics_table()) names.emplace_back(row.name);
  for (const CurveQuantity& row : curve_quantities()) names.emplace_back(row.name);
  const auto of_cascades = cascade_number_names();
  names.insert(names.end(), of_cascades.begin(), of_cascades.end());
  return names;
}

// NaN if the point has no such number: a setting that is `auto`, a window that is empty, what ambiguous receivers may change.
double number_in(const PointRecord& point, const std::string& name) {
  if (ambiguous_room(point, name) > 0) return not_a_number;
  if (const auto setting = point.settings.find(name); setting != point.settings.end()) {
    if (setting->second == "true") return 1;
    if (setting->second == "false") return 0;
    return number(setting->second);
  }
  for (size_t axis = 0; axis < std::size(axes); ++axis) {
    if (!name.ends_with(axes[axis])) continue;
    const auto setting = point.settings.find(name.substr(0, name.size() - axes[axis].size()));
    if (setting == point.settings.end()) continue;
    std::string_view text = setting->second;
    for (size_t before = 0; before < axis; ++before) text.remove_prefix(std::min(text.find(','), text.size() - 1) + 1);
    return number(text.substr(0, text.find(',')));
  }
  if (const std::optional<double> of_cascade = cascade_number(point, name)) return *of_cascade;
  return quantity(point, name).value_or(not_a_number);
}

[[noreturn]] void refuse(const Law& law, const std::string& why) {
  throw Error(ErrorKind::usage, fmt::format("law '{}': {}", law.name, why));
}

// A law's formulas, parsed once.
class Reader {
 public:
  explicit Reader(const Law& law)
      : measured_(read(law, law.measured)),
        predicted_(read(law, law.predicted)),
        slack_(read(law, law.slack.empty() ? "0" : law.slack)) {
    for (const auto& [name, text] : law.let) definitions_.emplace_back(name, read(law, text));
    read_sentence(law);
    check_names(law);
  }

  double measured(const PointRecord& point) const { return value(measured_, point); }
  double predicted(const PointRecord& point) const { return value(predicted_, point); }
  double slack(const PointRecord& point) const { return value(slack_, point); }

  // Of all formulas, each as often as it stands there.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    const auto add = [&](const Formula& formula) {
      all.insert(all.end(), formula.names().begin(), formula.names().end());
    };
    for (const Formula* formula : {&measured_, &predicted_, &slack_}) add(*formula);
    for (const auto& [name, definition] : definitions_) add(definition);
    for (const Figure& figure : figures_) add(figure.formula);
    return all;
  }

  // The figures marked `against:` are computed for `other`, all others for `point`.
  std::string found(const PointRecord& point, const PointRecord& other) const {
    std::string text = end_of_sentence_;
    for (auto figure = figures_.rbegin(); figure != figures_.rend(); ++figure) {
      const double number = value(figure->formula, figure->against ? other : point);
      text = figure->before + (std::isnan(number) ? std::string(not_measured) : fmt::format("{:.3g}", number)) + text;
    }
    return text;
  }

 private:
  struct Figure {
    std::string before;  // the text before the formula
    Formula formula;
    bool against;
  };

  void read_sentence(const Law& law) {
    constexpr std::string_view prefix = "against:";
    std::string_view rest = law.found;
    for (size_t open; (open = rest.find('{')) != rest.npos;) {
      const size_t close = rest.find('}', open);
      if (close == rest.npos) refuse(law, "found has a '{' without a '}'");
      std::string_view text = rest.substr(open + 1, close - open - 1);
      const bool against = text.starts_with(prefix);
      if (against) text.remove_prefix(prefix.size());
      if (against && law.against.empty()) refuse(law, "found uses `against`, but the law has none");
      figures_.push_back({std::string(rest.substr(0, open)), read(law, std::string(text)), against});
      rest.remove_prefix(close + 1);
    }
    end_of_sentence_ = rest;
  }

  static Formula read(const Law& law, const std::string& text) {
    try {
      return Formula(text);
    } catch (const Error& error) {
      refuse(law, error.what());
    }
  }

  void check_names(const Law& law) const {
    std::vector<std::string> known = number_names();
    const auto check = [&](const Formula& formula) {
      for (const std::string& name : formula.names()) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        for (const Setting& row : settings_table())
          if (row.name == name) refuse(law, fmt::format("{} is no number; select its values with where", name));
        const std::vector<std::string_view> views(known.begin(), known.end());
        const std::string near = nearest_name(name, views);
        refuse(law, fmt::format("there is no setting, metric or definition '{}'{}", name,
                                near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
      }
    };
    for (const auto& [name, formula] : definitions_) {
      check(formula);
      if (std::find(known.begin(), known.end(), name) != known.end())
        refuse(law, fmt::format("the definition '{}' has a name that is already used", name));
      known.push_back(name);
    }
    for (const Formula* formula : {&measured_, &predicted_, &slack_}) check(*formula);
    for (const Figure& figure : figures_) check(figure.formula);
  }

  double value(const Formula& formula, const PointRecord& point) const {
    std::map<std::string, double> defined;
    const auto value_of = [&](const std::string& name) {
      const auto found = defined.find(name);
      return found == defined.end() ? number_in(point, name) : found->second;
    };
    for (const auto& [name, definition] : definitions_) defined[name] = definition.value(value_of);
    return formula.value(value_of);
  }

  Formula measured_, predicted_, slack_;
  std::vector<std::pair<std::string, Formula>> definitions_;
  std::vector<Figure> figures_;
  std::string end_of_sentence_;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// The exponent p of y ~ x^p, by least squares of the logarithms. NaN unless all values are positive and two x differ.
double exponent(const std::vector<std::pair<double, double>>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    if (!(x > 0) || !(y > 0)) return not_a_number;
    sx += std::log(x);
    sy += std::log(y);
  }
  for (const auto& [x, y] : points) {
    const double dx = std::log(x) - sx / n, dy = std::log(y) - sy / n;
    sxx += dx * dx;
    sxy += dx * dy;
  }
  return sxx > 0 ? sxy / sxx : not_a_number;
}

// The point that differs from `point` only in the settings of `against`. Null if there is none.
const PointRecord* partner(const PointRecord& point, const Conditions& against, std::span<const PointRecord> points) {
  std::map<std::string, std::string> settings = point.settings;
  for (const auto& [name, texts] : against) settings[name] = texts.front();
  const auto found =
      std::find_if(points.begin(), points.end(), [&](const PointRecord& p) { return p.settings == settings; });
  return found == points.end() ? nullptr : &*found;
}

std::vector<LawResult::Sample> samples_of(const Law& law, const Reader& reader, std::span<const PointRecord> points) {
  std::vector<LawResult::Sample> each;
  std::map<double, std::vector<double>> by_setting;
  for (const PointRecord& point : points) {
    if (!matches(point, law.where)) continue;
    const PointRecord* other = law.against.empty() ? &point : partner(point, law.against, points);
    LawResult::Sample sample{point.id, other ? reader.predicted(*other) : not_a_number, reader.measured(point), 0};
    sample.allowed = law.within * std::abs(sample.predicted) + reader.slack(point);
    each.push_back(sample);
    if (law.join == "slope") by_setting[number_in(point, law.over)].push_back(sample.measured);
  }
  if (law.join == "each" || each.empty()) return each;

  LawResult::Sample joined = each.front();
  if (law.join == "mean") {
    std::vector<double> predicted, measured, slack;
    for (const LawResult::Sample& sample : each) {
      predicted.push_back(sample.predicted);
      measured.push_back(sample.measured);
      slack.push_back(sample.allowed - law.within * std::abs(sample.predicted));
    }
    joined.predicted = mean(predicted);
    joined.measured = mean(measured);
    joined.allowed = law.within * std::abs(joined.predicted) + mean(slack);
  } else {
    std::vector<std::pair<double, double>> line;
    for (const auto& [x, values] : by_setting) line.emplace_back(x, mean(values));
    joined.measured = exponent(line);
  }
  return {joined};
}

// How far a sample is from the value that its law gives, in its own unit. Below 0 for a limit that is not reached.
double deviation(LawRelation relation, const LawResult::Sample& sample) {
  switch (relation) {
    case LawRelation::equal:
      return std::abs(sample.measured - sample.predicted);
    case LawRelation::at_most:
      return sample.measured - sample.predicted;
    case LawRelation::at_least:
      return sample.predicted - sample.measured;
  }
  return not_a_number;
}

bool holds(LawRelation relation, const LawResult::Sample& sample) {
  return std::isfinite(sample.measured) && std::isfinite(sample.predicted) && std::isfinite(sample.allowed) &&
         sample.allowed >= 0 && deviation(relation, sample) <= sample.allowed;
}

// How far off a sample is. Up to 1: the part of the tolerance that it uses. Beyond 1: its excess over the tolerance, as
// a share of its size. Infinite for values that are not finite.
double excess(LawRelation relation, const LawResult::Sample& sample) {
  const double off = deviation(relation, sample), beyond = off - sample.allowed;
  if (!std::isfinite(beyond) || !(sample.allowed >= 0)) return std::numeric_limits<double>::infinity();
  if (beyond > 0) return 1 + beyond / std::max({std::abs(sample.predicted), std::abs(sample.measured), sample.allowed});
  return sample.allowed > 0 ? off / sample.allowed : 0;
}

}  // namespace

void check_law(const Law& law) {
  if (law.name.empty()) throw Error(ErrorKind::usage, "a law needs a name");
  if (law.measured.empty() || law.predicted.empty())
    refuse(law, "needs `measured`, and one of equals, at_most and at_least");
  if (!(law.within >= 0) || !std::isfinite(law.within)) refuse(law, "within must be a fraction, 0 or more");
  if (law.join != "each" && law.join != "mean" && law.join != "slope")
    refuse(law, fmt::format("join = '{}' is not one of each | mean | slope", law.join));
  if ((law.join == "slope") != !law.over.empty())
    refuse(law, law.over.empty() ? "a slope needs `over`, the setting along which it is measured"
                                 : "only a slope has `over`");
  if (!law.over.empty() && !is_number(find_setting(law.over)))
    refuse(law, fmt::format("a slope over {}, which is no number", law.over));
  check_conditions(law.where);
  check_conditions(law.against, "against");
  for (const auto& [name, texts] : law.against)
    if (texts.size() != 1) refuse(law, fmt::format("against {} must be one value", name));
  const Reader reader(law);
}

std::vector<std::string> curve_names(const Law& law) {
  std::vector<std::string> names;
  for (const std::string* text : {&law.measured, &law.predicted, &law.slack}) {
    if (text->empty()) continue;
    const Formula formula(*text);
    for (const std::string& name : formula.names()) {
      const auto table = curve_quantities();
      if (is_cascade_bias(name) ||
          std::any_of(table.begin(), table.end(), [&](const CurveQuantity& row) { return row.name == name; }))
        names.push_back(name);
    }
  }
  return names;
}

std::vector<std::string> metric_names(const Law& law) {
  std::vector<std::string> names = Reader(law).names();
  std::erase_if(names, [](const std::string& name) {
    const auto table = metrics_table();
    return std::none_of(table.begin(), table.end(), [&](const Metric& row) { return row.name == name; });
  });
  return names;
}

std::vector<LawResult> evaluate_laws(std::span<const PointRecord> points, std::span<const Law> laws,
                                     const std::function<std::string(const PointRecord&)>& reproduce) {
  std::vector<LawResult> results;
  for (const Law& law : laws) {
    check_law(law);
    LawResult result;
    result.name = law.name;
    result.says = law.says;
    result.measured = law.measured;
    result.predicted = law.predicted;
    std::string_view separator = " at";
    for (const auto& [name, texts] : law.against) {
      result.predicted += fmt::format("{} {} = {}", separator, name, texts.front());
      separator = ",";
    }
    separator = " where";
    for (const auto& [name, texts] : law.where) {
      result.predicted += fmt::format("{} {} = {}", separator, name, fmt::join(texts, " | "));
      separator = " and";
    }
    result.relation = law.relation;
    if (law.within > 0) result.tolerance = fmt::format("within {:g}%", 100 * law.within);
    if (!law.slack.empty())
      result.tolerance += fmt::format("{}{}", result.tolerance.empty() ? "give or take " : " + ", law.slack);
    result.join = law.join == "slope" ? "slope over " + law.over : law.join;
    const Reader reader(law);
    result.samples = samples_of(law, reader, points);
    result.held = !result.samples.empty();
    for (size_t i = 0; i < result.samples.size(); ++i) {
      result.held = result.held && holds(law.relation, result.samples[i]);
      if (result.worst < 0 || excess(law.relation, result.samples[i]) >
                                  excess(law.relation, result.samples[static_cast<size_t>(result.worst)]))
        result.worst = static_cast<int>(i);
    }
    if (result.worst >= 0) {
      const int64_t id = result.samples[static_cast<size_t>(result.worst)].point;
      const auto point = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.id == id; });
      if (point != points.end()) {
        result.reproduce = reproduce(*point);
        const PointRecord* other = law.against.empty() ? &*point : partner(*point, law.against, points);
        if (other) result.found = reader.found(*point, *other);
        for (const std::string& name : reader.names())
          if (!result.held && ambiguous_room(*point, name) > 0) {
            result.found = fmt::format("{} is not known, because the truth of {} of the receivers is ambiguous", name,
                                       share_text(metric_of(*point, "ambiguous")));
            break;
          }
      }
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace noonmark
