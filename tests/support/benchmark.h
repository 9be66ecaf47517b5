// What the benchmark programs share: the process's CPU time, medians of jobs that run in turns, and a larger mesh.
//
//   std::vector<double> ms = medians(run_in_turns(5, {floor, program}));
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/shapes.h"

namespace noonmark::test {

// The words of a benchmark's command line: `[rounds] [scene or file ...]`.
struct BenchmarkArguments {
  int rounds = 0;
  std::vector<std::string> what;  // scenes or files
};
// Empty if --help or -h was asked for; then the help is printed. rounds, what: if none are given.
inline std::optional<BenchmarkArguments> benchmark_arguments(std::vector<std::string> words, const char* help,
                                                             int rounds, std::vector<std::string> what) {
  if (std::erase(words, "--help") + std::erase(words, "-h") > 0) {
    std::fputs(help, stdout);
    return std::nullopt;
  }
  if (!words.empty()) {
    rounds = std::max(1, std::atoi(words[0].c_str()));
    words.erase(words.begin());
  }
  return BenchmarkArguments{rounds, words.empty() ? std::move(what) : std::move(words)};
}

// Milliseconds of processor time that all threads of this process have used so far.
inline double cpu_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

// What Linux calls the processor.
inline std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown processor";
}

// values: not empty.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// CPU milliseconds of each job in each round. The jobs take turns, so that a busy time of the machine meets all of them.
// One more round comes first and is not counted: it warms up.
inline std::vector<std::vector<double>> run_in_turns(int rounds, const std::vector<std::function<void()>>& jobs) {
  std::vector<std::vector<double>> times(jobs.size());
  for (int round = -1; round < rounds; ++round)
    for (size_t j = 0; j < jobs.size(); ++j) {
      const double before = cpu_ms();
      jobs[j]();
      if (round >= 0) times[j].push_back(cpu_ms() - before);
    }
  return times;
}

inline std::vector<double> medians(const std::vector<std::vector<double>>& times) {
  std::vector<double> result;
  for (const std::vector<double>& of_job : times) result.push_back(median(of_job));
  return result;
}

// A bumpy ground under 25 spheres: 130,736 triangles.
inline Scene hills() {
  constexpr double pi = std::numbers::pi;
  Scene scene;
  add_surface(scene, "ground", 180, 180, false, [](double s, double t) {
    const double x = 20 * s - 10, z = 10 - 20 * t;
    return glm::dvec3(x, 0.25 * std::sin(1.7 * x) * std::cos(2.1 * z) + 0.05 * std::sin(9 * x + 3 * z), z);
  });
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      add_surface(scene, "sphere", 52, 26, true, [=](double s, double t) {
        const double phi = 2 * pi * s, up = pi * (t - 0.5);
        return glm::dvec3(-7 + 3.5 * i, 1.0 + 0.3 * ((i * 7 + j * 3) % 4), -7 + 3.5 * j) +
               0.9 * glm::dvec3(std::cos(up) * std::cos(phi), std::sin(up), -std::cos(up) * std::sin(phi));
      });
  scene.camera = {.eye_m = {9, 9, 14}, .target_m = {0, 0, 0}, .fov_y_deg = 45, .near_m = 0.1, .far_m = 60};
  scene.light.position_m = {6, 12, 4};
  return scene;
}

}  // namespace noonmark::test
