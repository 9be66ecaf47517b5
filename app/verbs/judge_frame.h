// One frame as `noonmark judge` judges it: read, judged, its pictures written, and printed.
//
//   const JudgedFrame frame = judge_frame_file(options, bounds, "out/judge-frame", "frame", [] {});
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/verbs/capture_arguments.h"
#include "app/verbs/experiment_arguments.h"
#include "compare/judge/bounds.h"
#include "compare/judge/verdict.h"
#include "frames/judge.h"

namespace noonmark {

struct JudgeOptions {
  std::string subject;  // a frame.json, a capture, or a scene
  std::string picture;  // of a scene: the visibility
  bool srgb = false;
  std::vector<std::string> accepted;
  std::vector<std::string> most;  // "frame_acne=0.05%"
  std::optional<double> edge_m, contact_m;
  double edge_pixels = JudgeRules().edge_pixels;
  bool edge_pixels_given = false;
  bool without_map = false;
  // Where the frame's map and its declared lookup do not explain the frame, it is judged by place, not refused: of a capture,
  // whose lookup is found and not declared.
  bool map_may_fail = false;
  CaptureArguments capture;
  ExperimentArguments arguments;
};

struct JudgedFrame {
  Verdict verdict;
  nlohmann::ordered_json json;  // what judge.json says of it
  std::string summary;          // what follows the name of the light in one line
};

// options: of a frame.json, or of a scene with its picture. Writes <folder>/<stem>.exr and its pictures, and prints unless
// options.arguments.json. make_folder: is called before the first file is written. Throws Error.
JudgedFrame judge_frame_file(const JudgeOptions& options, const std::vector<Bound>& bounds, const std::string& folder,
                             const std::string& stem, const std::function<void()>& make_folder);

}  // namespace noonmark
