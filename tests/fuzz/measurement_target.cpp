// The bytes of the input choose a small scene and legal settings, which are measured as in a sweep. For every input the
// following must hold: the limits of compare/judge/soundness.h are kept, sums add up, numbers that may not be NaN are
// not, the bias curve agrees with the measurement at the point's own bias, and earlier measurements do not change the
// result.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "compare/judge/soundness.h"
#include "compare/results/metrics.h"
#include "measure/workbench.h"
#include "scenes/builtin.h"
#include "scenes/library.h"
#include "tests/fuzz/choices.h"
#include "tests/fuzz/targets.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::fuzz {
namespace {

// Steps are sums of at most a dozen floats in [0,1], each rounded to 2^-24. Their means have no larger error.
constexpr double rounding = 1e-6;

// ---- the scene

struct Triangles {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  uint32_t vertex(const glm::dvec3& p) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const uint32_t first = vertex(a);
    vertex(b), vertex(c), vertex(d);
    for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
  }
};

// A parallelepiped. The choices can make it flat or slanted.
void add_block(Triangles& to, Choices& choices) {
  const glm::dvec3 o = any_point(choices, 4), x = any_point(choices, 2), y = any_point(choices, 2);
  const glm::dvec3 z = any_point(choices, 2);
  to.quad(o, o + y, o + x + y, o + x);
  to.quad(o + z, o + x + z, o + x + y + z, o + y + z);
  to.quad(o, o + x, o + x + z, o + z);
  to.quad(o + y, o + y + z, o + x + y + z, o + x + y);
  to.quad(o, o + z, o + y + z, o + y);
  to.quad(o + x, o + x + y, o + x + y + z, o + x + z);
}

void add_floor(Triangles& to, Choices& choices) {
  const double y = choices.between(-2, 2), half = choices.between(0.5, 10);
  // The strips share no vertices, so every seam is a T-junction or an unwelded edge.
  const int strips = 1 + choices.below(4);
  const double tilt = choices.between(-1, 1);
  for (int i = 0; i < strips; ++i) {
    const double a = -half + 2 * half * i / strips, b = -half + 2 * half * (i + 1) / strips;
    to.quad({a, y + tilt * a, half}, {b, y + tilt * b, half}, {b, y + tilt * b, -half}, {a, y + tilt * a, -half});
  }
}

std::string scene_file(Choices& choices) {
  Triangles scene;
  const int objects = 1 + choices.below(6);
  for (int i = 0; i < objects; ++i) {
    switch (choices.below(5)) {
      case 0:
      case 1:
        add_floor(scene, choices);
        break;
      case 2: {  // a single triangle; it has no area if corners coincide
        const uint32_t a = scene.vertex(any_point(choices, 4)), b = scene.vertex(any_point(choices, 4));
        const uint32_t c = choices.below(8) == 0 ? a : scene.vertex(any_point(choices, 4));
        scene.indices.insert(scene.indices.end(), {a, b, c});
        break;
      }
      case 3:  // a triangle over vertices that exist already
        for (int k = 0; k < 3 && !scene.positions.empty(); ++k)
          scene.indices.push_back(static_cast<uint32_t>(choices.below(static_cast<int>(scene.positions.size() / 3))));
        break;
      default:
        add_block(scene, choices);
        break;
    }
  }
  // Far from the origin floats are coarse.
  static constexpr double places_m[] = {0, 0, 0, 30, 1000, 1e5};
  static constexpr double sizes[] = {1, 1, 1, 1e-3, 1e3};
  const double place = places_m[choices.below(6)], size = sizes[choices.below(5)];
  for (float& x : scene.positions) x = static_cast<float>(size * x + place);

  nlohmann::json d = test::square();
  d["buffers"] = nlohmann::json::array();
  d["bufferViews"] = nlohmann::json::array();
  d["accessors"] = nlohmann::json::array();
  test::add_accessor(d, test::raw(scene.positions), 5126, "VEC3", scene.positions.size() / 3);
  test::add_accessor(d, test::raw(scene.indices), 5125, "SCALAR", scene.indices.size());
  return d.dump();
}

// ---- the settings

