// A frame of "another renderer" for tests: it is Noonmark's own map, so its error is known from the ladder.
#pragma once
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/pictures/image_file.h"
#include "measure/workbench.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {

inline constexpr int frame_width = 320, frame_height = 180;

class OwnFrame : public Program {
 protected:
  OwnFrame() {
    Workbench bench(gl::DebugMode::fatal);
    Settings settings;
    settings.view.width_px = frame_width;
    settings.view.height_px = frame_height;
    settings.bias["constant"] = 0.01;
    const Measurement m = bench.measure(settings, {});
    visibility_ = m.ladder.shown();
    error_ = m.record.metrics.at("error");
    positions_ = m.receivers.position;
    primitive_ = m.receivers.primitive;
    for (size_t i = 0; i < visibility_.size(); ++i)
      if (primitive_[i] == no_primitive) visibility_[i] = -1;
    camera_ = m.camera;
    light_ = m.scene.light;
  }

  // frame.json beside the pictures. positions: whether they are handed over.
  nlohmann::json frame(bool positions) {
    write_exr((folder_ / "V.exr").string(), {{"Y", visibility_}});
    nlohmann::json json{{"noonmark_frame", 1}, {"scene", "cube-room"}, {"visibility", {{"file", "V.exr"}}}};
    const glm::dmat4 m = make_camera_frame(camera_, frame_width, frame_height).clip_from_world();
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
    json["camera"] = {{"clip_from_world", numbers}, {"order", "column"}, {"depth_range", "-1..1"}, {"reversed", false}};
    const glm::dvec3 way = light_.target_m - light_.position_m;
    json["light"] = {{"kind", "directional"}, {"direction", {way.x, way.y, way.z}}};
    if (positions) {
      std::vector<Channel> channels;
      for (int axis = 0; axis < 3; ++axis) {
        Image<float> values(frame_width, frame_height, std::numeric_limits<float>::quiet_NaN());
        for (size_t i = 0; i < values.size(); ++i)
          if (primitive_[i] != no_primitive) values[i] = positions_[i][axis];
        channels.push_back({std::string(1, static_cast<char>('X' + axis)), values});
      }
      write_exr((folder_ / "P.exr").string(), channels);
      json["positions"] = {{"file", "P.exr"}};
    }
    return json;
  }
  nlohmann::json said() const { return nlohmann::json::parse(read_file((folder_ / "out/judge.json").string())); }

  Image<float> visibility_;
  Image<glm::vec3> positions_;
  Image<uint32_t> primitive_;
  double error_ = 0;
  Camera camera_;
  Light light_;
};

}  // namespace noonmark::acceptance
