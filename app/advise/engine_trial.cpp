#include "app/advise/engine_trial.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "app/advise/map_places.h"
#include "app/advise/recommend_space.h"
#include "app/advise/recommend_text.h"
#include "app/pictures/given_frame.h"
#include "base/error.h"
#include "base/file.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "frames/judge.h"
#include "measure/given_lookup.h"
#include "raytrace/tracer.h"
#include "scenes/camera_fit.h"
#include "scenes/gltf/write_glb.h"
#include "scenes/library.h"
#include "technique/cascades.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

// Of the pictures. A software rasteriser of a browser draws one in a few seconds.
constexpr int trial_width_px = 1280;

// The engine's light shines where the settings say: to the float of a direction that went through its matrices.
constexpr double same_direction_rad = 1e-4;

[[noreturn]] void cannot_try(const std::string& why) {
  throw Error(ErrorKind::usage, fmt::format("--engine: {}; leave --engine out, or choose others", why));
}

// The lines hold for one scene and one light.
void require_one_scene(const std::vector<Settings>& conditions) {
  const auto first = settings_map(conditions.front());
  for (const Settings& condition : conditions)
    for (const auto& [name, value] : settings_map(condition))
      if (!name.starts_with("view.") && value != first.at(name))
        cannot_try("an engine is tried with one scene and one light, but the conditions differ in " + name);
}

// The settings of the scene that a file by itself has.
bool is_plain_file(const SceneSettings& settings) {
  if (!names_file(settings.name)) return false;
  Settings plain, given;
  plain.scene.name = given.scene.name = settings.name;
  given.scene = settings;
  return settings_map(plain) == settings_map(given);
}

// The file that the engine loads: the model's own where it is the scene, otherwise the scene as it is measured.
std::string model_of(Workbench& bench, const Settings& settings, const std::string& folder) {
  if (is_plain_file(settings.scene)) return fs::absolute(settings.scene.name).string();
  const Scene& scene = bench.scene(settings.scene);
  const std::string file = folder + "/scene.glb";
  write_file_atomically(file, glb_of(scene, effective_camera(scene, settings.view), effective_light(scene, settings)));
  return file;
}

