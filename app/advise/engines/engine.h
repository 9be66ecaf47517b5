// What the files of engines share. A file gives the fields of its engine; engine_settings.cpp turns the settings into
// numbers for them.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "technique/bias_parts.h"

namespace noonmark {

// How the depth that a part gains on a plane depends on the slope theta and on the azimuth phi (law 35). c, s and t are
// the cosine, sine and tangent of theta; A = |cos phi| + |sin phi|.
enum class BiasForm {
  constant,           // 1
  slope,              // 1 - c
  normal,             // 1 / c: along the normal
  tangent,            // t: along the normal by the sine, or a depth by the tangent
  turned,             // (1 - c) / c: along the normal by 1 - N.L
  turned_sideways,    // (1 - c) s t: `turned` without its component along the light
  sideways,           // s t: `normal` without its component along the light
  axes,               // A t
  polygon_factor,     // max(|cos phi|, |sin phi|) t, for each texel
  polygon_resolution  // 1, for each least step of the map's format
};

// Throws std::logic_error if the part has no form yet.
BiasForm form_of(const BiasPart& part);

// The depth that one metre of the form gains at this slope and azimuth; for polygon_factor one texel, and for
// polygon_resolution one step. theta_rad: 0 to less than pi / 2. phi_rad: 0 is along a texel's axis (A = 1).
double gain(BiasForm form, double theta_rad, double phi_rad = 0);

// A part of the bias that acts, in metres at the place of the advice; a polygon offset has no unit.
struct AdvisedPart {
  const BiasPart* part;
  BiasForm form;
  double amount = 0;          // metres
  double set = 0;             // as in the settings
  double floor = 0, cap = 0;  // metres; cap: infinity without a cap
  // Along the light, on a plane; needs `step_m` for a polygon offset.
  double depth_m(double theta_rad, double phi_rad = 0) const;
  double step_m = 1;  // metres of one texel or of one step of the format
};

// The filter of an engine that is nearest to the recommended one.
struct EngineFilter {
  std::vector<std::string> lines;
  std::string what;  // its kernel, for a sentence
  double reach_texels = 0.5;
  bool same = false;                      // it has the same taps and weights
  double scale = 1;                       // the factor by which the engine multiplies its bias because of this filter
  std::optional<FilterSettings> as = {};  // the filter of Noonmark that has its taps and weights, if there is one
  // Of a lookup in a filtered map, which the lines choose too: what the engine computes, from numbers of this format. The filter
  // is the engine's blur then.
  std::optional<LookupSettings> lookup = {};
  MomentFormat format = MomentFormat::f32;
  std::vector<std::string> cannot = {};  // sentences
};

// The map that the engine draws.
struct EngineMap {
  int resolution = 0;
  double extent_m = 0;                 // directional: of all its texels
  double texel_m = 0;                  // at the place of the advice
  std::optional<double> reach_m = {};  // if the engine fits it to the picture's frustum: from the camera to here
  bool coarser = false;                // not even the engine's largest map has the recommended texels
};

// The picture's frustum, to which many engines fit their map.
struct SeenFrustum {
  bool perspective = true;
  double half_diagonal = 0;  // of the picture: perspective: a tangent; orthographic: metres
  double farthest_m = 0;     // along the view, of what is in view
  double half_at(double z_m) const { return perspective ? half_diagonal * z_m : half_diagonal; }
};

// The recommendation at one place of the light, in double, because the settings are double.
struct AdvicePlace {
  const Settings& settings;
  const LightFrame& frame;
  double distance_m = 0;                   // spot and point: along the axis of the map's tile
  double texel_m = 0;                      // of the map there
  double depth_slope = 0;                  // window depth for each metre there
  double cone_tan = 1;                     // spot: tangent of half the light's cone
  double reach_texels = 0;                 // of the recommended filter
  CulledFaces unseen = CulledFaces::none;  // the faces that the scene's materials do not show: back, or none
  EngineFilter filter = {};                // of the engine
  EngineMap map = {};                      // of the engine
  SeenFrustum seen = {};

