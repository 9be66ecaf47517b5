// The input is the text of an experiment file. It must be refused with an Error(usage) that names the place, or give an
// experiment. Then its points, commands and fingerprint must be as app/definition/experiment.h says, and each bound and each law
// must give one verdict.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "base/file.h"
#include "compare/judge/bounds.h"
#include "compare/judge/laws.h"
#include "technique/setting_rules.h"
#include "tests/fuzz/names.h"
#include "tests/fuzz/targets.h"
#include "tests/support/sample_results.h"
#include "tests/support/source_dir.h"
#include "tests/support/words.h"

namespace noonmark::fuzz {
namespace {

// At most this many points are checked one by one. A sweep may have 100,000; the rest are only counted.
constexpr size_t most_points = 64;

void check_part(const Experiment& experiment, const std::vector<PointRecord>& points) {
  const auto reproduce = [&](const PointRecord& point) { return reproduce_command(experiment, point); };
  require(evaluate_bounds(points, experiment.bounds, reproduce).size() == experiment.bounds.size(),
          "not one result for each bound");
  require(evaluate_laws(points, experiment.laws, reproduce).size() == experiment.laws.size(),
          "not one result for each law");
}

void run(const std::string& text) {
  // About the length of the seeds: a longer text finds nothing new.
  if (text.size() > 16384) return;
  const std::string path = "fuzz.toml";
  try {
    const Experiment experiment = parse_experiment(text, path);
    const std::vector<Settings> all = points(experiment);
    require(static_cast<int64_t>(all.size()) == point_count(experiment), "another number of points than it counts");
    std::vector<PointRecord> records;
    std::set<std::string> seen;
    for (size_t id = 0; id < std::min(all.size(), most_points); ++id) {
      validate(all[id]);
      PointRecord record = sample_point(static_cast<int64_t>(id));
      record.settings = settings_map(all[id]);
      const Experiment& part = part_of_point(experiment, static_cast<int64_t>(id));
      record.part = part.part;
      // A setting's text must be read back as the same setting. Otherwise the store and the command line would name
      // another point.
      Settings again;
      std::string key = record.part;
      for (const auto& [name, value] : record.settings) {
        find_setting(name).set(again, value);
        key += "\n" + value;
      }
      require(settings_map(again) == record.settings, "a point's settings read back as others");
      require(seen.insert(key).second, "the same point twice");
      require(!reproduce_command(experiment, record).empty(), "a point without a command");
      records.push_back(std::move(record));
    }
    require(fingerprint(experiment, {}) == fingerprint(parse_experiment(text, path), {}),
            "the same text gives another fingerprint");
    if (all.size() > most_points) return;
    if (experiment.parts.empty()) return check_part(experiment, records);
    for (const Experiment& part : experiment.parts) {
      std::vector<PointRecord> of_part;
      std::copy_if(records.begin(), records.end(), std::back_inserter(of_part),
                   [&](const PointRecord& point) { return point.part == part.part; });
      check_part(part, of_part);
    }
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::usage, std::string("an error of another kind: ") + error.what());
    require(*error.what() != '\0', "an error without a message");
  }
}

std::vector<std::string> seeds() {
  std::vector<std::string> all = {
      R"toml(title = "All keys"
scene = {name = "plane", theta_deg = 45.5, mesh = "split"}
pictures = "extremes"
[view]
width_px = 64
height_px = 0x20
eye_m = [1, 2.5, -3e0]
[map]
resolution = 1_024
extent_m = "auto"
wrap = 'repeat'
[sweep]
filter.kind = ["none", "box"]
"bias.constant" = {min = 1e-3, max = 1, steps = 3, scale = "log"}
map = {near_m = [0.5, "auto"]}
[plot]
metrics = ["error", "acne"]
[curve]
enabled = true
acne_bound = 0.25
bias_depth = [0, 0.001, 0.002]
[phase]
enabled = true
acne_bound = 0.5
placements = 2
texel_sizes = 3
width_px = 16
[let]
k = "(filter.size - 1) / 2 + 0.5"
[[bound]]
metric = "acne"
max = inf
[[bound]]
metric = "window_width_depth"
min = 0.01
join = "median"
placement = "first"
where = {"filter.kind" = ["none", "box"]}
[[law]]
name = "1"
says = "one sentence"
found = "{100 * acne} %, {against: 100 * acne} %"
measured = "acne_free_bias_m"
at_most = "k * texel_m * tan_deg(scene.theta_deg)"
within = 0.05
slack = 1e-6
against = {"filter.kind" = "none"}
)toml",
      R"toml(pictures = "none"
# several parts
[[part]]
name = "a"
scene = "cube-room"
[part.sweep]
map.resolution = [64, 128]
[[part.law]]
name = "slope"
measured = "error"
equals = 1
join = "slope"
over = "map.resolution"
[[part]]
name = "b\u00e9\t"
[part.settings]
)toml",
      "a.b = 1\n[a]\nc = 1979-05-27T07:32:00Z\nd = \"\"\"\nx\\\n  y\"\"\"\ne = '''z'''\nf = [nan, +inf, 0b1, 0o7,]\n"};
  // The program's own experiments. Only the laws are large.
  const std::filesystem::path own = std::filesystem::path(noonmark::test::source_dir()) / "experiments";
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(own))
    if (entry.path().extension() == ".toml" && entry.file_size() < 6000) files.insert(entry.path());
  for (const std::filesystem::path& file : files) all.push_back(read_file(file.string()));
  return all;
}

std::vector<std::string> words() {
  std::vector<std::string> all = test::words_of(R"(
[[part]] [[bound]] [[law]] [sweep] [let] [curve] [plot] [scene] [view] [light] [map] [bias] [filter] [truth]
[part.sweep] [[part.law]] [[part.bound]] [part.let] title pictures name says found measured equals at_most at_least
within slack join over where against metric max min steps scale true false inf nan 0x 0b1 1e400 9223372036854775807
1979-05-27 07:32:00 ''' enabled acne_bound bias_depth metrics)");
  for (const char* word :
       {"\"log\"",      "\"linear\"", "\"worst\"",        "\"mean\"",     "\"median\"",   "\"each\"", "\"slope\"",
        "\"first\"",    "\"all\"",    "\"auto\"",         "\"\"\"",       "\\u",          "\\U0010",  "\\x1b",
        "\xef\xb2\xbf", "\xc3\xa9",   "\xf0\x9f\x98\x80", "\xe2\x80\xa8", "\xef\xbb\xbf", "\r\n"})
    all.emplace_back(word);
  for (const Setting& row : settings_table())
    for (std::string_view choice : row.choices) all.push_back("\"" + std::string(choice) + "\"");
  for (const std::string& name : program_names()) all.push_back(name);
  return all;
}

}  // namespace

const Target experiment_target = {"experiment", run, seeds, words, mutate_text<words>};

}  // namespace noonmark::fuzz
