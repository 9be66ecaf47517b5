#include "app/verbs/one_point.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "app/verbs/option_values.h"
#include "base/error.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

// "; point 0: map.resolution = 512; ..." of the first points.
std::string points_text(const Experiment& experiment, size_t count) {
  constexpr size_t most = 8;
  std::string text;
  for (size_t id = 0; id < std::min(count, most); ++id) {
    const std::string part = part_of_point(experiment, static_cast<int64_t>(id)).part;
    const std::string swept = swept_text(experiment, static_cast<int64_t>(id));
    text += fmt::format("; point {}: {}{}{}", id, part.empty() ? "" : fmt::format("part '{}'", part),
                        part.empty() || swept.empty() ? "" : ", ", swept);
  }
  return count > most ? text + "; ..." : text;
}

}  // namespace

Experiment experiment_or_scene(const std::string& path, ExperimentArguments arguments) {
  std::error_code none;
  if (path.empty() || std::filesystem::path(path).extension() == ".toml" ||
      (!names_file(path) && std::filesystem::exists(path, none)))
    return experiment_from(path, arguments);
  take_scene(arguments, path);
  return experiment_from("", arguments);
}

Settings the_point(const Experiment& experiment, long point, std::string_view verb) {
  const std::vector<Settings> all = points(experiment);
  if (point < 0 && all.size() > 1)
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has {} points, but {} measures one; give --point 0 ... {}, or --set the swept settings{}",
                    experiment.path, all.size(), verb, all.size() - 1, points_text(experiment, all.size())));
  if (point >= static_cast<long>(all.size()))
    throw Error(ErrorKind::usage, fmt::format("there is no point {}; the last one is {}", point, all.size() - 1));
  return all[static_cast<size_t>(std::max(point, 0L))];
}

void add_point(CLI::App& verb, long& point) {
  verb.add_option("--point", point, "Number of the point in the experiment's sweep, from 0")->check(whole_number(0));
}

}  // namespace noonmark
