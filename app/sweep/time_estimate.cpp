#include "app/sweep/time_estimate.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include "app/pictures/point_pictures.h"
#include "measure/pass_times.h"
#include "measure/point_work.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The calibration ends soon after the first of these. Of a sweep with many kinds of points not every kind is measured then.
constexpr double most_cpu_s = 4;
constexpr int most_measured = 120;

struct Clock {
  double cpu_s, wall_s;
};
Clock now() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const auto wall = std::chrono::steady_clock::now().time_since_epoch();
  return {seconds(used.ru_utime) + seconds(used.ru_stime), std::chrono::duration<double>(wall).count()};
}

Settings small_part(Settings settings, int divisor) {
  settings.view.width_px = std::max(1, settings.view.width_px / divisor);
  settings.view.height_px = std::max(1, settings.view.height_px / divisor);
  return settings;
}

class Calibration {
  static constexpr size_t look = PointWork::look, works = PointWork::works;

 public:
  Calibration(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& planned)
      : bench_(bench), experiment_(experiment), planned_(planned), timed_(times_measured(experiment)) {}

  // Measures points of all kinds until the time is spent.
  void run() {
    measure(0, 4);  // compiles the shaders; its time is not that of another point
    rows_.clear();
    times_.clear();
    std::map<std::string, std::vector<size_t>> kinds;
    for (size_t i = 0; i < planned_.size(); ++i) kinds[kind_of(i)].push_back(i);
    // A sweep of few points is measured soon, so its calibration is short too.
    const int rounds = planned_.size() < 8 ? 4 : 12;
    for (int round = 0; round < rounds; ++round)
      for (const auto& [kind, members] : kinds) {
        const bool enough = round > 1 && now().cpu_s - start_.cpu_s > most_cpu_s;
        const bool far_enough = now().cpu_s - start_.cpu_s > 2 * most_cpu_s;
        if (enough || far_enough || measured() >= most_measured) return;
        // Evenly over the members of the kind, whatever the number of rounds (the golden ratio's multiples).
        const double place = std::fmod(0.5 + round * 0.6180339887498949, 1.0);
        const size_t id = members[static_cast<size_t>(place * static_cast<double>(members.size()))];
        const int divisor = round % 2 == 0 ? 4 : 2;
        // What a point shares with the one before. In the first round each kind is measured after another kind, which is
        // as good an equation and half the time.
        if (id > 0 && round > 0) measure(id - 1, divisor);
        measure(id, divisor);
      }
  }

  // The processor time of every point.
  std::vector<double> predict() const {
    std::vector<std::vector<double>> relative = rows_;
    std::vector<double> ones(rows_.size(), 1.0);
    for (size_t r = 0; r < rows_.size(); ++r)
      for (double& value : relative[r]) value /= times_[r];
    // Columns of like size, so that the fit converges.
    std::vector<double> scale(columns_.size() + look, 0.0);
    for (std::vector<double>& row : relative) {
      row.resize(scale.size(), 0.0);
      for (size_t c = 0; c < row.size(); ++c) scale[c] = std::max(scale[c], row[c]);
    }
    for (std::vector<double>& row : relative)
      for (size_t c = 0; c < row.size(); ++c) row[c] = scale[c] > 0 ? row[c] / scale[c] : 0;
    std::vector<double> cost = least_squares(relative, ones);
    for (size_t c = 0; c < cost.size(); ++c) cost[c] = scale[c] > 0 ? cost[c] / scale[c] : 0;
    const auto known = [&](size_t column) { return column < cost.size() && scale[column] > 0; };
    // Of a filter that no small picture had: the mean of the others.
    std::vector<double> mean(works, 0.0), count(works, 0.0);
    for (size_t c = look; c < cost.size(); ++c)
      if (known(c)) mean[works_[c - look]] += cost[c], ++count[works_[c - look]];
    std::vector<double> seconds;
    for (size_t i = 0; i < planned_.size(); ++i) {
      const std::vector<double> row = row_of(i, 1, i > 0 ? &planned_[i - 1] : nullptr);
      double sum = 0;
      for (size_t c = 0; c < row.size(); ++c) {
        if (known(c)) sum += row[c] * cost[c];
        if (!known(c) && c >= look) sum += row[c] * mean[works_[c - look]] / std::max(1.0, count[works_[c - look]]);
      }
      seconds.push_back(sum);
    }
    return seconds;
  }