std::string exact(glm::dvec3 v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

// "given", "turned by -30 deg" about the vertical, or its number.
std::string view_name(const Camera& first, const Camera& camera, size_t number) {
  if (number == 0) return "given";
  const glm::dvec3 up = glm::normalize(first.up);
  const auto across = [&](const Camera& one) {
    const glm::dvec3 way = one.target_m - one.eye_m;
    return way - glm::dot(way, up) * up;
  };
  const glm::dvec3 from = across(first), to = across(camera);
  const bool turned = glm::length(to) > 0 && glm::length(from) > 0;
  const double deg = turned ? glm::degrees(std::atan2(glm::dot(glm::cross(from, to), up), glm::dot(from, to))) : 0;
  return std::abs(deg) < 0.5 ? fmt::format("view {}", number + 1) : fmt::format("turned by {:.0f} deg", deg);
}

class Trial {
 public:
  Trial(Workbench& bench, const TrialPlan& plan, const TrialBounds& bounds, const std::string& out)
      : bench_(bench), plan_(plan), bounds_(bounds), folder_(out + "/" + trial_folder) {
    make_folder(folder_);
    model_ = model_of(bench, plan.views.front(), folder_);
  }

  EngineTrial of(const EngineAdapter& adapter, const EngineAdvice& advice,
                 const std::function<void(const std::string&)>& say) {
    EngineTrial trial;
    trial.folder = fmt::format("{}/{}", trial_folder, adapter.name);
    if (advice.lines.empty()) {
      trial.no_frame = "there are no lines to try: " + advice.cannot.front();
      return trial;
    }
    const std::string folder = fmt::format("{}/{}", folder_, adapter.name);
    make_folder(folder);
    std::string lines;
    for (const std::string& line : engine_lines(advice)) lines += line + "\n";
    write_file_atomically(folder + "/lines.txt", lines);
    for (size_t i = 0; i < plan_.views.size(); ++i) {
      say(fmt::format("{} draws view {} of {}", advice.engine, i + 1, plan_.views.size()));
      try {
        trial.views.push_back(view(adapter, advice, i, fmt::format("{}/view{}", folder, i + 1), trial.notes));
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::device) throw;
        trial.no_frame = error.what();
        return trial;
      }
    }
    return trial;
  }

 private:
  TrialView view(const EngineAdapter& adapter, const EngineAdvice& advice, size_t number, const std::string& folder,
                 std::set<std::string>& notes) {
    const Settings condition = small_picture(plan_.views[number], trial_width_px);
    const Scene& scene = bench_.scene(condition.scene);
    const Camera camera = effective_camera(scene, condition.view);
    TrialView view;
    view.name = view_name(effective_camera(scene, plan_.views.front().view), camera, number);
    const std::vector<std::string> said = shoot(
        plan_.tools, adapter, model_, folder,
        {fmt::format("width={}", condition.view.width_px), fmt::format("height={}", condition.view.height_px),
         "eye=" + exact(camera.eye_m), "target=" + exact(camera.target_m), "up=" + exact(camera.up),
         fmt::format("fov_y_deg={}", camera.fov_y_deg), fmt::format("lines={}/{}/lines.txt", folder_, adapter.name)});
    notes.insert(said.begin(), said.end());
    judge_view(view, folder + "/frame.json", condition, advice);
    const auto require = [&](const char* what, double found, double most) {
      if (!(found <= most))
        view.broken.push_back(fmt::format("{} {} (bound {})", what, share_text(found), share_text(most)));
    };
    if (!view.refused.empty()) return view;
    require("acne", view.measured.acne, bounds_.bounds.acne_bound);
    require("Peter Panning", view.measured.peter_panning, bounds_.bounds.peter_panning_bound);
    if (bounds_.error) require("error", view.measured.error, *bounds_.error);
    return view;
  }

  // The condition for the file that the engine loads. A scene that is not a plain file is exported for the engine, and the export
  // gives each triangle its own vertices. A technique that moves casters moves them by these vertices' normals.
  Settings in_file(const Settings& condition) {
    Settings there = condition;
    there.view.fit_depths = true;  // a file's near plane would cut off what the adapter's camera shows
    there.view.far_m = std::nullopt;
    // The first of several maps begins at the camera's near plane, and the lines set that plane.
    if (condition.maps() == 1) there.view.near_m = std::nullopt;
    if (is_plain_file(condition.scene)) return there;
    const Scene& scene = bench_.scene(condition.scene);
    const LightFrame frame = make_light_frame(scene, there);
    const Camera camera = effective_camera(scene, condition.view);
    const Light light = effective_light(scene, condition);
    there.light = {};
    there.light.position_m = light.position_m, there.light.target_m = light.target_m;
    there.light.angular_diameter_deg = light.angular_diameter_deg;
    if (!fits_view(there.map.fit)) lay_as(frame, there);
    there.view.eye_m = camera.eye_m, there.view.target_m = camera.target_m, there.view.up = camera.up;
    there.view.fov_deg = camera.fov_y_deg;
    there.scene = SceneSettings();
    there.scene.name = model_;
    return there;
  }

  // By place, as for a frame whose map is not known: where a truth is lit and the frame dark away from edges is acne, and
  // the reverse is Peter Panning. The promise is what Noonmark's own map and lookup show at the receivers of the engine's
  // frame, judged in the same way: an engine's rasteriser samples each pixel at another place, some hundredths of a pixel
  // off, which changes by itself which pixels at an edge are wrong.
  void judge_view(TrialView& view, const std::string& path, const Settings& condition, const EngineAdvice& advice) {
    FrameFile file = read_frame_file(path);
    file.map.reset();
    const Settings shown = in_file(condition);
    std::optional<Settings> promised;
    if (advice.emulated) {
      promised = in_file(as_engine(advice, condition));
      promised->map.placements = 1;
    }
    const Scene& scene = bench_.scene(shown.scene);
    GivenFrame frame = given_frame(file, scene);
    const Light wanted = effective_light(scene, shown);
    const auto way = [](const Light& light) { return glm::normalize(light.target_m - light.position_m); };
    if (const double off = std::acos(std::min(1.0, glm::dot(way(frame.light), way(wanted))));
        off > same_direction_rad) {
      view.refused = fmt::format("the engine's light is {:.2g} degrees off the given one", glm::degrees(off));
      return;
    }
    frame.light = wanted;  // with its size
    const raytrace::Tracer tracer(scene);
    JudgeRules rules = rules_of(file);
    rules.standard_error = condition.truth.standard_error;
    const FrameVerdict verdict = judge_frame(scene, tracer, frame, rules);
    for (const CheckResult& check : verdict.checks)
      if (check.state == CheckState::failed && view.refused.empty())
        view.refused = fmt::format("{}: {}", check.name, check.says);
    if (verdict.refused()) return;
    view.counted = static_cast<size_t>(verdict.metrics.at("counted"));
    view.measured = shares(verdict);
    if (!promised) return;
    const Image<float> ours =
        GivenLookup(scene, tracer)
            .visibility(verdict.receivers, effective_camera(scene, shown.view).eye_m, techniques_of(scene, *promised));
    for (size_t i = 0; i < ours.size(); ++i)
      if (verdict.counted[i]) frame.visibility[i] = ours[i];
    view.promise = shares(judge_frame(scene, tracer, frame, rules));
  }

  static EnginePromise shares(const FrameVerdict& verdict) {
    return {verdict.metrics.at("frame_error"), verdict.metrics.at("frame_acne"),
            verdict.metrics.at("frame_contact") + verdict.metrics.at("frame_leak")};
  }

  Workbench& bench_;
  const TrialPlan& plan_;
  const TrialBounds& bounds_;
  std::string folder_, model_;
};

}  // namespace

