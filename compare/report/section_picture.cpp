#include "compare/report/section_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "compare/report/cause_colors.h"
#include "compare/report/element.h"
#include "compare/report/section_words.h"
#include "compare/results/number_text.h"

namespace noonmark::report {
namespace section_drawing {
namespace {

// In pixels of the picture, which has 400 across.
constexpr double width = 400, margin = 10;
constexpr double left = 46, right = width - margin, top = 40, bottom = 268;  // of the drawing
constexpr double plan_side = 116, plan_left = width - margin - plan_side, plan_top = 312;
constexpr double words_top = 452, line_height = 16;
constexpr size_t line_letters = 60;  // of 12 px in the widest of the usual sans-serif fonts, within 380 px
constexpr size_t most_lines = 600;   // surfaces of a dense mesh; the nearest to the receiver are drawn

struct ThemeColor {
  const char *name, *light, *dark;
};
constexpr std::array<ThemeColor, 8> theme_colors{{{"paper", "#ffffff", "#1b1f23"},
                                                  {"ink", "#1f2328", "#e6e4df"},
                                                  {"soft", "#5b626b", "#a5abb3"},
                                                  {"rule", "#e0ddd5", "#31373d"},
                                                  {"shade", "#d3d6dd", "#0c0e10"},
                                                  {"step", "#6a4bc4", "#b9a3ff"},
                                                  {"light", "#9a5b00", "#e3a64a"},
                                                  {"dark", "#3a4049", "#8d949d"}}};

std::string style_text(SectionTheme theme) {
  std::string text;
  const auto variables = [](bool dark) {
    std::string all;
    for (const ThemeColor& color : theme_colors)
      all += fmt::format("--{}:{};", color.name, dark ? color.dark : color.light);
    return all;
  };
  if (theme == SectionTheme::automatic)
    text += fmt::format("svg{{{}}}@media (prefers-color-scheme:dark){{svg{{{}}}}}", variables(false), variables(true));
  for (const ThemeColor& color : theme_colors) {
    const std::string value = theme == SectionTheme::automatic ? fmt::format("var(--{})", color.name)
                              : theme == SectionTheme::dark    ? color.dark
                                                               : color.light;
    text += fmt::format(".f-{0}{{fill:{1}}}.s-{0}{{stroke:{1}}}", color.name, value);
    if (std::string_view(color.name) == "paper") text += fmt::format(".halo{{stroke:{}}}", value);
  }
  return text +
         "text{font:12px system-ui,'Segoe UI',Roboto,'DejaVu Sans',sans-serif}"
         ".title{font-size:15px;font-weight:600}.small{font-size:11px}"
         ".halo{stroke-width:3px;stroke-linejoin:round;paint-order:stroke}"
         ".line{fill:none;stroke-linejoin:round}.surface{stroke-width:2}.steps{stroke-width:1.8}";
}

std::string n(double value) { return fmt::format("{:.2f}", value); }

std::string color_text(std::string_view cause) {
  const CauseColor* const color = find_color(cause);
  return color ? fmt::format("#{:02x}{:02x}{:02x}", color->r, color->g, color->b) : "none";
}

Markup text_at(double x, double y, const Markup& content, std::string_view classes, const char* anchor = "start") {
  return element("text", Attribute("x", n(x)), Attribute("y", n(y)), Attribute("text-anchor", anchor), css(classes),
                 content);
}

Markup line_between(double x1, double y1, double x2, double y2, std::string_view classes, double stroke = 1,
                    const char* dashes = "none") {
  return element("line", Attribute("x1", n(x1)), Attribute("y1", n(y1)), Attribute("x2", n(x2)), Attribute("y2", n(y2)),
                 css(classes), Attribute("stroke-width", n(stroke)), Attribute("stroke-dasharray", dashes));
}

Markup box(double x, double y, double w, double h, std::string_view classes) {
  return element("rect", Attribute("x", n(x)), Attribute("y", n(y)), Attribute("width", n(w)),
                 Attribute("height", n(h)), css(classes));
}

Markup path(const std::string& d, std::string_view classes) { return element("path", Attribute("d", d), css(classes)); }

// A vertical arrow whose point is at y2.
Markup arrow(double x, double y1, double y2, const char* color) {
  const double back = y2 > y1 ? -6 : 6;
  const double length = std::min(std::abs(back), std::abs(y2 - y1));
  const double shoulder = y2 + std::copysign(length, back);
  return line_between(x, y1, x, shoulder, fmt::format("s-{}", color), 1.6) +
         path(fmt::format("M{} {}L{} {}L{} {}Z", n(x - 3.5), n(shoulder), n(x + 3.5), n(shoulder), n(x), n(y2)),
              fmt::format("f-{}", color));
}

// The depths that the drawing must show, from near to far. Depth is 0 at the receiver's reference.
class Scale {
 public:
  explicit Scale(const ReceiverSection& section) : section_(section) {
    const SectionTap& key = section.taps[section.key_tap];
    low_ = high_ = section.reference_m;
    const auto show = [&](double depth) {
      low_ = std::min(low_, depth);
      high_ = std::max(high_, depth);
    };
    show(section.receiver_m);
    show(key.compared_m);
    show(key.reference_m);
    if (key.exact_m < section.reference_m) show(key.exact_m);
    if (!key.moved_lit && section.blocker_m) show(*section.blocker_m);
    const double rise = glm::length(section.gradient_m) * 1.2;  // of the surface to beyond the neighbouring texel
    show(section.reference_m - rise);
    show(section.reference_m + rise);
    // A surface that faces the light, with no bias: the drawing shows a depth as large as a texel.
    if (!(high_ - low_ > section.texel_m * 0x1p-20)) {
      show(section.reference_m - section.texel_m / 2);
      show(section.reference_m + section.texel_m / 2);
    }
    const double pad = 0.12 * (high_ - low_);
    low_ -= pad;
    high_ += pad;
  }
  double x(double s) const { return left + (s + section_.reach) / (2 * section_.reach) * (right - left); }
  double y(double depth) const { return top + (depth - low_) / (high_ - low_) * (bottom - top); }
  double held(double depth) const { return std::clamp(y(depth), top, bottom); }
  bool shows(double depth) const { return depth >= low_ && depth <= high_; }
  double low() const { return low_; }
  double high() const { return high_; }
  double metres_per_pixel() const { return (high_ - low_) / (bottom - top); }
  double metres_per_pixel_across() const { return 2 * section_.reach * section_.texel_m / (right - left); }