  int measured() const { return static_cast<int>(times_.size()); }

 private:
  std::optional<CurveOptions> options_of(size_t id) const {
    const Experiment& part = part_of_point(experiment_, static_cast<int64_t>(id));
    return part.curve_enabled ? std::optional(part.curve) : std::nullopt;
  }

  // Points whose time is the same sum with other amounts.
  std::string kind_of(size_t id) const {
    std::string kind = tapped(planned_[id]) + planned_[id].scene.name;
    for (uint64_t amount : work_of(planned_[id], id > 0 ? &planned_[id - 1] : nullptr, options_of(id), timed_))
      kind += amount > 0 ? '1' : '0';
    return kind;
  }
  static std::string tapped(const Settings& s) {
    return s.filter.kind + " " + s.bias.reference + " " + find_setting("light.kind").get(s) + " ";
  }

  // The row of the model: the columns that all points share, and those of its filter.
  std::vector<double> row_of(size_t id, int divisor, const Settings* before) const {
    const Settings settings = small_part(planned_[id], divisor);
    const std::vector<uint64_t> work = work_of(settings, before, options_of(id), timed_);
    std::vector<double> row(work.begin(), work.begin() + look);
    for (size_t w = look; w < works; ++w) {
      const auto [column, added] = columns_.emplace(tapped(settings) + std::to_string(w), columns_.size());
      if (added) works_.push_back(w);
      const size_t at = look + column->second;
      row.resize(std::max(row.size(), at + 1), 0.0);
      row[at] = static_cast<double>(work[w]);
    }
    return row;
  }

  void measure(size_t id, int divisor) {
    const Settings settings = small_part(planned_[id], divisor);
    std::vector<double> row = row_of(id, divisor, last_ ? &*last_ : nullptr);
    const Clock before = now();
    bench_.measure(settings, options_of(id));
    if (timed_) time_passes(bench_, settings);
    last_ = settings;
    rows_.push_back(std::move(row));
    times_.push_back(std::max(1e-6, now().cpu_s - before.cpu_s));
  }

  Workbench& bench_;
  const Experiment& experiment_;
  const std::vector<Settings>& planned_;
  bool timed_;
  Clock start_ = now();
  std::optional<Settings> last_;  // what the bench remembers
  // The columns from `look` on, and the work of each.
  mutable std::map<std::string, size_t> columns_;
  mutable std::vector<size_t> works_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> times_;
};

// A time that grows with the number of pixels, from two sizes: `at(divisor)` is the time at 1 / divisor of the width.
template <class At>
double at_full_size(const At& at) {
  const double quarter = at(4), half = at(2);
  return half + std::max(0.0, (half - quarter) / (1.0 / 4 - 1.0 / 16)) * (1 - 1.0 / 4);
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "noonmark-plan-XXXXXX").string();
    if (mkdtemp(name.data())) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code none;
    if (!path_.empty()) std::filesystem::remove_all(path_, none);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// The files of each point's pictures, without its measurement. They grow with the pixels and with the map's texels.
std::vector<double> picture_times(Workbench& bench, const std::vector<Settings>& planned, PictureFormats formats) {
  const TemporaryFolder folder;
  if (folder.path().empty()) return std::vector<double>(planned.size(), 0.0);
  const auto write = [&](const Settings& settings) {
    const Measurement m = bench.measure(settings, std::nullopt);
    const Clock before = now();
    keep_pictures_and_sections(bench, m, 0, folder.path(), formats);
    return now().cpu_s - before.cpu_s;
  };
  const auto texels = [](const Settings& s) { return static_cast<double>(s.map.resolution) * s.map.rows(); };
  const Settings& first = planned.front();
  write(small_part(first, 4));  // opens the picture library
  const double quarter = write(small_part(first, 4));
  Settings other = small_part(first, 4);
  other.map.resolution = first.map.resolution > 1024 ? first.map.resolution / 2 : first.map.resolution * 2;
  const double per_texel = std::max(0.0, (write(other) - quarter) / (texels(other) - texels(first)));
  double files = at_full_size([&](int divisor) { return divisor == 4 ? quarter : write(small_part(first, divisor)); });
  const Clock before = now();
  keep_live_picture(bench, first, {}, 0, folder.path());
  files += now().cpu_s - before.cpu_s;
  std::vector<double> seconds;
  for (const Settings& point : planned)
    seconds.push_back(std::max(0.0, files + per_texel * (texels(point) - texels(first))));
  return seconds;
}

