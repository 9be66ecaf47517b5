#include "compare/report/live_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/report/blocks.h"
#include "compare/report/deflate.h"
#include "compare/report/opening.h"
#include "compare/report/page_parts.h"
#include "compare/report/point_data.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using nlohmann::json;

// The marks on the slider, in window depth: the bias as set, the recommended one (of the choice, or else the best of
// the point's own curve) and the usable window.
json marks_of(const PointRecord& point, const Recommendation& recommendation) {
  json marks = json::object();
  if (const std::optional<double> set = bias_as_set(point); set && std::isfinite(*set)) marks["set"] = *set;
  const bool chosen = recommendation.bias && recommendation.choice.first().id == point.id;
  const double per_depth = parameter_per_depth(point);
  if (chosen && std::isfinite(per_depth) && per_depth > 0)
    marks["recommended"] = recommendation.bias->value / per_depth;
  else if (has_curve(point) && std::isfinite(best_depth(point)))
    marks["best"] = best_depth(point);
  if (const std::optional<Interval> window = usable_window(point))
    marks["window"] = json::array({window->low, window->high});
  return marks;
}

// The value of a stack that is this one but for its conversion from window depth; empty if there is none.
std::optional<double> stacked_value(const json& head, double value) {
  for (const json& one : head.at("values"))
    if (const double known = one.at("value").get<double>(); std::abs(known - value) <= 1e-9 * std::abs(known))
      return known;
  return std::nullopt;
}

// The same marks on the slider of a stack, in the parameter's unit. The ends of the window are values of the stack where the
// point had the same window when it was drawn.
json stack_marks(const PointRecord& point, const Recommendation& recommendation, const json& head) {
  json marks = json::object();
  const std::string parameter = head.at("parameter").get<std::string>();
  if (const std::optional<double> set = number_of(setting_of(point, parameter)); set && std::isfinite(*set))
    marks["set"] = *set;
  if (curve_parameter(point) != parameter) return marks;
  const double per_depth = parameter_per_depth(point);
  const json in_depth = marks_of(point, recommendation);
  for (const char* const name : {"recommended", "best"})
    if (in_depth.contains(name)) {
      const double value = in_depth.at(name).get<double>() * per_depth;
      marks[name] = stacked_value(head, value).value_or(value);
    }
  if (in_depth.contains("window"))
    marks["window"] = json::array(
        {in_depth.at("window")[0].get<double>() * per_depth, in_depth.at("window")[1].get<double>() * per_depth});
  return marks;
}

// The arrays of the file (compare/ladder/live_file.h), compressed. The first one, floats, is in byte planes.
std::string packed(std::string_view arrays, size_t answers) {
  const size_t floats = sizeof(float) * answers;
  if (floats > arrays.size()) throw std::runtime_error("the file of the live picture is too short");
  return deflated(byte_planes(arrays.substr(0, floats), sizeof(float)) + std::string(arrays.substr(floats)));
}

Markup without_picture(const std::string& why) {
  return paragraph(css("small"), prose("The live picture is not shown: {}. Points with pictures have one. Run the "
                                       "experiment with {} or another value "
                                       "than none.",
                                       why, code("pictures = \"first\"")));
}

// What page/live.js fills: buttons, the picture, the slider with its marks, and what is seen.
Markup live_stage(const json& head, const std::string& slider_label, const Markup& caption) {
  const Markup canvas =
      element("canvas", Attribute("width", head.value("width", 0)), Attribute("height", head.value("height", 0)),
              Attribute("role", "img"), Attribute("aria-label", "The picture at the chosen bias"));
  const Markup slider = div(css("bias-slider"), div(css("bias-marks"), Attribute("aria-hidden", "true")),
                            element("input", Attribute("type", "range"), Attribute("aria-label", slider_label)));
  return element("figure", css("chart js-only"), Attribute("id", "live-picture"), div(css("controls")), canvas, slider,
                 element("p", css("facts"), Attribute("aria-live", "polite")), div(css("legend")),
                 element("figcaption", caption)) +
         "\n";
}

