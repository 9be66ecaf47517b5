// The C interface (frames/noonmark.h). No exception passes it.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "frames/frame_keys.h"
#include "frames/frame.h"
#include "frames/judge.h"
#include "frames/noonmark.h"
#include "scenes/library.h"
#include "scenes/number_ranges.h"
#include "scenes/scene_size.h"

using namespace noonmark;

struct noonmark_scene {
  int status = NOONMARK_OK;
  std::string message;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<raytrace::Tracer> tracer;
};

struct noonmark_verdict {
  int status = NOONMARK_OK;
  std::vector<std::string> messages;
  std::vector<std::string> names;
  FrameVerdict verdict;
  bool judged = false;
};

namespace {

// Runs f and books its exception.
template <class F>
void guarded(int& status, std::string& message, const F& f) noexcept {
  try {
    f();
  } catch (const Error& error) {
    status = error.exit_code();
    message = error.what();
  } catch (const std::bad_alloc&) {
    status = NOONMARK_NO_DEVICE;
    message = "there is not enough memory";
  } catch (const std::exception& fault) {
    status = NOONMARK_DEFECT;
    message = fault.what();
  }
}

[[noreturn]] void wrong_call(const std::string& why) { throw Error(ErrorKind::usage, why); }

noonmark_scene* made(const auto& make) noexcept {
  auto* const scene = new (std::nothrow) noonmark_scene;
  if (!scene) return nullptr;
  guarded(scene->status, scene->message, [&] {
    scene->scene = std::make_unique<Scene>(make());
    scene->tracer = std::make_unique<raytrace::Tracer>(*scene->scene);
  });
  return scene;
}

void require_room(const std::string& what, double bytes) {
  if (const AvailableMemory available = available_memory(); bytes > static_cast<double>(available.bytes))
    throw Error(ErrorKind::device, what + " takes " + bytes_text(bytes) + " of memory, and " + available.text());
}

Scene scene_of(const float* positions, size_t vertices, const uint32_t* indices, size_t triangles) {
  if (!positions || !indices || vertices == 0 || triangles == 0) wrong_call("a scene has at least one triangle");
  if (triangles > max_scene_triangles || vertices > std::numeric_limits<uint32_t>::max())
    wrong_call("a scene has at most " + std::to_string(max_scene_triangles) +
               " triangles, and vertices that 32-bit indices can name");
  require_room("the scene", scene_bytes({.vertices = vertices, .triangles = triangles}));
  Scene scene;
  scene.name = "triangles";
  for (size_t i = 0; i < vertices; ++i) {
    const glm::vec3 p(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    if (!is_in_world(p))
      wrong_call("position " + std::to_string(i) + " is not finite, or more than 1e9 m from the origin");
    scene.positions.push_back(p);
  }
  for (size_t i = 0; i < triangles; ++i) {
    const glm::uvec3 t(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]);
    if (std::max({t.x, t.y, t.z}) >= vertices)
      wrong_call("triangle " + std::to_string(i) + " has an index beyond the last vertex");
    scene.triangles.push_back(t);
  }
  return scene;
}

Light light_of(const noonmark_frame& f) {
  Light light;
  const glm::dvec3 way(f.light_direction[0], f.light_direction[1], f.light_direction[2]);
  switch (f.light_kind) {
    case NOONMARK_DIRECTIONAL:
      light.kind = LightKind::directional;
      break;
    case NOONMARK_SPOT:
      light.kind = LightKind::spot;
      break;
    case NOONMARK_POINT:
      light.kind = LightKind::point;
      break;
    default:
      wrong_call("light_kind is none of NOONMARK_DIRECTIONAL, NOONMARK_SPOT and NOONMARK_POINT");
  }
  light.position_m = {f.light_position[0], f.light_position[1], f.light_position[2]};
  for (const double part : f.light_direction) require_in_range("light.direction", part);
  if (light.kind != LightKind::point) {
    if (!has_direction(way)) wrong_call("light_direction has no length; set it to the way the light travels");
    light.target_m = light.position_m + glm::normalize(way);
  }
  light.cone_deg = f.light_cone_deg;
  light.angular_diameter_deg = f.light_angular_diameter_deg;
  light.radius_m = f.light_radius_m;
  return light;
}

glm::dmat4 matrix_of(const double* numbers) {
  glm::dmat4 m;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[i];
  return m;
}

ViewMatrix view_of(const noonmark_frame& f) {
  try {
    return ViewMatrix(
        from_convention(matrix_of(f.clip_from_world), {f.depth_0_to_1 != 0, f.reversed != 0, f.y_down != 0}));
  } catch (const Error& error) {
    wrong_call(std::string("clip_from_world: ") + error.what());
  }
}

GivenFrame frame_of(const noonmark_frame& f) {
  if (f.width < 1 || f.height < 1 || !f.visibility) wrong_call("a frame has a width, a height and visibility");
  require_room("a frame of " + std::to_string(f.width) + " x " + std::to_string(f.height) + " pixels",
               frame_bytes(f.width, f.height));
  for (const double number : f.clip_from_world) require_in_range("camera.clip_from_world", number);
  GivenFrame frame{.name = "frame",
                   .visibility = Image<float>(f.width, f.height),
                   .positions = {},
                   .view = view_of(f),
                   .light = light_of(f)};
  std::copy_n(f.visibility, frame.visibility.size(), frame.visibility.pixels.begin());
  take_marks(frame);
  frame.normalised = f.normalised != 0;
  if (f.positions) {
    frame.receivers = GivenReceivers::positions;
    frame.marks_no_surface = true;
    frame.positions = Image<glm::dvec3>(f.width, f.height);
    for (size_t i = 0; i < frame.positions.size(); ++i)
      frame.positions[i] = {f.positions[3 * i], f.positions[3 * i + 1], f.positions[3 * i + 2]};
  }
  return frame;
}

JudgeRules rules_of(const noonmark_frame& f) {
  JudgeRules rules;
  rules.edge_pixels = f.edge_pixels;
  if (f.edge_m != 0) rules.edge_m = f.edge_m;
  if (f.contact_m != 0) rules.contact_m = f.contact_m;
  std::istringstream names(f.accept ? f.accept : "");
  for (std::string name; std::getline(names, name, ',');) rules.accepted.insert(name);
  return rules;
}

noonmark_frame defaults() {
  noonmark_frame frame{};
  frame.struct_size = sizeof frame;
  frame.light_cone_deg = Light().cone_deg;
  frame.edge_pixels = JudgeRules().edge_pixels;
  return frame;
}

}  // namespace

