#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <memory>

#include "app/sweep/output_folder.h"
#include "app/verbs/one_point.h"
#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "base/threads.h"
#include "compare/judge/undecided.h"
#include "compare/report/section_picture.h"
#include "compare/report/section_words.h"
#include "compare/results/causes.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "measure/workbench.h"
#include "scenes/library.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

struct SectionOptions : PointOptions {
  std::string pixel, worst;  // --pixel and --worst; both empty: pixel_of_largest_cause()
  std::string theme = report::section_themes.front();
};

constexpr const char* section_file = "section.svg";

glm::ivec2 pixel_from(const std::string& text) {
  glm::ivec2 pixel{0};
  const char* const end = text.data() + text.size();
  const auto x = std::from_chars(text.data(), end, pixel.x);
  if (x.ec == std::errc() && x.ptr != end && *x.ptr == ',')
    if (const auto y = std::from_chars(x.ptr + 1, end, pixel.y); y.ec == std::errc() && y.ptr == end) return pixel;
  throw Error(
      ErrorKind::usage,
      fmt::format("--pixel {} is no pixel; give its column and its row as --pixel 312,175, from 0,0 at the top left",
                  text));
}

struct ChosenPixel {
  glm::ivec2 at{0};
  std::string why;  // "the pixel with the largest acne, 100%"; empty: it was given
};

// Of a picture without this metric at any counted pixel.
[[noreturn]] void refuse_right_picture(const PointRecord& record, const std::string& metric, const char* advice) {
  const std::string doubt = ambiguous_note(record);
  throw Error(ErrorKind::usage,
              doubt.empty() ? fmt::format("no pixel of this picture has any {}; {}", metric, advice)
                            : fmt::format("no pixel that is counted has any {}, but {}; or {}", metric, doubt, advice));
}

// Without a wish: the pixel that stands for the largest cause.
ChosenPixel pixel_of_largest_cause(const Measurement& m, const ProbeOf& probe_of) {
  size_t largest = 0;
  const auto size = [&](size_t cause) { return cause == 0 ? 0 : metric_of(m.record, m.ladder.causes[cause].name); };
  for (const CauseRow& row : cause_rows)
    if (row.cause && m.ladder.books(row) && row.place != CausePlace::light)
      if (const auto cause = static_cast<size_t>(*row.cause); size(cause) > size(largest)) largest = cause;
  const auto pixel = largest == 0 ? std::nullopt : typical_pixel(m.ladder, largest, true, probe_of);
  if (!pixel) refuse_right_picture(m.record, "error", "give a --pixel");
  return {*pixel, fmt::format("in the middle of the largest patch of {}, the largest cause of error: {}",
                              m.ladder.causes[largest].name, share_text(size(largest)))};
}

ChosenPixel chosen_pixel(const SectionOptions& options, const Measurement& m) {
  if (!options.pixel.empty()) return {pixel_from(options.pixel), ""};
  const PointRecord& record = m.record;
  const std::string metric = stored_name(options.worst);
  const ProbeOf probe_of = [&](size_t i) -> const LookupProbe& { return m.map_of(i).probe; };
  if (metric.empty()) return pixel_of_largest_cause(m, probe_of);
  auto worst = worst_pixel_of(record, metric);
  if (!worst && metric_of(record, metric) == 0)
    refuse_right_picture(record, metric, "give another --worst, or a --pixel");
  if (!worst)
    throw Error(
        ErrorKind::usage,
        fmt::format("{} is a number of the whole picture, of no pixel; give the metric of a cause or error with "
                    "--worst, or a --pixel",
                    metric));
  // Of a cause many pixels have the most of it.
  for (size_t cause = 1; cause < m.ladder.causes.size(); ++cause)
    if (m.ladder.causes[cause].name == metric)
      if (const auto pixel = typical_pixel(m.ladder, cause, false, probe_of)) worst->x = pixel->x, worst->y = pixel->y;
  return {{worst->x, worst->y},
          fmt::format("the pixel with the largest {}, {}", metric,
                      quantity_text(worst->size, find_quantity(metric, {&record, 1}).unit))};
}

int draw_section(const SectionOptions& options) {
  if (!options.pixel.empty() && !options.worst.empty())
    throw Error(ErrorKind::usage, "--pixel and --worst both choose the pixel; give one of them");
  if (!options.pixel.empty()) (void)pixel_from(options.pixel);
  const std::string file = options.arguments.out.empty() ? section_file : options.arguments.out;
  require_new_file(file, ".svg", options.arguments.overwrite);
  const OnePoint point = chosen_point(options, "section");
  require_compared(point.settings, "a section");
  if (!options.worst.empty()) (void)find_quantity(stored_name(options.worst));
  require_room_to_start(false);
  Workbench bench(gl::DebugMode::log);
  require_room(bench, point, false, false);
  const Measurement m = bench.measure(point.settings, std::nullopt, MetricSet::searched);
  const ChosenPixel pixel = chosen_pixel(options, m);
  ReceiverSection section = bench.sections(m, std::array{pixel.at}).front();
  for (int cause = 1; cause < compared_cause_count; ++cause)
    if (cause_name(static_cast<Cause>(cause)) == options.worst) explain(section, static_cast<Cause>(cause));
  const auto theme = static_cast<report::SectionTheme>(
      std::find(report::section_themes.begin(), report::section_themes.end(), options.theme) -
      report::section_themes.begin());
  make_folder_above(file);
  write_file_atomically(file, report::section_svg(section, theme));
  fmt::print("{}, pixel {},{}{}: {}\n\n", printable(m.scene.name), pixel.at.x, pixel.at.y,
             pixel.why.empty() ? "" : " (" + pixel.why + ")", report::section_title(section));
  for (const std::string& paragraph : report::section_words(section)) fmt::print("  {}\n", paragraph);
  for (const std::string& note : {ambiguous_note(m.record), notes_line(m.scene)})
    if (!note.empty()) fmt::print("\n  note: {}\n", printable(note));
  fmt::print("\n{} is written\n", printable(file));
  return 0;
}

RunVerb add_section(CLI::App& verb) {
  const auto options = std::make_shared<SectionOptions>();
  verb.add_option("--pixel", options->pixel,
                  "The pixel: column and row from 0,0 at the top left. Without it and without --worst, one in the "
                  "middle of the largest patch of the largest cause")
      ->check(not_empty())
      ->type_name(value_kind::pixel);
  verb.add_option(
          "--worst", options->worst,
          "The pixel with the largest part of this metric, such as acne; of equal ones, that in the middle of their "
          "largest patch")
      ->check(not_empty())
      ->type_name("METRIC");
  verb.add_option("--theme", options->theme,
                  "Colours for a light or a dark page; auto leaves the choice to the reader's screen, and programs "
                  "that print need one of the others")
      ->check(one_of(report::section_themes))
      ->type_name(joined(report::section_themes))
      ->capture_default_str();
  add_point_options(verb, *options, true);
  add_out_file(verb, options->arguments, "The file that is written", "FILE.svg", section_file);
  return [options](const std::string& command) {
    options->arguments.command = command;
    const ThreadLimit limit(options->arguments.threads);
    return draw_section(*options);
  };
}

}  // namespace

Verb verb_section() {
  return {"section", "Draw why one pixel is wrong: the plane of its light ray, through surface and map",
          "noonmark section cube-room --worst acne", add_section};
}

}  // namespace noonmark
