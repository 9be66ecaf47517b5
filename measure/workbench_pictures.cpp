// The small pictures of a page: one at every bias, and stacks at a few values.
#include <algorithm>

#include "compare/ladder/bias_curves.h"
#include "measure/workbench_impl.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// Of the file of a live picture or of a stack of pictures. The page holds it as base64, with a third more bytes, and shall stay below 4 MB.
constexpr size_t most_live_bytes = 2'000'000;

}  // namespace

// One attempt at a live picture, of the picture's size in the settings.
LivePicture Workbench::Impl::draw_live(const SceneStage& loaded, const Settings& settings) {
  const Technique technique(*loaded.scene, settings);
  const ViewStage seen = stages->take_view(renderer, *loaded.scene, settings.view);
  const TruthStage traced = stages->trace_truth(loaded, seen, technique);
  renderer.load_receivers(seen.receivers, seen.camera.eye_m);
  LookupStage asked = stages->prepare_lookup(renderer, *loaded.tracer, seen, traced, technique);
  const MapDepths stored =
      renderer.read_map(*stages->draw_map(renderer, *loaded.scene, technique).map, asked.exact_depth.texels);
  const BiasPart& varied = *curve_part(settings.bias);
  LivePicture picture = empty_live_picture(seen.receivers.width(), seen.receivers.height());
  picture.taps = asked.probe.taps();
  picture.parameter = "bias." + std::string(varied.name);
  picture.unit = find_setting("bias.unit").get(settings);
  picture.scale = bias_scale(technique.frame, seen.receivers, traced.receivers, settings.bias.unit);
  for (size_t i = 0; i < picture.flags.size(); ++i)
    if (seen.receivers.primitive[i] != no_primitive) picture.flags[i] = live_surface;
  each_strip_of(renderer, asked, traced, technique, [&](const LookupEvidence& evidence, PixelRange strip) {
    add_live_strip(picture, evidence, stored, settings.bias, varied, strip);
  });
  return picture;
}

// One attempt at a stack of pictures. As in draw_live, nothing that the bench remembers is replaced, because the next
// point has a picture of full size again.
PictureStack Workbench::Impl::draw_stack(const SceneStage& loaded, const Settings& settings,
                                         const std::vector<double>& marks) {
  const BiasPart& part = stacked_part(settings.bias);
  const Technique as_set(*loaded.scene, settings);
  const ViewStage seen = stages->take_view(renderer, *loaded.scene, settings.view);
  const TruthStage traced = stages->trace_truth(loaded, seen, as_set);
  renderer.load_receivers(seen.receivers, seen.camera.eye_m);
  std::optional<BiasScale> scale;
  double otherwise = 1;
  if (part.acts_on == BiasTarget::compared_depth) {
    scale = bias_scale(as_set.frame, seen.receivers, traced.receivers, settings.bias.unit);
    otherwise = 1 / (scale->texels_per_depth * scale->depth_per_unit);
  }
  Remembered<LookupStage> lookup_stage;
  Remembered<MapStage> map_stage;
  std::optional<PictureStack> stack;
  Settings at = settings;
  for (const double value : stack_values(part, settings.bias[part.name], marks, otherwise)) {
    at.bias[part.name] = value;
    const StageKeys keys(at);
    const Technique technique(*loaded.scene, at);
    LookupStage& asked = lookup_stage.get(
        keys.lookup, [&] { return stages->prepare_lookup(renderer, *loaded.tracer, seen, traced, technique); });
    const auto draw_map = [&] { return stages->draw_map(renderer, *loaded.scene, technique); };
    MapStage& drawn = map_stage.get(keys.map, draw_map);
    if (!drawn.map) drawn = draw_map();
    const ShownStage shown = stages->show(renderer, drawn, asked, traced, technique);
    const Climbed climbed = stages->climb_strips(renderer, asked, seen, traced, shown, technique, nullptr);
    if (!stack) stack = empty_picture_stack(seen.receivers, traced.receivers, asked.probe);
    add_picture(*stack, value, climbed.ladder);
  }
  stack->parameter = "bias." + std::string(part.name);
  stack->unit = part.unit == "bias.unit" ? find_setting("bias.unit").get(settings) : std::string(part.unit);
  stack->why = why_no_live_picture(settings);
  stack->scale = scale;
  return *stack;
}

template <class Draw, class Write>
auto Workbench::Impl::draw_small(const Settings& settings, const Draw& draw, const Write& write) {
  const SceneStage& loaded = load(settings);
  // The picture needs a map and a lookup of its own. There may be no memory for two of each.
  maps.clear();
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
  require_one_map(settings, "a live picture");
  if (!why_no_live_picture(settings).empty()) return std::nullopt;
  return impl_->draw_small(
      settings, [&](const SceneStage& loaded, const Settings& small) { return impl_->draw_live(loaded, small); },
      live_file);
}

PictureStack Workbench::picture_stack(const Settings& settings, const std::vector<double>& marks) {
  validate(settings);
  require_one_map(settings, "a stack of pictures");
  return impl_->draw_small(
      settings,
      [&](const SceneStage& loaded, const Settings& small) { return impl_->draw_stack(loaded, small, marks); },
      stack_file);
}

}  // namespace noonmark
