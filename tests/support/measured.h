// Helpers of the acceptance tests: settings in one line, the paths of models, and the tolerance of sums.
#pragma once
#include <filesystem>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "measure/workbench.h"
#include "scenes/library.h"
#include "tests/support/source_dir.h"

namespace noonmark::acceptance {

using Assignment = std::pair<std::string, std::string>;

inline Settings with(const std::vector<Assignment>& assignments, Settings settings = {}) {
  for (const auto& [name, value] : assignments) find_setting(name).set(settings, value);
  return settings;
}

// A parameter of tests: a scene with a technique.
struct SceneCase {
  const char* name;
  const char* scene;
  std::vector<Assignment> settings;
};
inline std::ostream& operator<<(std::ostream& out, const SceneCase& c) { return out << c.name; }

// The default picture is large. A test needs only enough receivers for every case.
inline Settings small(const std::string& scene, int width = 400, int height = 240) {
  return with(
      {{"scene.name", scene}, {"view.width_px", std::to_string(width)}, {"view.height_px", std::to_string(height)}});
}

// A variance map whose edge crosses the picture, so that lookups are inside, at the border, and outside.
inline Settings with_moments(const std::vector<Assignment>& more = {}) {
  return with(more, with({{"lookup.kind", "vsm"},
                          {"filter.kind", "box"},
                          {"filter.size", "5"},
                          {"map.resolution", "128"},
                          {"map.extent_m", "6"}},
                         small("cube-room", 200, 120)));
}

// Steps are sums of at most a dozen floats in [0,1], each rounded to 2^-24.
inline constexpr double rounding_of_steps = 1e-6;

inline std::string model(const std::string& name) {
  return (std::filesystem::path(noonmark::test::source_dir()).parent_path() / "shared/scenes" / name / (name + ".gltf"))
      .string();
}

// Mean |R4 - R1|.
inline double error_on_exact_map(const Ladder& ladder) {
  double error = 0, counted = 0;
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    error += std::abs(static_cast<double>(ladder[Rung::on_exact_map][i]) - ladder.truth()[i]);
    ++counted;
  }
  return error / counted;
}

inline double metric(const Measurement& m, const std::string& name) { return m.record.metrics.at(name); }

}  // namespace noonmark::acceptance
