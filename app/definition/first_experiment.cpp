#include "app/definition/first_experiment.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/definition/toml_text.h"
#include "base/error.h"
#include "base/text.h"
#include "scenes/fit.h"
#include "scenes/ground.h"
#include "scenes/interior.h"

namespace noonmark {
namespace {

std::string light_text(const Model& model, bool room) {
  if (model.contents.gives_light)
    return "[light]\n"
           "angular_diameter_deg = \"auto\"  # the light is the file's; radius_m, or this for a sun, gives it a size\n";
  if (room) {
    const Sphere sphere = bounding_sphere(model.scene);
    const glm::dvec3 at = sphere.centre_m;
    return fmt::format(
        "[light]\n"
        "kind = \"point\"              # the model is a closed room, which no sun reaches\n"
        "position_m = [{:.6g}, {:.6g}, {:.6g}]  # the middle of the room; +Y is up\n",
        at.x, at.y, at.z);
  }
  return "[light]                     # the file shows none, so this is a sun\n"
         "azimuth_deg = -50           # its side: 0 above +Z, the front of a glTF model; 90 above +X\n"
         "elevation_deg = 50          # above the horizon; 90 is overhead, +Y. A low sun makes long shadows and more "
         "acne\n"
         "# Or, as in three.js, from a position towards a target, in place of the two lines above:\n"
         "# position_m = [5, 10, 7]\n"
         "# target_m = [0, 0, 0]\n";
}

std::string scene_text(const Model& model, const std::string& path, bool floor) {
  std::string text = fmt::format("[scene]\nname = {}\n", toml_string(path));
  if (floor)
    text += "floor = true                # a square under the model: it has no ground that its shadow could fall on\n";
  else
    text += "floor = false               # the model has a ground of its own; true adds a square under it\n";
  if (model.contents.animations > 0)
    text +=
        "# time_s = 0.5              # poses the file's animation 0 at this time; without it the model is at rest\n";
  return text;
}

constexpr const char* first_bounds =
    "[[bound]]                   # the shadow must hold this, or `noonmark check` ends with exit code 1\n"
    "metric = \"acne\"             # share of the receivers that shadow themselves; more bias helps\n"
    "max = 0.005                 # 0.5%. Change it to what your pictures can bear\n"
    "where = {\"map.resolution\" = 2048}  # the map that you mean to ship\n"
    "\n"
    "[[bound]]\n"
    "metric = \"peter_panning\"    # share that is lit because the bias reaches past its occluder; less bias helps\n"
    "max = 0.005\n"
    "where = {\"map.resolution\" = 2048}\n"
    "\n"
    "[[bound]]                   # for the eye: within a pixel, a drawn edge cannot be told from the true one\n"
    "metric = \"edge_displacement_p95_pixels\"  # of 95% of the pixels at edges: a single pixel decides nothing\n"
    "max = 1\n"
    "where = {\"map.resolution\" = 2048}\n"
    "\n"
    "[[bound]]                   # for the eye: no blob. Of the errors that are left, people see the connected ones\n"
    "metric = \"wrong_patch\"      # the largest patch of wrong pixels, as a share of the picture\n"
    "max = 0.0002                # 0.02% of 960 x 540 are 10 x 10 pixels\n"
    "where = {\"map.resolution\" = 2048}\n";

}  // namespace

std::string first_experiment(const Model& model, const std::string& path) {
  const bool room = camera_inside(model.scene).has_value();
  const bool floor = !room && !has_ground(model.scene);
  const LightKind light = model.contents.gives_light ? model.scene.light.kind
                          : room                     ? LightKind::point
                                                     : LightKind::directional;
  std::string text = fmt::format(
      "# A first experiment, written by `noonmark init`. Measure it:  noonmark run THIS_FILE\n"
      "# Judge the bounds at its end:  noonmark check THIS_FILE.  All settings:  noonmark settings\n\n"
      "title = {}\n"
      "pictures = \"extremes\"       # of the best and of the worst point; \"all\" writes those of every point\n\n",
      toml_string("First steps with " + std::filesystem::path(path).filename().string()));
  text += scene_text(model, path, floor) + "\n";
  text += fmt::format(
      "[view]                      # the camera is {}; eye_m and target_m move it\n"
      "width_px = 960              # a larger picture has more receivers and takes longer\n"
      "height_px = 540\n\n",
      model.contents.gives_camera ? "the file's" : "fitted to the model");
  text += light_text(model, room) + "\n[map]\n";
  if (light == LightKind::directional)
    text +=
        "fit = \"casters\"             # covers all that casts shadows, without the ground; \"view\": what the picture "
        "shows\n";
  text +=
      "format = \"24\"               # depth bits; also \"16\" and \"32f\"\n\n"
      "[bias]\n"
      "unit = \"texel\"              # of `constant`: a texel's width along the light, so it fits every resolution\n"
      "constant = 2                # what the bounds judge; the report's curve shows every other bias too\n\n"
      "[filter]\n"
      "kind = \"none\"               # one tap; \"box\" blurs over size x size texels (a point light takes "
      "\"cube_grid\")\n\n"
      "[curve]                     # a usable bias keeps both within these shares of the receivers\n"
      "acne_bound = 0.005\n"
      "peter_panning_bound = 0.005\n\n";
  if (light != LightKind::point)
    text +=
        "[phase]                     # the report's first figure: texel size against bias\n"
        "texel_sizes = 13            # 25 are smoother and take twice as long\n"
        "width_px = 320\n\n";
  text += fmt::format(
      "[sweep]                     # each value is measured: 4 points; of several settings, every combination\n"
      "map.resolution = [{}]\n\n",
      light == LightKind::point ? "256, 512, 1024, 2048" : "512, 1024, 2048, 4096");
  text +=
      "[answer]\n"
      "choose = [\"map.resolution\", \"map.fit\", \"bias\", \"filter\"]  # what `noonmark recommend` may change; the "
      "rest stays\n\n";
  return text + first_bounds;
}

}  // namespace noonmark
