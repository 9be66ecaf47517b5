// The small pictures of a page: one at every bias, and stacks at a few values.
#include <algorithm>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/reduction_window.h"
#include "measure/bench.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// Of the file of a live picture or of a stack of pictures. The page holds it as base64, with a third more bytes, and shall stay below 4 MB.
constexpr size_t most_live_bytes = 2'000'000;

// Whether a picture of so many pixels fits, whatever the answers of its taps are.
bool fits_surely(size_t pixels, int taps) {
  return live_array_bytes(pixels * (2 * static_cast<size_t>(taps) + 1), pixels) <= most_live_bytes;
}

// Bands of rows from the top, each with as many rows as all before it. A picture that has too many answers shows it in one of
// the first, so that its other taps need no truth.
std::vector<PixelRange> growing_bands(size_t width, size_t height) {
  constexpr size_t first_band = 16;  // of the height
  std::vector<PixelRange> bands;
  for (size_t row = 0, end = (height + first_band - 1) / first_band; row < height; row = end, end = 2 * row)
    bands.push_back({row * width, std::min(end, height) * width});
  return bands;
}

}  // namespace

// What a small picture is drawn from: its maps, each with the truth of its receivers. As of the point itself, but nothing that
// the bench remembers is replaced, because the next point has a picture of full size again.
struct Bench::SmallPicture {
  SmallPicture(Bench& bench, const SceneStage& loaded, const Settings& settings)
      : seen(bench.stages->take_view(bench.renderer, *loaded.scene, settings.view)),
        visible(visible_depths(settings, seen.receivers, seen.camera)) {
    const std::vector<Technique> techniques = techniques_of(*loaded.scene, settings, visible);
    all = bench.stages->trace_truth(loaded, seen, techniques.front());
    bench.renderer.load_receivers(seen.receivers, seen.camera.eye_m);
    choice.chosen = bench.renderer.choose_maps(techniques.front());
    std::vector<ScaledMap> scaled;
    for (const Technique& technique : techniques) {
      const auto map = static_cast<int>(truths.size());
      truths.push_back(choice.chosen.one_map() ? all : truth_of_map(all, choice.chosen, map));
      scaled.push_back({technique.frame, truths.back().receivers});
    }
    scale = bias_scale(scaled, seen.receivers, settings.bias.unit);
  }
  // Its maps with other settings of the same view.
  PointMaps at(const Scene& scene, const Settings& settings) const {
    PointMaps maps{std::make_shared<const std::vector<Technique>>(techniques_of(scene, settings, visible)), choice, {}};
    for (const TruthStage& truth : truths) maps.truths.push_back(&truth);
    return maps;
  }
  ViewStage seen;
  std::optional<ViewSlice> visible;  // of this picture's own pixels
  TruthStage all;
  ChoiceStage choice;
  std::deque<TruthStage> truths;  // of each map; lookups refer to them
  BiasScale scale;
};

// One attempt at a live picture, of the picture's size in the settings. A picture that does not fit may miss receivers.
LivePicture Bench::draw_live(const SceneStage& loaded, const Settings& settings) {
  SmallPicture small(*this, loaded, settings);
  const PointMaps of = small.at(*loaded.scene, settings);
  const BiasPart& varied = *curve_part(settings);
  LivePicture picture = empty_live_picture(small.seen.receivers.width(), small.seen.receivers.height());
  picture.taps = of.techniques().front().taps.taps;
  picture.parameter = "bias." + std::string(varied.name);
  picture.unit = find_setting("bias.unit").get(settings);
  picture.scale = small.scale;
  for (size_t i = 0; i < picture.flags.size(); ++i)
    if (small.seen.receivers.primitive[i] != no_primitive) picture.flags[i] = live_surface;
  bool fits = true;
  for (size_t k = 0; k < of.count() && fits; ++k) {
    const Technique& technique = of.techniques()[k];
    TruthStage& truth = small.truths[k];
    for (size_t i = 0; i < truth.receivers.share.size(); ++i)  // without a blend band each receiver is of one map
      if (truth.receivers.share[i] == 0) truth.receivers.facing[i] = 0;
    LookupStage asked = stages->prepare_lookup(renderer, *loaded.tracer, small.seen, truth, technique);
    const MapDepths stored =
        renderer.read_map(*stages->draw_map(renderer, *loaded.scene, technique).map, asked.exact_depth.texels);
    if (asked.strips.size() == 1 && !fits_surely(picture.flags.size(), picture.taps))
      asked.strips = growing_bands(static_cast<size_t>(picture.flags.width), static_cast<size_t>(picture.flags.height));
    fits = each_strip_while(renderer, asked, truth, technique, [&](const LookupEvidence& evidence, PixelRange strip) {
      add_live_strip(picture, evidence, stored, varied, strip);
      return live_array_bytes(picture) <= most_live_bytes;
    });
  }
  return picture;
}

