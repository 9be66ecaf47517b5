#include "tests/compare/report/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "compare/judge/soundness.h"
#include "compare/report/cause_colors.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

constexpr double depth_m = 6.5, bound = 0.001;

BiasCurve sample_curve(int resolution, double extent_m, bool box) {
  const double texel_m = extent_m / resolution, reach = box ? 1.5 : 0.5;
  BiasCurve curve;
  curve.parameter = "bias.constant";
  curve.made = "one pass";
  curve.m_per_depth = depth_m;
  curve.texels_per_depth = depth_m / texel_m;
  curve.acne_bound = curve.peter_panning_bound = bound;
  curve.bias_depth.push_back(0);
  for (int i = 0; i <= 120; ++i) curve.bias_depth.push_back(1e-5 * std::pow(10.0, i * 3.5 / 120));
  for (double bias : curve.bias_depth) {
    const double texels = bias * curve.texels_per_depth;
    const double acne = 0.31 * std::pow(std::max(0.0, 1 - texels / (2.2 * reach)), 2.2);
    const double panning = 0.012 * std::pow(bias * depth_m, 1.25) * (1 + 0.3 * texel_m);
    const double aliasing = 0.16 * texel_m * (box ? 0.6 : 1);
    curve.acne.push_back(acne);
    curve.peter_panning.push_back(panning);
    curve.aliasing_dark.push_back(aliasing * 0.55);
    curve.aliasing_light.push_back(aliasing * 0.45);
    curve.coverage.push_back(extent_m < 10 ? 0.004 : 0);
    curve.error.push_back(acne + panning + aliasing + curve.coverage.back() + (box ? 0.0011 : 0));
    curve.error_soft.push_back(1.1 * curve.error.back());
    curve.wrong.push_back(std::min(1.0, curve.error.back() * (box ? 2.3 : 1)));
  }
  size_t best = 0;
  for (size_t i = 0; i < curve.bias_depth.size(); ++i) {
    if (curve.error[i] < curve.error[best]) best = i;
    if (curve.acne[i] > bound || curve.peter_panning[i] > bound) continue;
    if (!curve.window_min_depth) curve.window_min_depth = curve.bias_depth[i];
    curve.window_max_depth = curve.bias_depth[i];
  }
  curve.best_bias_depth = curve.bias_depth[best];
  curve.best_error = curve.error[best];
  curve.flat_min_depth = curve.best_bias_depth * 0.8;
  curve.flat_max_depth = curve.best_bias_depth * 1.4;
  curve.breakpoints = 87420;
  return curve;
}

PointRecord sample_point(int64_t id, int resolution, double extent_m, bool box) {
  PointRecord point;
  point.id = id;
  for (const Setting& row : settings_table()) point.settings[std::string(row.name)] = row.get(Settings{});
  point.settings["map.resolution"] = fmt::format("{}", resolution);
  point.settings["map.extent_m"] = fmt::format("{}", extent_m);
  point.settings["filter.kind"] = box ? "box" : "none";
  point.curve = sample_curve(resolution, extent_m, box);
  const BiasCurve& curve = *point.curve;
  const size_t at = static_cast<size_t>(std::lower_bound(curve.bias_depth.begin(), curve.bias_depth.end(), 0.005) -
                                        curve.bias_depth.begin());
  auto& m = point.metrics;
  m = {{"error", curve.error[at]},
       {"wrong", curve.wrong[at]},
       {"error_soft", curve.error[at] * 1.1},
       {"light_size", 0.003},
       {"filter", box ? 0.0011 : 0.0},
       {"aliasing", curve.aliasing_dark[at] + curve.aliasing_light[at]},
       {"aliasing_dark", curve.aliasing_dark[at]},
       {"aliasing_light", curve.aliasing_light[at]},
       {"acne", curve.acne[at]},
       {"peter_panning", curve.peter_panning[at]},
       {"coverage", curve.coverage[at]},
       {"coverage_dark", curve.coverage[at]},
       {"coverage_light", 0.0},
       {"precision", 4e-6 * extent_m},
       {"peter_panning_gap_m", 0.005 * depth_m * 0.9},
       {"edge_displacement_texels", box ? 1.9 : 0.7},
       {"edge_displacement_mean_texels", 0.21},
       {"edge_displacement_pixels", 900.0 * extent_m / resolution},
       {"receivers", 742657},
       {"facing", 612004},
       {"counted", 611950},
       {"attached", 130653},
       {"ambiguous", 8.8e-5},
       {"outside", extent_m < 10 ? 0.06 : 0},
       {"residual", 2.4e-7},
       {"tap_residual", 1.1e-7},
       {"contract", 0},
       {"rounding_excess", 0.4},
       {"map_excess", 0.001},
       {"map_ms", 1.1 + 2.4e-6 * resolution * resolution},
       {"lookup_ms", box ? 21.4 : 6.1}};
  m["shadow_ms"] = m["map_ms"] + m["lookup_ms"];
  m["texel_work"] = 1e6 * m["shadow_ms"];
  point.times = {{"map_ms", m["map_ms"]}, {"lookup_ms", m["lookup_ms"]}, {"truth_ms", 310.5}, {"rays", 4.1e6}};
  point.worst = {512, 300, 1, "acne"};
  return point;
}

