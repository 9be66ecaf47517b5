#include <cmath>
#include <utility>

#include "compare/judge/poor_view.h"
#include "compare/ladder/bias_curves.h"
#include "compare/ladder/parameter_curve.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/threshold_bins.h"
#include "compare/results/quantities.h"
#include "measure/extra.h"
#include "measure/flicker_stage.h"
#include "measure/placements_extra.h"
#include "measure/texel_footprint.h"
#include "scenes/camera_frame.h"

namespace noonmark {
namespace {

// How large texels are in the picture. Of the maps' grids and the receivers alone, so that it is the same at every bias.
class FootprintExtra final : public Extra {
 public:
  explicit FootprintExtra(const ExtraInput& in) : in_(in) {}

  void put(Measurement& m) override {
    // Which of several maps a receiver is in depends on the lookup.
    const StageKeys& keys = in_.asked.keys;
    const std::string key = keys.truth + (in_.maps.choice.chosen.one_map() ? keys.map : keys.lookup);
    for (const auto& [name, value] : in_.bench.footprint.get(key, [&] { return metrics(); }))
      m.record.metrics[name] = value;
  }

 private:
  std::map<std::string, double> metrics() const {
    const ViewStage& view = in_.looked.view;
    std::vector<const LightFrame*> frames;
    for (const Technique& map : in_.maps.techniques()) frames.push_back(&map.frame);
    const CameraFrame camera = make_camera_frame(view.camera, view.receivers.width(), view.receivers.height());
    return footprint_metrics(
        texel_footprint(view.receivers, camera, frames, in_.maps.choice.chosen, in_.looked.truth.receivers.facing));
  }

  ExtraInput in_;
};

// Which lookup.reduction is usable.
class ReductionsExtra final : public Extra {
 public:
  explicit ReductionsExtra(const CurveOptions& options) : options_(options) {}

  void end(Climbed& climbed) override { found_.add(std::exchange(climbed.reductions, {})); }

  void put(Measurement& m) override {
    PointRecord& record = m.record;
    found_.sort();
    record.metrics.merge(reduction_metrics(found_, options_.peter_panning_bound, options_.acne_bound));
    record.lookup_curve = reduction_curve(found_);
    if (!record.lookup_curve.empty()) record.lookup_bounds = options_;
  }

 private:
  const CurveOptions& options_;
  ReductionWindow found_;
};

// The point at other values of one setting of its lookup.
class OverExtra final : public Extra {
 public:
  OverExtra(const ParameterValues& asked, const Settings& settings) : curve_(asked, settings) {}

  void begin(size_t, const LookupStage&, const ShownStage& shown) override { fetched_ = &shown.fetched; }
  void add(const LookupEvidence& evidence, PixelRange strip) override {
    ParameterCurve::Adding adding(curve_, evidence, *fetched_);
    read_taps(evidence, strip, adding);
  }
  void put(Measurement& m) override { m.record.over_curve = curve_.curve(); }

 private:
  ParameterCurve curve_;
  const Image<glm::vec4>* fetched_ = nullptr;
};

// The error at every bias. The thresholds of its taps are counted in the climb, unless a point before had the same curve.
class CurveExtra final : public Extra {
 public:
  CurveExtra(const ExtraInput& in, const CurveOptions& options, const BiasPart& varied)
      : in_(in), options_(options), key_(curve_key_of(in.asked.technique.settings, varied, options)) {
    if (in.bench.curve.has(key_)) return;
    counted_ = &varied;
    std::vector<ScaledMap> scaled;
    for (size_t k = 0; k < in.maps.count(); ++k)
      scaled.push_back({in.maps.techniques()[k].frame, in.maps.truths[k]->receivers});
    scale_ = bias_scale(scaled, in.looked.view.receivers, in.asked.technique.settings.bias.unit);
  }

  const BiasPart* counted() const { return counted_; }
  std::vector<float> edges() const { return placement_edges(biases_of(options_), scale_.depth_per_unit); }
  // Its bands come from these placements.
  const PlacementsExtra* placements = nullptr;

  void end(Climbed& climbed) override {
    if (!climbed.counts) return;
    needed_.push_back(static_cast<double>(climbed.counts->acne_free_from(0)));
    if (counts_)
      counts_->add(std::move(*climbed.counts));
    else
      counts_.emplace(std::move(*climbed.counts));
    climbed.counts.reset();
  }

  void put(Measurement& m) override {
    PointRecord& record = m.record;
    if (nothing_judged(record)) return;
    const CurveStage& found = in_.bench.curve.get(key_, [&] { return summarised(); });
    record.curve = found.curve;
    for (size_t k = 0; k < record.cascades.size(); ++k)
      if (record.cascades[k].metrics.at("counted") > 0 && std::isfinite(found.needed[k]))
        record.cascades[k].bias_needed = found.needed[k];
  }

 private:
  CurveStage summarised() {
    CurveStage made{summarise(*counts_, scale_, options_), needed_};
    counts_.reset();  // large, and not needed again: freed before the curve is copied
    if (placements) add_bands(made.curve, placements->counts(), scale_.depth_per_unit);
    return made;
  }

  ExtraInput in_;
  const CurveOptions& options_;
  std::string key_;
  const BiasPart* counted_ = nullptr;
  BiasScale scale_;                   // only of a curve that is not known yet
  std::optional<BiasCounts> counts_;  // of all maps
  std::vector<double> needed_;
};

// What changes from this frame to the next.
class FlickerExtra final : public Extra {
 public:
  explicit FlickerExtra(const ExtraInput& in) : in_(in) {}

  void put(Measurement& m) override {
    Bench& b = in_.bench;
    b.see(in_.asked);
    m.flicker = trace_flicker({*b.stages, b.renderer, in_.asked.loaded, in_.looked.view, in_.looked.truth,
                               in_.maps.techniques(), in_.maps.choice.chosen, m.ladder[Rung::shown]});
    m.record.metrics.merge(measure_flicker(*m.flicker));
  }

 private:
  ExtraInput in_;
};

}  // namespace

Extras extras_of(const ExtraInput& in, const std::optional<CurveOptions>& curve, MetricSet metrics) {
  const Settings& settings = in.asked.technique.settings;
  Extras extras;
  const auto ask = [&]<class One>(std::unique_ptr<One> one) {
    One* const asked = one.get();
    extras.each.push_back(std::move(one));
    return asked;
  };
  if (metrics == MetricSet::all) ask(std::make_unique<FootprintExtra>(in));
  const bool reduces = curve && has_reduction_curve(settings);
  if (reduces) ask(std::make_unique<ReductionsExtra>(*curve));
  if (curve && has_curve_over(settings, curve->over.setting)) {
    ask(std::make_unique<OverExtra>(curve->over, settings));
    extras.reads_fetched = true;
  }
  const BiasPart* const varied = curve ? curve_part(settings) : nullptr;
  CurveExtra* const biases = varied ? ask(std::make_unique<CurveExtra>(in, *curve, *varied)) : nullptr;
  if (biases) extras.counted = biases->counted();
  if (settings.view.motion.any()) ask(std::make_unique<FlickerExtra>(in));
  if (settings.map.placements > 1) {
    PlacementRequest request{extras.counted, {}, {}, in.checks};
    if (extras.counted) request.edges = biases->edges();
    if (reduces && in.maps.count() == 1) request.reductions = *curve;
    const PlacementsExtra* const placements = ask(std::make_unique<PlacementsExtra>(in, std::move(request)));
    if (biases) biases->placements = placements;
  }
  return extras;
}

}  // namespace noonmark