// Limits of the values, so that one execution takes milliseconds. They are the same in every scene.
double most_of(const Setting& row) {
  if (row.name == "view.width_px") return 24;
  if (row.name == "view.height_px") return 18;
  if (row.name == "map.resolution") return 96;
  if (row.name == "cascades.resolutions") return 200;
  if (row.name == "map.placements") return 3;
  if (row.name == "filter.size") return 7;
  return row.max;
}
double least_of(const Setting& row) { return row.name == "truth.standard_error" ? 0.1 : row.min; }

std::string any_value(const Setting& row, Choices& choices) {
  if (row.may_be_auto && choices.below(4) == 0) return "auto";
  const double least = least_of(row), most = most_of(row);
  switch (row.type) {
    case ValueType::integer:
      return fmt::format("{}", static_cast<int>(least) + choices.below(static_cast<int>(most - least) + 1));
    case ValueType::flag:
      return choices.below(2) == 0 ? "false" : "true";
    case ValueType::choice:
      return std::string(row.choices[static_cast<size_t>(choices.below(static_cast<int>(row.choices.size())))]);
    case ValueType::point: {
      const double reach = row.unit == "deg" ? 200 : 8;
      const glm::dvec3 p = any_point(choices, choices.below(8) == 0 ? 1000 : reach);
      return fmt::format("{},{},{}", p.x, p.y, p.z);
    }
    case ValueType::list: {
      std::string list;
      double number = 0;
      for (int n = choices.below(8); n >= 0; --n) {
        number += std::pow(10.0, choices.between(-2, 2));
        list += fmt::format("{}{}", list.empty() ? "" : ",", number);
      }
      return list;
    }
    case ValueType::real_list: {
      std::string list;
      for (int n = choices.below(most_cascades); n >= 0; --n)
        list += fmt::format("{}{}", list.empty() ? "" : ",", std::pow(10.0, choices.between(-3, 3)));
      return list;
    }
    case ValueType::whole_list: {
      std::string list;
      for (int n = choices.below(most_cascades); n >= 0; --n)
        list += fmt::format("{}{}", list.empty() ? "" : ",", 1 + choices.below(static_cast<int>(most)));
      return list;
    }
    case ValueType::real:
      switch (choices.below(8)) {
        case 0:
          return fmt::format("{}", choices.below(2) == 0 ? least : most);
        case 1:
          return fmt::format("{}", choices.between(least, most));
        case 2:
          return fmt::format("{}", std::clamp(std::round(choices.between(-3, 8)), least, most));
        default:  // any magnitude up to a hundred, the range of useful settings
          return fmt::format("{}", std::clamp(std::pow(10.0, choices.between(-6, 2)), least, most));
      }
    case ValueType::text:
      break;
  }
  throw std::logic_error("no value for " + std::string(row.name));
}

void choose(Settings& settings, int count, Choices& choices) {
  const std::span<const Setting> table = settings_table();
  for (int i = 0; i < count; ++i) {
    const Setting& row = table[static_cast<size_t>(choices.below(static_cast<int>(table.size())))];
    if (row.type == ValueType::text) continue;
    std::string value = any_value(row, choices);
    if (row.name == "filter.size") value = fmt::format("{}", std::stoi(value) | 1);  // an even one is refused at once
    row.set(settings, value);
  }
}

// ---- what must hold

double metric(const Measurement& m, const char* name) { return m.record.metrics.at(name); }

// Whether the metric may be left out: law 1, and so its bias, is of lookups that compare depths.
bool may_be_absent(const Metric& row, const Measurement& m) {
  return row.optional() || (m.technique.moments && row.name.starts_with("acne_free_bias"));
}

void require_sums(const Measurement& m) {
  for (const SoundLimit& limit : sound_limits)
    if (m.record.metrics.contains(limit.metric))
      require(metric(m, limit.metric) <= limit.most, fmt::format("{} = {}", limit.metric, metric(m, limit.metric)));
  require(metric(m, "counted") + metric(m, "ambiguous_receivers") == metric(m, "facing"),
          "counted is not facing less ambiguous");
  require(metric(m, "attached") + metric(m, "facing") == metric(m, "receivers"),
          "attached is not receivers less facing");
  for (const auto& [name, rung] : m.ladder.rungs)
    for (size_t i = 0; i < rung.size(); ++i)
      require(rung[i] >= 0 && rung[i] <= 1 + rounding, fmt::format("a rung is {}", rung[i]));
}