uint32_t crc(const std::string& bytes) {
  uint32_t value = 0xffffffffu;
  for (unsigned char byte : bytes) {
    value ^= byte;
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value & 1 ? 0xedb88320u : 0u);
  }
  return ~value;
}

std::string big_endian(uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255);
  return out;
}

std::string chunk(const std::string& body) {
  return big_endian(static_cast<uint32_t>(body.size() - 4)) + body + big_endian(crc(body));
}

std::string png(uint32_t width, uint32_t height,
                const std::function<std::array<uint8_t, 3>(uint32_t, uint32_t)>& color) {
  std::string raw;
  for (uint32_t y = 0; y < height; ++y) {
    raw += '\0';
    for (uint32_t x = 0; x < width; ++x)
      for (uint8_t c : color(x, y)) raw += static_cast<char>(c);
  }
  uint32_t a = 1, b = 0;
  for (unsigned char byte : raw) a = (a + byte) % 65521, b = (b + a) % 65521;
  std::string packed = "\x78\x01";
  for (size_t i = 0; i < raw.size(); i += 65535) {
    const size_t size = std::min<size_t>(65535, raw.size() - i);
    packed += i + size == raw.size() ? '\1' : '\0';
    for (size_t word : {size, ~size & 0xffff})
      packed += static_cast<char>(word & 255), packed += static_cast<char>(word >> 8);
    packed += raw.substr(i, size);
  }
  packed += big_endian(b << 16 | a);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR" + big_endian(width) + big_endian(height) + std::string("\x08\x02\0\0\0", 5)) +
         chunk("IDAT" + packed) + chunk("IEND");
}

}  // namespace

Results sample_results() {
  Results results;
  RunInfo& info = results.info;
  info.title = "Cube room: how much bias, how many texels?";
  info.experiment = "experiments/cube-room.toml";
  info.command = "noonmark run experiments/cube-room.toml --out out/cube-room";
  info.commit = "896dc68";
  info.version = "0.1.0";
  info.started = "2026-01-02T03:04:05Z";
  info.host_cpu = "Example CPU, 2 cores";
  info.gl_vendor = "Mesa";
  info.gl_renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  info.gl_version = "4.5 (Core Profile) Mesa 22.3.6";
  info.gl_timer = "CPU time of the process";
  info.embree_version = "3.13.5";
  info.embree_isa = "AVX2";
  info.libraries = {{"GLM", "0.9.9.8"}, {"OpenImageIO", "2.4.7"}, {"SQLite", "3.40.1"}};
  info.accuracy = "error";  // the soft error of the sample has no curve
  info.swept = {"map.resolution", "map.extent_m", "filter.kind"};
  info.plot = {"error", "acne", "peter_panning"};
  info.scene_name = "cube-room";
  info.triangles = 38;
  for (int resolution : {256, 512, 1024, 2048})
    for (double extent_m : {8.0, 20.0, 40.0, 80.0})
      for (bool box : {false, true})
        results.points.push_back(sample_point(static_cast<int64_t>(results.points.size()), resolution, extent_m, box));
  results.planned_points = static_cast<int64_t>(results.points.size());
  for (const char* name : {"truth", "map", "classes"})
    results.points[18].pictures.push_back(
        {name, fmt::format("images/p0018-{}.png", name), fmt::format("The {} of this point.", name)});
  results.points[26].pictures.push_back({"truth", "images/p0026-truth.png", "The truth of this point."});
  results.bounds.push_back({"residual", 1e-6, {}, {}, "worst", true, 2.4e-7, 0, 32, ""});
  results.bounds.push_back(
      {"peter_panning", 0.002, {}, {{"filter.kind", {"none"}}}, "worst", true, 0.00079, 4, 16, ""});
  return results;
}