Markup stack_caption(const json& head, const Markup& of_point, const std::string& phrase, bool at_recommended) {
  const json& values = head.at("values");
  const std::string unit = head.value("unit", std::string());
  return prose(
      "{}{}: exact pictures at {} values of {}, from {} to {}; between them nothing is drawn, because {}. Each pixel "
      "has the light "
      "and the cause that OpenGL's picture has with that value; only the grey of the shading is rounded. At the value "
      "as "
      "set{} it is the point's own picture, with its numbers; at others {} × {} pixels, measured for themselves.",
      of_point, phrase.empty() ? "" : ", " + phrase, values.size(), code(head.value("parameter", std::string())),
      bias_in_unit(values.front().at("value").get<double>(), unit),
      bias_in_unit(values.back().at("value").get<double>(), unit), head.value("why", std::string()),
      at_recommended ? ", and at the recommended one," : "", head.value("width", 0), head.value("height", 0));
}

// Of a lookup whose reduction is no free setting: why the slider varies the bias.
const char* slider_of_bias(const PointRecord& point, const json& head) {
  return has_fixed_reduction(point) && head.value("parameter", std::string()).starts_with("bias.")
             ? " lookup.reduction_span gives the reduction of this lookup a fixed form, so the slider varies its bias."
             : "";
}

// Where the picture is of another point than the answer: which one that is, and why it is not shown. Otherwise empty.
Markup other_than_the_answer(const PointRecord& point, const ShownPoints& shown) {
  const PointRecord* const answer = answer_point(shown);
  if (!answer || answer->id == point.id) return "";
  const Markup link = point_link(answer->id, prose("point {}", answer->id));
  if (live_image(*answer))
    return prose(" The answer is {}; this one is shown because the page's head speaks of it.", link);
  return prose(" The answer is {}, which has no pictures; {} makes those of answers.", link,
               code("pictures = \"answers\""));
}

// Throws std::exception if the bytes are not those of a live picture.
Markup figure_of(const PointRecord& point, const std::string& bytes, const ShownPoints& shown) {
  json head = json::parse(bytes.substr(0, bytes.find('\n')));
  head["data"] = base64(packed(std::string_view(bytes).substr(bytes.find('\n') + 1), head.value("answers", size_t{0})));
  head["point"] = point.id;
  const bool stack = head.value("kind", "thresholds") == "stack";
  head["marks"] = stack ? stack_marks(point, shown.recommended, head) : marks_of(point, shown.recommended);
  const std::vector<PictureRecord> pictures = pictures_for_page(point, recommended_biases(shown));
  const bool at_other = std::any_of(pictures.begin(), pictures.end(), [](const PictureRecord& picture) {
    return picture.name == at_recommended_bias("map");
  });
  const Markup other = other_than_the_answer(point, shown);
  const Markup of_point = point_link(point.id, prose("Point {}", point.id));
  if (stack) {
    // The picture is at several values of it, so the one that was set is not its name.
    std::vector<std::string> names = shown.all.info.swept;
    std::erase(names, head.value("parameter", std::string()));
    const std::string phrase = settings_phrase(point, names);
    return live_stage(head, fmt::format("{}, one step for each picture", head.value("parameter", std::string())),
                      stack_caption(head, of_point, phrase, at_other) + slider_of_bias(point, head) + other) +
           data_block("live-data", head) + "\n";
  }
  // The picture is at every bias, so the one that was set is not its name.
  const std::string phrase = settings_phrase(point, without_curve_parameter(point, shown.all.info.swept));
  const Markup caption = prose(
      "{}{}, at every bias: each pixel has the light and the cause that OpenGL's picture has with that bias, exactly; "
      "only the grey of the shading is rounded. At the bias as set{} it is the point's own picture, with its numbers; "
      "at others {} × {} pixels, measured for themselves. The marks are those of the own picture.",
      of_point, phrase.empty() ? "" : ": " + phrase, at_other ? ", and at the recommended one," : "",
      head.value("width", 0), head.value("height", 0));
  return live_stage(head, "Bias, on a logarithmic scale", caption + other) + data_block("live-data", head) + "\n";
}

}  // namespace

bool has_live_picture(const Results& results) {
  return std::any_of(results.points.begin(), results.points.end(),
                     [](const PointRecord& point) { return live_image(point) != nullptr; });
}

Markup live_figure(const ShownPoints& shown, const std::function<std::string(const std::string&)>& read_file) {
  const PointRecord* const point = opening(shown).point;
  if (!point) return "";
  try {
    return figure_of(*point, read_file(live_image(*point)->path), shown);
  } catch (const std::exception& error) {
    return without_picture(error.what());
  }
}

}  // namespace noonmark::report