TrialPlan plan_trial(Workbench& bench, const std::vector<Settings>& conditions, const std::vector<std::string>& names,
                     const std::string& folder) {
  TrialPlan plan;
  for (std::string name : names) {
    name.erase(0, name.find_first_not_of(' '));  // of a list "three, babylon"
    name.erase(name.find_last_not_of(' ') + 1);
    engine_adapter(name);  // refuses another name
    if (std::find(plan.names.begin(), plan.names.end(), name) == plan.names.end()) plan.names.push_back(name);
  }
  require_one_scene(conditions);
  const Settings& first = conditions.front();
  const Scene& scene = bench.scene(first.scene);
  if (const LightFrame frame = make_light_frame(scene, first); frame.kind != LightKind::directional)
    cannot_try(fmt::format("the adapters show a directional light, but this one is a {} light",
                           kind_of_light(frame.kind).name()));
  if (scene.mask_error_m > 0 && is_plain_file(first.scene))
    cannot_try("the adapters draw materials without their alpha masks (or give --set scene.masks=false)");
  for (const Settings& condition : conditions)
    if (effective_camera(scene, condition.view).projection != Projection::perspective)
      cannot_try("the adapters have a perspective camera, but this one is orthographic");
  plan.tools = find_adapters(plan.names, folder);
  plan.views = conditions;
  return plan;
}

void try_engines(Workbench& bench, const TrialPlan& plan, std::vector<EngineAdvice>& engines, const TrialBounds& bounds,
                 const std::string& out, const std::function<void(const std::string&)>& say) {
  Trial trial(bench, plan, bounds, out);
  for (const std::string& name : plan.names) {
    const EngineAdapter& adapter = engine_adapter(name);
    for (EngineAdvice& advice : engines) {
      if (advice.engine != adapter.engine) continue;
      advice.trial = trial.of(adapter, advice, say);
      for (const TrialView& view : advice.trial->views)
        if (!view.broken.empty() && advice.broken.empty())
          advice.broken = fmt::format("these lines are not an answer: in the engine, view {}, {}", view.name,
                                      fmt::join(view.broken, " and "));
    }
  }
}

}  // namespace noonmark
