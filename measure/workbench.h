// Measures points: runs gl, raytrace and compare, and computes only once what consecutive points share.
//
//   Workbench bench(gl::DebugMode::log);
//   Measurement m = bench.measure(settings, curve_options);
//   print(m.record.metrics.at("error"));
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/flicker.h"
#include "compare/ladder/live_picture.h"
#include "compare/ladder/picture_stack.h"
#include "compare/ladder/section.h"
#include "compare/results/records.h"
#include "measure/phase_diagram.h"
#include "measure/stages.h"
#include "technique/point_maps.h"

namespace noonmark {

// One map of a measured point.
struct MeasuredMap {
  Technique technique;       // with the frame of this map
  const LookupProbe& probe;  // of all receivers, also of those that are looked up in another map
  MapDepths stored;          // as the lookup's sampler returns it, at the texels that taps of facing receivers read
  const MapDepths& exact;
  // The whole stored map, by rows from the lowest v on: (first row, number of rows). It is read from the device, and a
  // large map is drawn again for it.
  std::function<Image<float>(int, int)> stored_rows;
};

// One measured point with the images behind its numbers. The references are valid until the bench's next measurement.
struct Measurement {
  PointRecord record;  // without id and pictures
  // Of several maps: with the frame of one map for the whole view, of which only the light is meant.
  Technique technique;
  Ladder ladder;
  Camera camera;
  const Scene& scene;
  const ReceiverImage& receivers;
  std::vector<MeasuredMap> maps;   // one or more
  MapChoice choice;                // in which of them each receiver is looked up
  std::optional<Flicker> flicker;  // from this frame to the next, if the settings have a motion

  const MeasuredMap& map() const { return maps.front(); }  // of a point with one map
  // That of the receiver, in a blend band the nearer of its two; the first where there is none.
  const MeasuredMap& map_of(size_t i) const { return maps[choice.map_of(i) < maps.size() ? choice.map_of(i) : 0]; }
  // Whether the size of a texel and the step of depth are the same at all receivers.
  bool uniform() const { return maps.size() == 1 && technique.frame.uniform(); }
};

// Milliseconds by gl::DeviceInfo::times. Empty: not asked for.
struct PassTimes {
  std::optional<double> map_ms, lookup_ms;
  std::optional<double> prefilter_ms;  // with lookup_ms, of a lookup that reads a filtered map
};

// Checks the address space that the driver, the rays and the image library need before the first point. Throws
// Error(device) if there is not enough. Without this check a library would fail later and could not say why.
// pictures: true if the run writes picture files.
void require_room_to_start(bool pictures);

// Which metrics a record has. searched: without those that cost a pass over the picture or the map and that a search seldom reads:
// shaded_rmse, flip, map_used, undersampled and perspective_aliasing. shaded: as searched, with shaded_rmse and flip.
enum class MetricSet { all, shaded, searched };
MetricSet metric_set_for(std::string_view metric);  // what is needed to know this one

struct Bench;  // measure/bench.h

class Workbench {
 public:
  // shaders: variants to measure in place of the program's own. stages: the program's; a test replaces some of them.
  explicit Workbench(gl::DebugMode debug, gl::ShaderReplacements shaders = {},
                     std::unique_ptr<Pipeline> stages = std::make_unique<Pipeline>());
  ~Workbench();

  // curve: no curve if it is empty, or if no part of the bias can have one (curve_part). checks: with none the record has no
  // metric of soundness; all else is the same. The record has no metric that is a
  // time: see measure/pass_times.h. Throws Error.
  Measurement measure(const Settings& settings, const std::optional<CurveOptions>& curve,
                      MetricSet metrics = MetricSet::all, Checks checks = Checks::all);

  // Sections through these pixels of a measured picture (compare/ladder/section.h). m: the bench's last measurement,
  // before anything else was asked of the bench. Throws Error as section_of().
  std::vector<ReceiverSection> sections(const Measurement& m, std::span<const glm::ivec2> pixels);

  // One sample of the time of each pass that is asked for. The images of the last measurement may be gone afterwards.
  // Throws Error.
  PassTimes time_passes(const Settings& settings, bool map, bool lookup);

  // The phase diagram of the scene under these settings (phase_settings()). measured: one with the same rows, if there is
  // one; then only what depends on the bounds is computed. Throws Error.
  PhaseDiagram phase(
      const Settings& settings, const PhaseOptions& options, const PhaseDiagram* measured = nullptr,
      const RowDone& row_done = [](int) {});

  // The places of points on a diagram that counts the receivers of `picture`: the points differ from it in texel size,
  // in bias and in settings that move no receiver. Throws Error.
  std::vector<PhasePlace> places(const Settings& picture, std::span<const Settings> points);

  // The picture of these settings at every bias, for a page (compare/ladder/live_picture.h). It is measured for itself,
  // with at most 320 x 180 pixels of the same view, and with fewer if its file would have more than 2 MB. Empty if the
  // settings have no such picture. The images of the last measurement are gone afterwards. Throws Error.
  std::optional<LivePicture> live_picture(const Settings& settings);

  // The pictures of these settings at a few values of stacked_part() (compare/ladder/picture_stack.h), with the same size and
  // the same limits. marks: as of stack_values(), in the part's own unit; its `otherwise` is here the bias of one texel, or 1 of a
  // part that does not act on the compared depth. Throws Error.
  PictureStack picture_stack(const Settings& settings, const std::vector<double>& marks);

  // What hides the light from the view: the part of the scene that the light meets first on its way to the most of the receivers
  // that face it in shadow, and the share of these receivers. Empty without such a receiver. Throws Error.
  struct Hider {
    std::string part;
    double share = 0;
  };
  std::optional<Hider> hider(const Settings& settings);

  // The peak memory that measure() would take. pictures: whether its pictures and EXR files are written. Throws Error.
  MemoryEstimate memory(const Settings& settings, bool curve, bool pictures);

  // The memory with which such estimates are compared.
  AvailableMemory memory_of_program(bool pictures) const;

  const gl::DeviceInfo& device() const;
  // The scene that the settings name. It is loaded if it is not the present one.
  const Scene& scene(const SceneSettings& settings);
  // scene_digest of that scene as it was loaded.
  const std::string& scene_identity(const SceneSettings& settings);

 private:
  std::unique_ptr<Bench> bench_;
};

}  // namespace noonmark