extern "C" {

const char* noonmark_version(void) { return NOONMARK_VERSION; }

noonmark_scene* noonmark_scene_load(const char* name) {
  return made([&] {
    if (!name || !*name) wrong_call("a scene has a name");
    SceneSettings settings;
    settings.name = name;
    return make_scene(settings);
  });
}

noonmark_scene* noonmark_scene_from_triangles(const float* positions, size_t vertices, const uint32_t* indices,
                                              size_t triangles) {
  return made([&] { return scene_of(positions, vertices, indices, triangles); });
}

int noonmark_scene_status(const noonmark_scene* scene) { return scene ? scene->status : NOONMARK_WRONG_CALL; }
const char* noonmark_scene_message(const noonmark_scene* scene) {
  return scene ? scene->message.c_str() : "there is no scene";
}
void noonmark_scene_free(noonmark_scene* scene) { delete scene; }

void noonmark_frame_init(noonmark_frame* frame, size_t struct_size) {
  if (!frame) return;
  // A program that was compiled with an older header has a smaller struct, one with a newer header a larger one: only the
  // fields that both know are copied.
  noonmark_frame all = defaults();
  all.struct_size = struct_size;
  std::memset(frame, 0, struct_size);
  std::memcpy(frame, &all, std::min(struct_size, sizeof all));
}

noonmark_verdict* noonmark_judge(noonmark_scene* scene, const noonmark_frame* frame) {
  auto* const verdict = new (std::nothrow) noonmark_verdict;
  if (!verdict) return nullptr;
  std::string message;
  guarded(verdict->status, message, [&] {
    if (noonmark_scene_status(scene) != NOONMARK_OK)
      wrong_call(std::string("the scene cannot be used: ") + noonmark_scene_message(scene));
    if (!frame || frame->struct_size < offsetof(noonmark_frame, accept))
      wrong_call("call noonmark_frame_init before the fields are set");
    noonmark_frame all = defaults();
    std::memcpy(&all, frame, std::min(frame->struct_size, sizeof all));
    verdict->verdict = judge_frame(*scene->scene, *scene->tracer, frame_of(all), rules_of(all));
    verdict->judged = true;
    for (const CheckResult& check : verdict->verdict.checks)
      verdict->messages.push_back(std::string(check.name) +
                                  (check.state == CheckState::failed   ? check.accepted ? " (accepted): " : " FAILED: "
                                   : check.state == CheckState::passed ? ": "
                                                                       : " (not checked): ") +
                                  check.says);
    for (const auto& [name, value] : verdict->verdict.metrics) verdict->names.push_back(name);
    if (verdict->verdict.refused()) {
      verdict->status = NOONMARK_BAD_FILE;
      message = "the frame is not what was declared, so its shadows are not judged";
    }
  });
  if (!message.empty())
    guarded(verdict->status, message, [&] { verdict->messages.insert(verdict->messages.begin(), message); });
  return verdict;
}

int noonmark_status(const noonmark_verdict* verdict) { return verdict ? verdict->status : NOONMARK_NO_DEVICE; }

double noonmark_number(const noonmark_verdict* verdict, const char* metric) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (!verdict || !metric || verdict->status != NOONMARK_OK) return none;
  for (const auto& [name, value] : verdict->verdict.metrics)
    if (name == metric) return value;
  return none;
}
const char* noonmark_number_name(const noonmark_verdict* verdict, size_t index) {
  return verdict && index < verdict->names.size() ? verdict->names[index].c_str() : nullptr;
}
const uint8_t* noonmark_classes(const noonmark_verdict* verdict) {
  return verdict && verdict->judged ? reinterpret_cast<const uint8_t*>(verdict->verdict.classes.pixels.data())
                                    : nullptr;
}
const float* noonmark_truth(const noonmark_verdict* verdict) {
  return verdict && verdict->judged ? verdict->verdict.truth.soft.pixels.data() : nullptr;
}
void noonmark_worst_pixel(const noonmark_verdict* verdict, int32_t* x, int32_t* y) {
  const glm::ivec2 worst = verdict && verdict->judged ? verdict->verdict.worst : glm::ivec2(-1);
  if (x) *x = worst.x;
  if (y) *y = worst.y;
}
const char* noonmark_message(const noonmark_verdict* verdict, size_t index) {
  return verdict && index < verdict->messages.size() ? verdict->messages[index].c_str() : nullptr;
}
void noonmark_verdict_free(noonmark_verdict* verdict) { delete verdict; }

}  // extern "C"
