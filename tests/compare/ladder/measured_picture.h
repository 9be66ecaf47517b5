// A small picture for tests of the metrics: its rungs and steps are set by hand.
#pragma once
#include <array>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "compare/ladder/measure.h"
#include "scenes/receivers.h"
#include "tests/support/bias_of.h"

namespace noonmark {

inline constexpr float nan_float = std::numeric_limits<float>::quiet_NaN();

// A picture whose receivers all face the light, are lit and are right.
struct Picture {
  explicit Picture(int width, int height, int causes = compared_cause_count) {
    ladder = empty_ladder(width, height, causes);
    for (Ladder::RungImage& rung : ladder.rungs) rung.lit = Image<float>(width, height, 1);
    ladder.cause = Image<uint8_t>(width, height, 0);
    ladder.flags = Image<uint8_t>(width, height, flag_facing);
    ladder.doubt = Image<float>(width, height, 0);
    receivers = {Image<glm::vec3>(width, height, glm::vec3(0, 0, -2)),
                 Image<glm::vec3>(width, height, glm::vec3(0, 0, 1)), Image<uint32_t>(width, height, 0)};
    edge = occluder = Image<float>(width, height, nan_float);  // must not be read for pixels that are right
    probe.n_dot_l = probe.bias_unit = probe.tan_theta = Image<float>(width, height, 1);
    probe.pattern.offsets = {glm::vec3(0)};
    frame.extent_m = 5;
    frame.resolution = frame.rows = 10;
    frame.far_m = 10;
  }
  void rungs(int x, int y, std::array<float, 6> r) {
    for (size_t n = 0; n < 6; ++n) ladder.rungs[n].lit.at(x, y) = r[n];
  }
  void step(int x, int y, Cause cause, float size) {
    ladder[cause].at(x, y) = size;
    ladder.cause.at(x, y) = static_cast<uint8_t>(cause);
  }
  std::map<std::string, double> metrics() const {
    return measure_ladder({ladder, receivers, {{frame, probe, bias, edge}}, occluder});
  }
  double metric(const char* name) const { return metrics().at(name); }
  std::vector<PointRecord::WorstOf> worst() const {
    return worst_pixels({ladder, receivers, {{frame, probe, bias, edge}}, occluder});
  }

  Ladder ladder;
  ReceiverImage receivers;
  LookupProbe probe;
  Image<float> edge, occluder;
  LightFrame frame;                        // texels of 0.5 m
  Bias bias = bias_of({{"constant", 1}});  // 1 of the map's 10 m: nearly every occluder is within reach
};

inline void attach(Picture& p, int x, int y) {
  p.ladder.flags.at(x, y) = 0;
  for (Ladder::RungImage& rung : p.ladder.rungs) rung.lit.at(x, y) = 0;
}

}  // namespace noonmark
