#include "app/advise/recommend_around.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "app/advise/recommend_judge.h"
#include "base/error.h"
#include "compare/results/quantities.h"
#include "measure/memory_estimate.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// Where the map lies and how it is measured are no choices of a technique.
constexpr std::array not_a_choice{"map.placements", "map.shift_u_texels", "map.shift_v_texels"};

bool is_tunable(const Setting& row, const Settings& settings, LightKind light) {
  if (row.type != ValueType::integer && row.type != ValueType::real) return false;
  if (!row.name.starts_with("map.") && !row.name.starts_with("bias.") && !row.name.starts_with("filter.")) return false;
  if (std::find(not_a_choice.begin(), not_a_choice.end(), row.name) != not_a_choice.end()) return false;
  if (row.why_idle && !row.why_idle(settings, light).empty()) return false;
  const std::optional<double> value = number_of(row.get(settings));
  return value && *value > 0;
}

class Around {
 public:
  Around(Workbench& bench, std::span<const Settings> conditions, const AroundOptions& options)
      : bench_(bench), conditions_(conditions), options_(options) {}

  // The settings of all conditions with one value changed.
  TornadoEnd at(const Setting& row, double value) {
    TornadoEnd end;
    end.value = text_of(row, value);
    end.held = true;
    for (Settings settings : conditions_) {
      try {
        row.set(settings, end.value);
        add(settings, end);
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::usage) throw;
        end.held = false;
        end.why_not = "not possible: " + std::string(error.what());
        return end;
      }
    }
    return end;
  }

  TornadoEnd as_recommended() {
    TornadoEnd end;
    end.held = true;
    for (const Settings& settings : conditions_) add(settings, end);
    return end;
  }

  // Away from the recommended value by factors of sqrt(2) as long as the bounds hold, then between the last two values.
  TornadoEnd range_end(const Setting& row, double value, bool up, TornadoEnd recommended, bool& open) {
    TornadoEnd last = std::move(recommended);
    double held = value, broken = 0;
    const double step = up ? std::sqrt(2.0) : 1 / std::sqrt(2.0);
    for (double next = value * step; ratio(next, value) <= most_around * 1.001; next *= step) {
      TornadoEnd end = at(row, next);
      if (!end.held) {
        broken = next;
        break;
      }
      held = next, last = std::move(end);
    }
    open = broken == 0;
    while (!open && ratio(held, broken) > end_around) {
      const double middle = std::sqrt(held * broken);
      if (text_of(row, middle) == text_of(row, held) || text_of(row, middle) == text_of(row, broken)) break;
      TornadoEnd end = at(row, middle);
      if (end.held)
        held = middle, last = std::move(end);
      else
        broken = middle;
    }
    return last;
  }

  bool placed() const { return placed_; }

 private:
  static double ratio(double a, double b) { return std::max(a, b) / std::min(a, b); }

  // Three digits are enough to say what was tried, and are what is measured.
  static std::string text_of(const Setting& row, double value) {
    return row.type == ValueType::integer ? fmt::format("{:.0f}", value)
                                          : fmt::format("{}", std::stod(fmt::format("{:.4g}", value)));
  }

  void add(const Settings& settings, TornadoEnd& end) {
    require_memory(bench_.memory(settings, false, false), bench_.memory_of_program(false), "the search");
    const PointRecord point =
        bench_.measure(settings, std::nullopt, metric_set_for(options_.accuracy), Checks::none).record;
    if (nothing_judged(point)) return;  // a view that sees nothing says nothing of the technique
    if (!has_placements(point) || placed_names(options_.accuracy).largest.empty()) placed_ = false;
    const double error = worst_placed(point, options_.accuracy);
    if (!(error <= end.error)) end.error = error;
    const double coverage = worst_placed(point, "coverage");
    if (!allowed_coverage_) allowed_coverage_ = coverage + options_.bounds.acne_bound;
    if (!(worst_placed(point, "acne") <= options_.bounds.acne_bound &&
          worst_placed(point, "peter_panning") <= options_.bounds.peter_panning_bound &&
          coverage <= *allowed_coverage_))
      end.held = false;
  }

  Workbench& bench_;
  std::span<const Settings> conditions_;
  const AroundOptions& options_;
  bool placed_ = true;
  // No bound of a search is about coverage, but a range must not lose the shadows that the recommended map has. It is that of
  // the first condition as recommended, and once more what acne may be.
  std::optional<double> allowed_coverage_;
};

double spread(const TornadoRow& row, double error) {
  double most = 0;
  for (const TornadoEnd* end : {&row.half, &row.twice})
    if (end->why_not.empty()) most = std::max(most, std::abs(end->error - error));
  return most;
}

}  // namespace

Tornado settings_around(Workbench& bench, std::span<const Settings> conditions, const AroundOptions& given,
                        const std::function<void(const std::string&)>& say) {
  AroundOptions options = given;
  options.accuracy = placed_accuracy(bench, conditions.front(), given.accuracy);
  const Settings first = conditions.front();
  const LightKind light = make_light_frame(bench.scene(first.scene), first).kind;
  Around around(bench, conditions, options);
  Tornado tornado;
  const TornadoEnd recommended = around.as_recommended();
  tornado.error = recommended.error, tornado.held = recommended.held;
  tornado.accuracy = options.accuracy;
  tornado.conditions = conditions.size();
  tornado.placements = first.map.placements * first.map.placements;
  for (const Setting& row : settings_table()) {
    if (!is_tunable(row, first, light)) continue;
    const double value = *number_of(row.get(first));
    say(fmt::format("around {} = {}", row.name, row.get(first)));
    TornadoRow made;
    made.setting = row.name, made.unit = row.unit, made.value = row.get(first);
    made.unit = unit_of_amount(made.unit, first.bias);
    made.half = around.at(row, value / 2);
    made.twice = around.at(row, value * 2);
    TornadoEnd here = recommended;
    here.value = made.value;
    made.low = made.high = here;
    if (recommended.held) {
      made.low = around.range_end(row, value, false, here, made.low_open);
      made.high = around.range_end(row, value, true, here, made.high_open);
    }
    tornado.rows.push_back(std::move(made));
  }
  tornado.placed = around.placed();
  std::stable_sort(tornado.rows.begin(), tornado.rows.end(), [&](const TornadoRow& a, const TornadoRow& b) {
    return spread(a, tornado.error) > spread(b, tornado.error);
  });
  return tornado;
}

}  // namespace noonmark