// Around which the pictures of a reduction stand where neither the settings nor the marks have one: what engines often set.
constexpr double usual_reduction = 0.1;

// One attempt at a stack of pictures.
PictureStack Bench::draw_stack(const SceneStage& loaded, const Settings& settings, const std::vector<double>& marks) {
  const BiasPart* const part = stacked_part(settings);
  const std::string parameter = part ? "bias." + std::string(part->name) : "lookup.reduction";
  const double as_set = part ? settings.bias[part->name] : settings.lookup["reduction"];
  SmallPicture small(*this, loaded, settings);
  std::optional<BiasScale> scale;
  double otherwise = part ? 1 : usual_reduction;
  if (part && part->acts_on == BiasTarget::compared_depth) {
    scale = small.scale;
    otherwise = 1 / (scale->texels_per_depth * scale->depth_per_unit);
  }
  KeptMaps kept;
  kept.each.resize(small.truths.size());
  std::optional<PictureStack> stack;
  Settings at = settings;
  for (const double value : stack_values(part ? part->most : most_reduction, as_set, marks, otherwise)) {
    if (part)
      at.bias[part->name] = value;
    else
      at.lookup["reduction"] = value;
    const PointMaps of = small.at(*loaded.scene, at);
    const std::vector<Technique>& techniques = of.techniques();
    ShownMaps shown = show_maps({loaded, techniques.front(), StageKeys(at)}, small.seen, kept, of, MetricSet::searched,
                                false, Checks::none);
    std::optional<Ladder> ladder;
    for (size_t k = 0; k < techniques.size(); ++k) {
      const TruthStage& truth = small.truths[k];
      LookupStage& asked = *kept.each[k].lookup.value();
      if (!part && !asked.kept_steps) asked.kept_steps.emplace();  // the pictures differ in the reduction alone
      const ShownStage one = shown.take(small.choice.chosen, k);
      Climbed climbed = stages->climb_strips(renderer, asked, small.seen, truth, one, techniques[k], nullptr);
      if (!stack) stack = empty_picture_stack(small.seen.receivers, small.all.receivers, asked.probe, parameter);
      if (ladder)
        join(*ladder, climbed.ladder, truth.receivers.share);
      else
        ladder = std::move(climbed.ladder);
    }
    add_picture(*stack, value, *ladder);
  }
  if (part) stack->unit = unit_of_amount(part->unit, settings.bias);
  stack->why = why_no_live_picture(settings);
  stack->scale = scale;
  return *stack;
}

template <class Draw, class Write>
auto Bench::draw_small(const Settings& settings, const Draw& draw, const Write& write) {
  const SceneStage& loaded = load(settings);
  // The picture needs a map and a lookup of its own. There may be no memory for two of each.
  if (!fits_waiting(memory(settings, false, true), memory_of_program(true))) forget_maps();
  receivers_on_device.clear();
  Settings small = settings;
  const double shrink = std::min({1.0, static_cast<double>(most_live_width_px) / small.view.width_px,
                                  static_cast<double>(most_live_height_px) / small.view.height_px});
  for (double size = shrink;; size /= 2) {
    small.view.width_px = std::max(1, static_cast<int>(settings.view.width_px * size));
    small.view.height_px = std::max(1, static_cast<int>(settings.view.height_px * size));
    auto drawn = draw(loaded, small);
    if (write(drawn).size() <= most_live_bytes || small.view.width_px * small.view.height_px == 1) return drawn;
  }
}

std::optional<LivePicture> Workbench::live_picture(const Settings& settings) {
  validate(settings);
  if (!why_no_live_picture(settings).empty()) return std::nullopt;
  return bench_->draw_small(
      settings, [&](const SceneStage& loaded, const Settings& small) { return bench_->draw_live(loaded, small); },
      live_file);
}

PictureStack Workbench::picture_stack(const Settings& settings, const std::vector<double>& marks) {
  validate(settings);
  return bench_->draw_small(
      settings,
      [&](const SceneStage& loaded, const Settings& small) { return bench_->draw_stack(loaded, small, marks); },
      stack_file);
}

}  // namespace noonmark