 private:
  const ReceiverSection& section_;
  double low_ = 0, high_ = 1;
};

struct DepthUnit {
  double metres;
  const char* name;
};
DepthUnit unit_of(double range_m) {
  for (const DepthUnit unit : {DepthUnit{1e3, "km"}, DepthUnit{1, "m"}, DepthUnit{1e-3, "mm"}, DepthUnit{1e-6, "µm"}})
    if (range_m >= 2 * unit.metres) return unit;
  return {1e-9, "nm"};
}

// Ticks at 1, 2 or 5 times a power of ten, from 3 to 7 of them.
Markup axis(const ReceiverSection& section, const Scale& scale) {
  const double range = scale.high() - scale.low();
  const DepthUnit unit = unit_of(range);
  const double rough = range / unit.metres / 5, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double times : {5.0, 2.0, 1.0})
    if (times * power >= rough) step = times * power;
  Markup out;
  const auto first = static_cast<long>(std::ceil((scale.low() - section.reference_m) / unit.metres / step));
  for (long k = first; section.reference_m + static_cast<double>(k) * step * unit.metres <= scale.high(); ++k) {
    const double value = static_cast<double>(k) * step, y = scale.y(section.reference_m + value * unit.metres);
    out += line_between(left - 3, y, left, y, "s-soft");
    out += text_at(left - 5, y + 4, (value < 0 ? "\u2212" : "") + number_text(std::abs(value)), "f-soft small", "end");
  }
  return out +
         text_at(margin, top - 7, fmt::format("{} behind the receiver, along the light", unit.name), "f-soft small");
}

Markup drawn_columns(const ReceiverSection& section, const Scale& scale) {
  Markup shade, edges, steps;
  for (const SectionColumn& column : section.columns) {
    const double x1 = scale.x(column.from), x2 = scale.x(column.to), y = scale.held(column.stored_m);
    if (y < bottom) shade += box(x1, y, x2 - x1, bottom - y, "f-shade");
    edges += line_between(x1, top, x1, bottom, "s-rule") + line_between(x2, top, x2, bottom, "s-rule");
    if (scale.shows(column.stored_m)) steps += line_between(x1, y, x2, y, "s-step steps", 1.8);
    if (column.stored_m < scale.low())
      steps += path(fmt::format("M{0} {1}l4 6h-8Z", n((x1 + x2) / 2), n(top + 2)), "f-step");
    if (!column.inside && x2 - x1 > 40)
      steps += text_at((x1 + x2) / 2, bottom - 6, "outside", "f-soft small halo", "middle");
  }
  // The centres to which the stored depths belong. Those whose projection falls into another column are not drawn.
  const SectionTap& key = section.taps[section.key_tap];
  for (const SectionColumn& column : section.columns) {
    const bool of_key = column.texel == key.texel && key.same_tile;
    if (!scale.shows(column.stored_m) || column.border) continue;
    if (column.centre >= column.from && column.centre <= column.to)
      steps +=
          element("circle", Attribute("cx", n(scale.x(column.centre))), Attribute("cy", n(scale.y(column.stored_m))),
                  Attribute("r", of_key ? "3.2" : "2.2"), css("f-step"));
    else if (of_key)
      steps += line_between(scale.x(std::clamp(column.centre, column.from, column.to)), scale.y(column.stored_m),
                            scale.x(std::clamp(column.centre, -section.reach, section.reach)), scale.y(column.stored_m),
                            "s-step", 1.2, "2 2") +
               element("circle", Attribute("cx", n(scale.x(std::clamp(column.centre, -section.reach, section.reach)))),
                       Attribute("cy", n(scale.y(column.stored_m))), Attribute("r", "3.2"), css("f-step"));
  }
  return shade + edges + steps;
}

struct Surfaces {
  Markup drawn;
  size_t left_out = 0;
};
Surfaces surfaces(const ReceiverSection& section, const Scale& scale) {
  std::vector<std::pair<double, const SectionLine*>> shown;
  for (const SectionLine& line : section.surfaces) {
    double nearest = line.points.front().y, farthest = nearest, away = std::abs(nearest - section.reference_m);
    for (const glm::dvec2& point : line.points) {
      nearest = std::min(nearest, point.y);
      farthest = std::max(farthest, point.y);
      away = std::min(away, std::abs(point.y - section.reference_m));
    }
    if (farthest >= scale.low() && nearest <= scale.high()) shown.emplace_back(away, &line);
  }
  std::stable_sort(shown.begin(), shown.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Surfaces out{{}, shown.size() - std::min(shown.size(), most_lines)};
  shown.resize(std::min(shown.size(), most_lines));
  std::string d;
  for (const auto& [away, line] : shown)
    for (size_t k = 0; k < line->points.size(); ++k) {
      // A steep wall leaves the picture by kilometres; the clip path cuts it, but a renderer's numbers are finite.
      const double y = std::clamp(scale.y(line->points[k].y), -1e5, 1e5);
      d += fmt::format("{}{:.2f} {:.2f}", k == 0 ? "M" : "L", scale.x(line->points[k].x), y);
    }
  if (!d.empty()) out.drawn = path(d, "line surface s-ink");
  return out;
}

std::string tap_mark(const ReceiverSection& section, const SectionTap& tap) {
  if (tap.cause != Cause::none) return color_text(cause_name(tap.cause));
  return section.cause == Cause::precision && tap.lit != tap.shown_lit ? color_text("precision") : "";
}

// A tap is drawn at its compared depth: in the column of the texel that it reads, which is judged there.
Markup taps(const ReceiverSection& section, const Scale& scale) {
  Markup out;
  for (const SectionTap& tap : section.taps) {
    const auto column = std::find_if(section.columns.begin(), section.columns.end(),
                                     [&](const SectionColumn& one) { return tap.same_tile && one.texel == tap.texel; });
    if (column == section.columns.end() || !scale.shows(tap.compared_m)) continue;
    const bool at_place = column->from <= 0 && column->to >= 0;
    const double x = scale.x(at_place ? 0 : (column->from + column->to) / 2), y = scale.y(tap.compared_m);
    const std::string wrong = tap_mark(section, tap);
    if (!wrong.empty())
      out += element("circle", Attribute("cx", n(x)), Attribute("cy", n(y)), Attribute("r", "7"),
                     Attribute("fill", "none"), Attribute("stroke", wrong), Attribute("stroke-width", "2.6"));
    out += element("circle", Attribute("cx", n(x)), Attribute("cy", n(y)), Attribute("r", "4"),
                   css(tap.lit ? "f-paper s-ink" : "f-ink s-paper"), Attribute("stroke-width", "1.3"));
  }
  return out;
}

// The distance by which acne misses the stored depth, or by which Peter Panning passes it.
Markup miss(const ReceiverSection& section, const Scale& scale) {
  const SectionTap& key = section.taps[section.key_tap];
  if ((key.cause != Cause::acne && key.cause != Cause::peter_panning) || !scale.shows(key.exact_m) ||
      !scale.shows(key.compared_m))
    return "";
  const double x = scale.x(0) + 15, y1 = scale.y(key.compared_m), y2 = scale.y(key.exact_m);
  const std::string color = color_text(cause_name(key.cause));
  const Markup bracket =
      element("path", Attribute("d", fmt::format("M{0} {1}h6V{2}h-6", n(x), n(y1), n(y2))), Attribute("fill", "none"),
              Attribute("stroke", color), Attribute("stroke-width", "1.6"));
  const double y = std::clamp((y1 + y2) / 2 + 4, top + 12, bottom - 4);
  return bracket + text_at(x + 11, y,
                           fmt::format("{} {}", length_text(std::abs(key.compared_m - key.exact_m)),
                                       key.cause == Cause::acne ? "more needed" : "too much bias"),
                           "f-ink small halo");
}

Markup receiver(const ReceiverSection& section, const Scale& scale) {
  const SectionTap& key = section.taps[section.key_tap];
  const double x = scale.x(0), y = scale.y(section.reference_m), compared = scale.y(key.compared_m);
  Markup out = arrow(x, top, std::min(top + 26, y - 9), "light");
  out += text_at(x + 6, top + 11, "light", "f-light small halo");
  const double blocked = !key.moved_lit && section.blocker_m ? std::max(scale.held(*section.blocker_m), top + 26) : y;
  if (y - 9 > top + 26) {
    out += line_between(x, top + 26, x, std::min(blocked, y), "s-light", 1.2);
    if (blocked < y) out += line_between(x, blocked, x, y, "s-light", 1.2, "2 3");
  }
  out += element("circle", Attribute("cx", n(scale.x(section.receiver_s))),
                 Attribute("cy", n(scale.y(section.receiver_m))), Attribute("r", "5.5"), css("f-ink"));
  if (section.moved)
    out += line_between(scale.x(section.receiver_s), scale.y(section.receiver_m), x, y, "s-ink", 1.2, "3 2");
  const double length = std::abs(compared - y);
  if (section.bias_m != 0) {
    const bool above = compared < y;
    if (length > 3) out += arrow(x, y, compared + (above ? 4 : -4), "ink");
    out += text_at(x - 12, std::clamp((y + compared) / 2 + 4, top + 12, bottom - 4),
                   "bias " + length_text(section.bias_m), "f-ink small halo", "end");
  }
  return out;
}

Markup planes(const ReceiverSection& section, const Scale& scale) {
  Markup out;
  const auto add = [&](double depth, const char* label) {
    if (!scale.shows(depth)) return;
    out += line_between(left, scale.y(depth), right, scale.y(depth), "s-soft", 1, "6 3") +
           text_at(right - 4, scale.y(depth) - 4, label, "f-soft small halo", "end");
  };
  if (section.axial) add(section.near_m, "near plane of the map");
  add(section.far_m, section.axial ? "far plane of the map" : "far of the map");
  return out;
}

// The taps' texels in the map's image, v upwards, with the line of the section.
Markup plan(const ReceiverSection& section) {
  glm::ivec2 low = glm::ivec2(glm::floor(section.place)) - 1, high = low + 2;
  for (const SectionTap& tap : section.taps) {
    if (!tap.same_tile) continue;
    low = glm::min(low, tap.texel);
    high = glm::max(high, tap.texel);
  }
  const glm::ivec2 count = high - low + 1;
  const double cell = plan_side / std::max(count.x, count.y);
  const auto x_of = [&](double u) { return plan_left + (u - low.x) * cell; };
  const auto y_of = [&](double v) { return plan_top + (high.y + 1 - v) * cell; };
  Markup out = box(plan_left, plan_top, count.x * cell, count.y * cell, "f-paper s-rule");
  // Several taps can read one texel: its grey is their dark share, its frame the cause of a wrong one.
  std::map<std::pair<int, int>, std::vector<const SectionTap*>> by_texel;
  for (const SectionTap& tap : section.taps)
    if (tap.same_tile) by_texel[{tap.texel.x, tap.texel.y}].push_back(&tap);
  Markup frames;
  for (const auto& [texel, all] : by_texel) {
    double dark = 0, weight = 0;
    std::string wrong;
    Markup marks;
    for (const SectionTap* tap : all) {
      weight += tap->weight;
      if (!tap->lit) dark += tap->weight;
      if (wrong.empty()) wrong = tap_mark(section, *tap);
      marks += element("g", css("tap"), Attribute("data-tap", tap->tap),
                       Attribute("data-texel", fmt::format("{},{}", tap->texel.x, tap->texel.y)),
                       Attribute("data-lit", tap->lit ? "1" : "0"), Attribute("data-shown", tap->shown_lit ? "1" : "0"),
                       Attribute("data-cause", cause_name(tap->cause)));
    }
    const double x = x_of(texel.first), y = y_of(texel.second + 1), share = weight > 0 ? dark / weight : 0;
    out += element("rect", Attribute("x", n(x)), Attribute("y", n(y)), Attribute("width", n(cell)),
                   Attribute("height", n(cell)), css("f-dark s-soft"), Attribute("fill-opacity", n(0.9 * share)),
                   Attribute("stroke-width", "0.8")) +
           marks;
    const double line = std::min(3.0, cell / 4);
    if (!wrong.empty())
      frames += element("rect", Attribute("x", n(x + line / 2)), Attribute("y", n(y + line / 2)),
                        Attribute("width", n(cell - line)), Attribute("height", n(cell - line)),
                        Attribute("fill", "none"), Attribute("stroke", wrong), Attribute("stroke-width", n(line)));
  }
  const double far = count.x + count.y;
  const glm::dvec2 a = section.place - far * section.direction, b = section.place + far * section.direction;
  out += frames;
  out += element("g", Attribute("clip-path", "url(#plan)"),
                 line_between(x_of(a.x), y_of(a.y), x_of(b.x), y_of(b.y), "s-step", 1.4, "4 2"));
  out += element("circle", Attribute("cx", n(x_of(section.place.x))), Attribute("cy", n(y_of(section.place.y))),
                 Attribute("r", n(std::clamp(cell / 6, 2.0, 4.0))), css("f-ink halo"));
  // Taps on another face of a cube have no place in the plan.
  for (const SectionTap& tap : section.taps)
    if (!tap.same_tile)
      out += element("g", css("tap"), Attribute("data-tap", tap.tap),
                     Attribute("data-texel", fmt::format("{},{}", tap.texel.x, tap.texel.y)),
                     Attribute("data-lit", tap.lit ? "1" : "0"), Attribute("data-shown", tap.shown_lit ? "1" : "0"),
                     Attribute("data-cause", cause_name(tap.cause)));
  return out;
}

// The causes whose rings taps() and plan() draw, in the order of the taps.
std::vector<Cause> ringed_causes(const ReceiverSection& section) {
  std::vector<Cause> causes;
  for (const SectionTap& tap : section.taps) {
    if (tap_mark(section, tap).empty()) continue;
    const Cause cause = tap.cause != Cause::none ? tap.cause : Cause::precision;
    if (std::find(causes.begin(), causes.end(), cause) == causes.end()) causes.push_back(cause);
  }
  return causes;
}

// bottom: where it ends.
Markup legend(const ReceiverSection& section, double& bottom_y) {
  Markup out;
  double y = plan_top + 8;
  const double x = margin, text_x = margin + 34;
  const auto entry = [&](const Markup& mark, const std::string& label) {
    out += mark + text_at(text_x, y + 4, label, "f-ink small");
    y += 19;
  };
  const auto circle = [&](double cx, double r, std::string_view classes) {
    return element("circle", Attribute("cx", n(cx)), Attribute("cy", n(y)), Attribute("r", n(r)), css(classes),
                   Attribute("stroke-width", "1.3"));
  };
  entry(line_between(x, y, x + 26, y, "s-ink", 2), "surfaces, cut by the plane");
  entry(box(x, y, 26, 7, "f-shade") + line_between(x, y, x + 26, y, "s-step", 1.8) + circle(x + 13, 2.6, "f-step"),
        "depth stored by a texel, and its centre");
  entry(circle(x + 13, 5.5, "f-ink"), "the receiver");
  entry(circle(x + 7, 4, "f-paper s-ink") + circle(x + 20, 4, "f-ink s-paper"), "compared depth: lit, dark");
  // A pixel can have wrong taps of other causes than its own, which is the largest.
  for (const Cause cause : ringed_causes(section)) {
    const CauseColor* const color = find_color(cause_name(cause));
    entry(element("circle", Attribute("cx", n(x + 13)), Attribute("cy", n(y)), Attribute("r", "7"),
                  Attribute("fill", "none"), Attribute("stroke", color_text(cause_name(cause))),
                  Attribute("stroke-width", "2.6")),
          fmt::format("a wrong tap: {}", color ? color->label : cause_name(cause)));
  }
  entry(line_between(x, y, x + 26, y, "s-step", 1.4, "4 2"), "the plane, in the plan of the taps");
  bottom_y = y;
  return out;
}

// Lines of at most `letters` letters.
std::vector<std::string> wrapped_text(const std::string& text, size_t letters) {
  std::vector<std::string> lines{""};
  size_t length = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    const auto word_letters = static_cast<size_t>(
        std::count_if(word.begin(), word.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
    if (length > 0 && length + 1 + word_letters > letters) {
      lines.emplace_back();
      length = 0;
    }
    if (length > 0) ++length, lines.back() += ' ';
    lines.back() += word;
    length += word_letters;
    at = end + 1;
  }
  return lines;
}

}  // namespace
}  // namespace section_drawing

std::string section_path(int64_t point, glm::ivec2 pixel) {
  return fmt::format("images/p{:04}-section-{}-{}.svg", point, pixel.x, pixel.y);
}

std::optional<glm::ivec2> section_pixel(std::string_view path) {
  constexpr std::string_view mark = "-section-", ending = ".svg";
  const size_t at = path.rfind(mark);
  if (at == std::string_view::npos || !path.ends_with(ending)) return std::nullopt;
  path = path.substr(at + mark.size(), path.size() - ending.size() - at - mark.size());
  glm::ivec2 pixel{0};
  const char* const end = path.data() + path.size();
  const auto x = std::from_chars(path.data(), end, pixel.x);
  if (x.ec != std::errc() || x.ptr == end || *x.ptr != '-') return std::nullopt;
  const auto y = std::from_chars(x.ptr + 1, end, pixel.y);
  return y.ec == std::errc() && y.ptr == end ? std::optional(pixel) : std::nullopt;
}

std::string section_svg(const ReceiverSection& section, SectionTheme theme) {
  using namespace section_drawing;
  const Scale scale(section);
  std::vector<std::string> words = section_words(section);
  const Surfaces cut = surfaces(section, scale);
  if (cut.left_out > 0)
    words.push_back(
        fmt::format("{} cuts of the surface that are farther from the receiver are not drawn.", cut.left_out));
  const std::string title = section_title(section);
  std::string spoken = title + ".";
  Markup text;
  double legend_bottom = 0;
  const Markup marks = legend(section, legend_bottom);
  double y = std::max(words_top, legend_bottom + 8);
  for (const std::string& paragraph : words) {
    spoken += " " + paragraph;
    for (const std::string& line : wrapped_text(paragraph, line_letters)) {
      text += text_at(margin, y, line, "f-ink");
      y += line_height;
    }
    y += 6;
  }
  const double height = y - line_height + margin;

  Markup out =
      element("title", fmt::format("A section through pixel {}, {}: {}", section.pixel.x, section.pixel.y, title)) +
      element("desc", spoken) + element("style", Markup::unescaped(style_text(theme)));
  out += element("defs",
                 element("clipPath", Attribute("id", "drawing"), box(left, top, right - left, bottom - top, "")) +
                     element("clipPath", Attribute("id", "plan"), box(plan_left, plan_top, plan_side, plan_side, "")));
  out += box(0, 0, width, height, "f-paper");
  const std::string cause =
      section.cause == Cause::none ? (section.truth > 0 ? "lit" : "shadowed") : std::string(cause_name(section.cause));
  out += element("rect", Attribute("x", n(margin)), Attribute("y", "8"), Attribute("width", "12"),
                 Attribute("height", "12"), Attribute("fill", color_text(cause)), css("s-soft"));
  out += text_at(margin + 18, 19, title, "f-ink title");
  std::string cascade = section.cascade == 0 ? "" : fmt::format(", cascade {}", section.cascade);
  if (section.share != 1) cascade += fmt::format(" ({:.2g}%)", 100 * section.share);
  out += text_at(right, 19, fmt::format("pixel {}, {}{}", section.pixel.x, section.pixel.y, cascade), "f-soft small",
                 "end");
  out += element("g", Attribute("clip-path", "url(#drawing)"), drawn_columns(section, scale), planes(section, scale),
                 cut.drawn);
  out += element("rect", Attribute("x", n(left)), Attribute("y", n(top)), Attribute("width", n(right - left)),
                 Attribute("height", n(bottom - top)), Attribute("fill", "none"), css("s-soft"));
  out += axis(section, scale);
  out += element("g", receiver(section, scale), miss(section, scale), taps(section, scale));
  const double stretch = scale.metres_per_pixel_across() / scale.metres_per_pixel();
  out += text_at(left, bottom + 15,
                 fmt::format("columns: texels of {}; depth drawn {} times {}", length_text(section.texel_m),
                             number_text(std::max(stretch, 1 / stretch), 3), stretch >= 1 ? "larger" : "smaller"),
                 "f-soft small");
  out += text_at(plan_left, plan_top - 6, section.taps.size() == 1 ? "the tap, in the map" : "the taps, in the map",
                 "f-soft small");
  out += marks + plan(section) + text;
  return element("svg", Attribute("xmlns", "http://www.w3.org/2000/svg"),
                 Attribute("viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)), Attribute("width", n(width)),
                 Attribute("height", n(height)), Attribute("role", "img"), out)
             .html() +
         "\n";
}

}  // namespace noonmark::report