void require_metrics(const Measurement& m) {
  if (metric(m, "counted") == 0) return;
  for (const Metric& row : metrics_table()) {
    if (row.unit == "ms") continue;  // only where times are asked for
    if (may_be_absent(row, m) && !m.record.metrics.contains(std::string(row.name))) continue;
    const double value = m.record.metrics.at(std::string(row.name));
    require(!std::isnan(value), fmt::format("{} is not a number", row.name));
    if (row.unit == "fraction")
      require(value >= 0 && value <= 1 + rounding, fmt::format("{} = {} is no fraction", row.name, value));
    if (row.unit == "m2" || row.unit == "count")
      require(value >= 0 && std::isfinite(value), fmt::format("{} = {}", row.name, value));
  }
  double causes = 0;
  for (const char* name :
       {"filter", "displacement", "aliasing", "acne", "peter_panning", "coverage", "undecided", "precision"})
    causes += metric(m, name);
  if (m.technique.moments)
    for (const char* name : {"leak", "over_darkening", "reduction", "moment_precision"}) causes += metric(m, name);
  require(metric(m, "error") <= causes + rounding,
          fmt::format("error {} is more than its causes, {}", metric(m, "error"), causes));
  require(metric(m, "error") <= metric(m, "wrong") + rounding, "a mean error above the share of wrong receivers");
  require(metric(m, "peter_panning_lit") <= metric(m, "peter_panning") + rounding, "a part above its whole");
}