  LightKind kind() const { return frame.kind; }
  double range_m() const { return frame.far_m - frame.near_m; }
  // The window depth for each metre of a perspective map with this near and far, along the axis.
  double perspective_slope(double near_m, double far_m) const;
};

// A number of an engine that is a part of the bias.
struct EngineKnob {
  std::string field;  // "LightShadow.bias"
  std::string line;   // what to type, with {} for the number
  BiasForm form;
  BiasTarget target;
  std::string unit;                                                // for people
  std::function<double(double metres, const AdvicePlace&)> typed;  // in proportion to the metres
  double most = std::numeric_limits<double>::infinity();           // that the engine takes
};

struct AdvisedCascades;

// How an engine lays cascades (app/advise/engines/engine_cascades.h).
struct EngineCascades {
  std::vector<int> counts;  // how many it can have
  std::string fit;          // what it fits each map to, for a sentence: "the sphere about ..."
  // The engine's maps as settings of Noonmark: map.fit and what it reads. The settings have manual ends.
  void (*lay)(Settings&);
  std::vector<std::string> (*lines)(const AdvisedCascades&);   // in place of map_lines()
  std::vector<std::string> (*limits)(const AdvisedCascades&);  // in place of limits()
  std::optional<CascadeBlendOf> blend_of = {};                 // how it blends, if evenly and by the depth
  std::optional<double> only_blend = {};                       // cascades.blend, if it is fixed in the engine
  std::string other_blending = {};                             // how it blends otherwise, for a sentence
  std::string select = "depth";                                // as in cascades.select
  // Fields that begin so are there once for each cascade: one line sets them all, with {} for the line of one. Empty: every
  // field is there once.
  std::string each_begins = {}, each = {};
  // The metres from near to far of every map, if the lines set them; null: those of `lay`.
  double (*depth_m)(const AdvisedCascades&) = nullptr;
  // Its bias is a share of the depth range that each map has in each view, not metres.
  bool bias_of_depth = false;
  // Why no settings of Noonmark have the engine's maps, a clause; empty, or null: they have.
  std::string (*unlike)(const AdvisedCascades&) = nullptr;
};

struct Engine {
  std::string name, version;
  std::vector<EngineSource> sources;
  std::string comment;                          // what begins a comment in the engine's language
  std::vector<EngineKnob> (*knobs)(LightKind);  // none: there are no lines for this kind of light
  EngineFilter (*filter)(const AdvicePlace&);
  std::vector<std::string> (*map_lines)(const AdvicePlace&);
  std::vector<std::string> (*limits)(const AdvicePlace&);  // sentences that do not depend on the parts of the bias
  std::vector<std::string_view> maps;  // further settings of the map that map_lines() expresses: "map.cull"
  // What the engine makes of the map's size and place; null: it draws the map that it is given.
  EngineMap (*fit)(const AdvicePlace&) = nullptr;
  // Parts of the bias that the engine always adds, as settings: {"polygon_factor", 2.5}.
  std::vector<std::pair<std::string_view, double>> always = {};
  // Further settings that describe what the engine always does; null: none.
  void (*emulate)(Settings&, const AdvicePlace&) = nullptr;
  std::vector<std::string> last = {};  // lines that stand after all others
  std::optional<EngineCascades> cascades = {};
  std::string no_cascades = {};              // without lines for cascades: why, a sentence
  std::string (*literal)(double) = nullptr;  // a number as the engine's language takes it; null: number()
  // How the engine makes the lookup of place.settings in a filtered map. The result is empty if the engine has no such lookup; then
  // no_filtered says what it has. The function is null if the engine has no filtered map that Noonmark knows.
  std::optional<EngineFilter> (*filtered)(const AdvicePlace&) = nullptr;
  std::string no_filtered = {};  // sentences
};

// The map of an engine that fits a square of diameter_m(seen, reach_m, resolution) to the picture's frustum from the camera
// to what is farthest in view, or to map.reach_m: the recommended resolution or the next powers of two, up to `most`, until
// its texels are no wider than the recommended ones. For a directional light.
EngineMap fitted_to_view(const AdvicePlace& place, double (*diameter_m)(const SeenFrustum&, double, int), int most);

Engine three_js();
Engine babylon_js();
Engine playcanvas();
Engine godot();
Engine bevy();
Engine filament();
Engine unity_urp();

// A comment that stands below the first one: what of the light the lines set ("direction"), and where the model must stand.
std::string placed_comment(std::string_view of_light);
// What the lines of an engine with lights of any place set.
std::string_view placed_of_light(const AdvicePlace& place);

// What to know of a map that fitted_to_view() describes. field: which sets how far it reaches.
std::string fitted_text(const AdvicePlace& place, const std::string& field);

// Why an engine has no lines for a lookup in a filtered map. of_engine: Engine::no_filtered.
std::string no_lines_for_lookup(const std::string& lookup_kind, const std::string& of_engine);

// OpenGL has no fields: the application's shader computes each part. So it has no knobs.
EngineAdvice opengl_cascades();
EngineAdvice opengl_advice(const AdvicePlace& place, const std::vector<AdvisedPart>& parts);
std::vector<EngineField> opengl_fields();

// The number with 6 significant digits, as the engines' languages read it.
std::string number(double value);
std::string numbers(glm::dvec3 values);  // "1, 2, 3"
std::string place_name(BiasTarget target);
// The filter whose reach is nearest to the recommended one. None may be the same: then `same` is false.
EngineFilter nearest_reach(const AdvicePlace& place, std::vector<EngineFilter> offered);
bool filter_is(const AdvicePlace& place, std::string_view kind, int size = 0);  // size 0: any

}  // namespace noonmark