Results filtered_sample_results() {
  Results results = sample_results();
  results.bounds.clear(), results.laws.clear();
  results.info.swept = {"map.resolution"};
  results.points.resize(3);
  results.planned_points = 3;
  for (size_t k = 0; k < 3; ++k) {
    PointRecord& point = results.points[k];
    point.curve.reset(), point.worst_of.clear(), point.causes.clear();
    point.settings["lookup.kind"] = "vsm", point.settings["filter.kind"] = "box",
    point.settings["lookup.reduction"] = "0";
    point.settings["map.resolution"] = std::to_string(256 << k), point.settings["map.extent_m"] = "10";
    point.metrics["texel_work"] = std::pow(4.0, static_cast<double>(k));
    point.metrics["acne"] = point.metrics["peter_panning"] = 0;
    point.metrics.insert({{"leak", 0.002}, {"over_darkening", 0.0001}, {"reduction", 0}});
    for (const SoundLimit& limit : sound_limits)
      if (must_have(point, limit)) point.metrics.try_emplace(limit.metric, 0);
    const double leaks = k == 0 ? 0.01 : 0.002;
    for (int i = 0; i < 100; ++i) {
      const double r = i / 100.0, leak = std::max(0.0, leaks * (1 - r / 0.3)),
                   error = 0.01 / (1 << k) + 0.02 * std::abs(r - 0.2);
      point.lookup_curve.push_back(
          {"lookup.reduction", r, error, leak, 0.0001, 0, 0.005 * r, 0.001, 0.001, 0, error, 1.1 * error});
    }
    point.metrics.insert({{"best_reduction", 0.2}, {"best_reduction_error", 0.01 / (1 << k)}});
    point.lookup_bounds = CauseBounds{};
    if (k > 0) point.metrics.insert({{"reduction_min", 0.15}, {"reduction_max", 0.2}});
  }
  results.points[2].settings["lookup.reduction"] = "0.5";
  return results;
}

std::string sample_picture(const std::string& path) {
  if (!path.starts_with("images/p0018-")) throw Error(ErrorKind::usage, "there is no " + path);
  const bool classes = path.find("classes") != std::string::npos, truth = path.find("truth") != std::string::npos;
  return png(320, 180, [&](uint32_t x, uint32_t y) -> std::array<uint8_t, 3> {
    const CauseColor* color = find_color("lit");
    const double step = truth ? 1 : 9, edge_x = std::floor(x / step) * step, edge_y = std::floor(y / step) * step;
    const bool shadow = edge_x + 0.4 * edge_y > 150 && edge_x + 0.4 * edge_y < 240 && edge_y > 50 && edge_y < 140;
    const bool right = x + 0.4 * y > 150 && x + 0.4 * y < 240 && y > 50 && y < 140;
    if (shadow) color = find_color("shadowed");
    if (classes && shadow != right) color = find_color(shadow ? "aliasing_dark" : "aliasing_light");
    if (classes && !shadow && y > 150 && x % 12 < 5) color = find_color("acne");
    if (y < 20) color = find_color("background");
    return {color->r, color->g, color->b};
  });
}

}  // namespace noonmark