void require_curve(const Measurement& m) {
  if (!m.record.curve || metric(m, "counted") == 0) return;
  const BiasCurve& curve = *m.record.curve;
  require(std::is_sorted(curve.bias_depth.begin(), curve.bias_depth.end()), "the curve's biases do not ascend");
  for (auto series :
       {&BiasCurve::error, &BiasCurve::error_soft, &BiasCurve::wrong, &BiasCurve::acne, &BiasCurve::peter_panning,
        &BiasCurve::aliasing_dark, &BiasCurve::aliasing_light, &BiasCurve::coverage})
    for (const double value : curve.*series)
      require(value >= 0 && value <= 1 + rounding, fmt::format("a curve's value is {}", value));
  if (curve.window_min_depth)
    require(*curve.window_min_depth <= *curve.window_max_depth, "a window that ends before it begins");
  if (curve.parameter != "bias.constant" || m.technique.settings.bias.unit != BiasUnit::depth) return;
  // The point's own bias is the last one requested (below). There the curve must equal the measurement.
  const auto at_bias =
      std::find(curve.bias_depth.begin(), curve.bias_depth.end(), m.technique.settings.bias["constant"]);
  if (at_bias == curve.bias_depth.end()) return;
  const auto i = static_cast<size_t>(at_bias - curve.bias_depth.begin());
  const auto same = [&](const char* name, double found) {
    require(std::abs(metric(m, name) - found) <= rounding,
            fmt::format("the curve has {} = {} at the point's bias, the measurement {}", name, found, metric(m, name)));
  };
  same("acne", curve.acne[i]);
  same("peter_panning", curve.peter_panning[i]);
  same("coverage", curve.coverage[i]);
  same("aliasing_dark", curve.aliasing_dark[i]);
  same("aliasing_light", curve.aliasing_light[i]);
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void require_same(const Measurement& a, const Measurement& b) {
  for (const Metric& row : metrics_table()) {
    if (row.unit == "ms" || (may_be_absent(row, a) && !a.record.metrics.contains(std::string(row.name)))) continue;
    const std::string name(row.name);
    require(same_number(a.record.metrics.at(name), b.record.metrics.at(name)),
            fmt::format("{} = {}, and {} when nothing was remembered", name, a.record.metrics.at(name),
                        b.record.metrics.at(name)));
  }
  require(a.record.curve.has_value() == b.record.curve.has_value(), "a curve once, and once none");
  if (!a.record.curve) return;
  for (auto series : {&BiasCurve::bias_depth, &BiasCurve::error, &BiasCurve::acne, &BiasCurve::peter_panning}) {
    const std::vector<double>&x = *a.record.curve.*series, &y = *b.record.curve.*series;
    require(
        std::equal(x.begin(), x.end(), y.begin(), y.end(), same_number),
        fmt::format("a curve has [{}], and [{}] when nothing was remembered", fmt::join(x, " "), fmt::join(y, " ")));
  }
}

struct Benches {
  // Small pictures are faster without threads, and with one thread a failure can be repeated.
  tbb::global_control one_thread{tbb::global_control::max_allowed_parallelism, 1};
  int no_threads = ::setenv("LP_NUM_THREADS", "0", 1);
  Folder folder;
  Workbench bench{gl::DebugMode::fatal}, other{gl::DebugMode::fatal};
  int files = 0;
};

std::optional<CurveOptions> curve_for(const Settings& settings, bool wanted) {
  if (!wanted) return std::nullopt;
  CurveOptions options;
  if (const double constant = settings.bias["constant"]; constant > 0) options.bias_depth = {0, constant};
  return options;
}

// Every setting that is not the default, and the whole scene file, so that a failure can be repeated by hand.
std::string described(const Settings& settings) {
  const Settings defaults;
  std::string text;
  for (const Setting& row : settings_table())
    if (row.get(settings) != row.get(defaults)) text += fmt::format("\n  {} = {}", row.name, row.get(settings));
  if (names_file(settings.scene.name)) text += "\n  " + read_file(settings.scene.name);
  return text;
}

void measure(Benches& b, const Settings& settings, bool curve, bool compare) {
  const std::optional<CurveOptions> options = curve_for(settings, curve);
  const Measurement m = b.bench.measure(settings, options);
  if (metric(m, "facing") > 0) {
    require_sums(m);
    require_metrics(m);
    require_curve(m);
  }
  if (!compare) return;
  Settings unlike;  // another scene, so that no stored result can be reused
  unlike.scene.name = settings.scene.name == "plane" ? "wall" : "plane";
  unlike.view.width_px = unlike.view.height_px = 2;
  unlike.map.resolution = 2;
  b.other.measure(unlike, std::nullopt);
  require_same(m, b.other.measure(settings, options));
}

void run(const std::string& bytes) {
  static Benches benches;
  Choices choices(bytes);
  Settings settings;
  settings.view.width_px = 16;
  settings.view.height_px = 12;
  settings.map.resolution = 32;
  settings.truth.standard_error = 0.1;
  const int kind = choices.below(4);
  if (kind == 0) {
    const std::span<const BuiltinScene> scenes = builtin_scenes();
    settings.scene.name = scenes[static_cast<size_t>(choices.below(static_cast<int>(scenes.size())))].name;
  } else {
    // A new name each time, so that results of the last scene are not used for this one.
    const std::string old = benches.folder.file(fmt::format("{}.gltf", benches.files));
    std::filesystem::remove(old);
    const std::string name = fmt::format("{}.gltf", ++benches.files);
    benches.folder.write(name, scene_file(choices));
    settings.scene.name = benches.folder.file(name);
  }
  const bool curve = choices.below(2) == 0, compare = choices.below(4) == 3;
  const int points = 1 + choices.below(3);
  for (int i = 0; i < points; ++i) {
    choose(settings, i == 0 ? choices.below(16) : 1 + choices.below(3), choices);
    try {
      measure(benches, settings, curve, compare);
    } catch (const Broken& broken) {
      throw Broken(broken.what() + described(settings));
    } catch (const Error& error) {  // settings that cannot be combined, or a scene without a triangle
      require(error.kind() == ErrorKind::usage || error.kind() == ErrorKind::file,
              std::string("an error of another kind: ") + error.what());
      require(*error.what() != '\0', "an error without a message");
    }
  }
}

std::string any_choices(size_t size, Random& random) {
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

std::vector<std::string> seeds() {
  std::vector<std::string> all;
  Random random(7);
  for (size_t i = 0; i < 24; ++i) all.push_back(any_choices(40 + 12 * i, random));
  return all;
}

// Every input is valid, so a new input finds as much as an edited one.
std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  return below(random, 4) == 0 ? any_choices(20 + below(random, 300), random) : edit(bytes, random);
}

std::vector<std::string> words() { return {}; }

}  // namespace

const Target measurement_target = {"measurement", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