double diagram_time(Workbench& bench, const PhasePlan& plan) {
  constexpr int few = 3;
  PhasePlan part = plan;
  const int width = std::min(plan.request.width_px, plan.points.front().view.width_px);
  part.request.texel_sizes = std::min(few, plan.request.texel_sizes);
  const double rows = static_cast<double>(plan.request.texel_sizes) / part.request.texel_sizes;
  return rows * at_full_size([&](int divisor) {
           part.request.width_px = std::max(1, width / divisor);
           const Clock before = now();
           make_phase(bench, part);
           return now().cpu_s - before.cpu_s;
         });
}

}  // namespace

std::vector<double> least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& b) {
  const size_t columns = rows.empty() ? 0 : rows.front().size();
  std::vector<double> x(columns, 0.0), rest = b, square(columns, 0.0);  // rest: b - A x
  for (const std::vector<double>& row : rows)
    for (size_t c = 0; c < columns; ++c) square[c] += row[c] * row[c];
  // One element after the other is set to its best value while the others stay.
  for (int pass = 0; pass < 3000; ++pass)
    for (size_t c = 0; c < columns; ++c) {
      if (square[c] == 0) continue;
      double slope = 0;
      for (size_t r = 0; r < rows.size(); ++r) slope += rows[r][c] * rest[r];
      const double next = std::max(0.0, x[c] + slope / square[c]), change = next - x[c];
      if (change == 0) continue;
      x[c] = next;
      for (size_t r = 0; r < rows.size(); ++r) rest[r] -= change * rows[r][c];
    }
  return x;
}

TimeEstimate estimate_time(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& planned,
                           const std::vector<PhasePlan>& diagrams) {
  const Clock start = now();
  TimeEstimate estimate;
  estimate.cpu_s = start.cpu_s;  // starting, which a run does too
  Calibration calibration(bench, experiment, planned);
  calibration.run();
  const std::vector<double> seconds = calibration.predict();
  for (double s : seconds) estimate.cpu_s += s;
  estimate.measured = calibration.measured();
  if (experiment.pictures != "none") {
    const std::vector<double> files =
        picture_times(bench, planned, experiment.exr ? PictureFormats::png_and_exr : PictureFormats::png);
    const auto mean_of = [](const std::vector<double>& all) {
      return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    };
    const auto all = static_cast<double>(planned.size());
    if (experiment.pictures == "first") estimate.cpu_s += files.front();
    if (experiment.pictures == "all") estimate.cpu_s += mean_of(files) * all;
    // Chosen by their errors after the sweep, so they are measured again.
    if (experiment.pictures == "worst") estimate.cpu_s += mean_of(files) + mean_of(seconds);
    const bool moves =
        std::any_of(planned.begin(), planned.end(), [](const Settings& s) { return s.view.motion.any(); });
    if (moves && experiment.pictures != "first")  // the frames of the animation are measured again
      estimate.cpu_s += std::min(all, static_cast<double>(most_motion_frames)) * mean_of(seconds);
    if (experiment.pictures == "answers") estimate.cpu_s += std::min(3.0, all) * (mean_of(files) + mean_of(seconds));
    if (experiment.pictures == "extremes") estimate.cpu_s += std::min(2.0, all) * (mean_of(files) + mean_of(seconds));
  }
  // One diagram is measured; others have its time, by their pixels and rows.
  const auto size_of = [](const PhasePlan& plan) {
    const double width = std::min(plan.request.width_px, plan.points.front().view.width_px);
    return width * width * plan.request.texel_sizes * std::pow(plan.request.placements, 2);
  };
  if (!diagrams.empty()) {
    const double first = diagram_time(bench, diagrams.front());
    for (const PhasePlan& plan : diagrams) estimate.cpu_s += first * size_of(plan) / size_of(diagrams.front());
  }
  const Clock end = now();
  estimate.calibration_s = end.cpu_s - start.cpu_s;
  estimate.wall_s = estimate.cpu_s * (end.wall_s - start.wall_s) / std::max(1e-6, estimate.calibration_s);
  return estimate;
}

}  // namespace noonmark
