// An engine is a table: one file, which names its numbers, filters, map, cascades and lines. The rows write lines from settings
// (engine_settings.cpp) and read settings from lines (engine_reader.cpp). What is true of one engine alone is a function in its file.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "technique/bias_parts.h"

namespace noonmark {

// How the depth that a part gains on a plane depends on the slope and on the azimuth (law 35). engine_bias.cpp has the formulas;
// polygon_factor is for each texel, polygon_resolution for each least step of the map's format.
enum class BiasForm {
  constant,
  slope,
  normal,
  tangent,
  turned,
  turned_sideways,
  sideways,
  axes,
  polygon_factor,
  polygon_resolution
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

// The filter that an engine has at a place.
struct EngineFilter {
  std::vector<std::string> lines;
  std::string what;  // its kernel, for a sentence
  double reach_texels = 0.5;
  bool same = false;                      // it has the same taps and weights as the recommended one
  double scale = 1;                       // the factor by which the engine multiplies its bias because of this filter
  std::optional<FilterSettings> as = {};  // the filter of Noonmark that has its taps and weights, if there is one
  // Of a lookup in a filtered map: what the engine computes, from numbers of this format. The filter is the engine's blur then.
  std::optional<LookupSettings> lookup = {};
  MomentFormat format = MomentFormat::f32;
  std::string_view cannot = {};  // a sentence
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

std::vector<AdvisedPart> advised_parts(const AdvicePlace& place);  // those that act

// Kinds of light, as bits.
constexpr unsigned light_bit(LightKind kind) { return 1u << static_cast<unsigned>(kind); }
constexpr unsigned directional_light = light_bit(LightKind::directional), spot_light = light_bit(LightKind::spot),
                   point_light = light_bit(LightKind::point), any_light = directional_light | spot_light | point_light;

inline constexpr double no_limit = std::numeric_limits<double>::infinity();

// A number of an engine: a part of its bias, which has a line of its own, or a setting of its map, whose word stands in Engine::lines.
struct EngineKnob {
  std::string_view field;      // "LightShadow.bias"; what a user types is its last word, "bias"
  std::string_view is;         // the setting that it is: "bias.constant"; or two with " + ", which the field sets alike
  std::string_view unit = {};  // of a bias, for people
  // The metres of the bias, or how much of the setting, that one of the field is; null: one. So a line is written by it, and read.
  double (*one)(const AdvicePlace&) = nullptr;
  std::optional<double> preset = {};  // the engine's default; empty: it has none, or none is known
  double least = 0, most = no_limit;  // that the engine takes
  double step = 0;                    // of the field; 0: as many digits as lines have
  int source = 0;                     // the number of its row in Engine::sources, from 1; 0: none
  unsigned lights = any_light;
  std::string_view line = {};  // of a bias: what to type, with {} for the number

  std::string_view word() const;
  double of_one(const AdvicePlace& place) const { return one ? one(place) : 1; }
  bool is_bias() const { return is.starts_with("bias."); }
  std::vector<const BiasPart*> parts() const;
  BiasForm form() const;
  BiasTarget target() const { return parts().front()->acts_on; }
};

// A filter that an engine offers. Of several the one is taken that is the recommended one, otherwise the one whose reach is nearest.
struct EngineFilterRow {
  std::string lines;                          // as Engine::lines; the parameter's word is its number
  std::string_view what;                      // for a sentence
  std::string_view kind = {};                 // the filter of Noonmark that it is; empty: none
  int size = 0;                               // filter.size; 0: of any
  double reach = 1, scale = 1;                // EngineFilter::reach_texels, scale
  std::string_view parameter = {};            // what a user types for it; empty: there is none. `kind` is that of 0
  double reach_of_one = 0, scale_of_one = 0;  // what 1 of it adds to each
  bool only_itself = false;                   // not taken for the nearest
  unsigned lights = any_light;
};

// A lookup of Noonmark in a filtered map that an engine has.
struct EngineLookupRow {
  std::string_view kind;  // lookup.kind
  std::string lines;      // as Engine::lines
  std::string_view what = {};
  std::vector<std::pair<std::string_view, double>> fixed;  // parameters of the lookup that cannot be set
  MomentFormat format = MomentFormat::f32;
  std::string_view cannot = {};                               // a sentence
  void (*blur)(const AdvicePlace&, EngineFilter&) = nullptr;  // its blur; null: the lookup has its own
  void (*read_blur)(const EngineValues& values, Settings& settings) = nullptr;  // the inverse
};

// The map of a directional light that an engine draws.
struct EngineMapRow {
  // Covers the picture's frustum from the camera to reach_m; null: it draws the map that it is given. knob_of("map.resolution") has
  // the greatest size.
  double (*width_m)(const SeenFrustum&, double reach_m) = nullptr;
  int border = 0;                          // texels on both sides together that are not of this width
  std::optional<DepthFormat> format = {};  // empty: as asked
  bool pancake = false;                    // map.pancake
  bool sides_of_materials = false;  // it draws what the materials show, but for sides that Engine::choices can tell
};

// The places at which the advice holds, one for each cascade, the nearest first. Their frames are of the maps that the engine
// lays, with their depths; texel_m is the recommended one.
struct AdvisedCascades {
  std::vector<AdvicePlace> places;
  double near_m = 0;           // the camera's near plane, where the first begins
  std::vector<double> ends_m;  // where each ends along the view, as recommended; the last is the reach
  double blend = 0;            // cascades.blend, if the engine can have it; otherwise 0
  double scene_depth_m = 0;    // of the whole scene, along the light
  Settings laid = {};          // laid_by() of the engine

  size_t count() const { return places.size(); }
  double reach_m() const { return ends_m.back(); }
  const Settings& settings() const { return places.front().settings; }
  // What `of` makes of all ends but the last.
  std::vector<std::string> inner(const std::function<double(double end_m)>& of) const;
};

// How an engine lays cascades.
struct EngineCascades {
  std::vector<int> counts;  // how many it can have
  MapFit fit;
  std::string_view fitted_to;                   // for a sentence: "the sphere about ..."
  double radius_round_m = 0;                    // cascades.radius_round_m
  void (*lay)(Settings&) = nullptr;             // what else of its maps; the settings have manual ends
  std::optional<CascadeBlendOf> blend_of = {};  // how it blends, if evenly and by the depth
  std::optional<double> only_blend = {};        // cascades.blend, if it is fixed in the engine
  std::string_view other_blending = {};         // how it blends otherwise, for a sentence
  std::string_view select = "depth";            // as in cascades.select
  // One line sets "light." of all cascades, with {} for the line of one. Empty: each field is there once.
  std::string_view each = {};
  double (*depth_m)(const AdvisedCascades&) = nullptr;  // from near to far of every map, if the lines set it
  bool bias_of_depth = false;    // its bias is a share of the depth range that each map has in each view, not metres
  std::string_view unlike = {};  // why no settings of Noonmark have the engine's maps, a clause; as limits
};

// A text has one line or sentence in each of its lines; one that ends with \ goes on in the next. "?word " before it: it stands only if the
// word is said; "?!word ": only if it is not. {word} is a word of the engine's (Engine::own), a
// knob's, one that all have (engine_words.cpp), or a setting.
struct EngineText {
  const struct Engine& engine;
  const AdvicePlace& place;
  const AdvisedCascades* cascades = nullptr;
};

struct Engine {
  std::string_view name, version;
  std::string_view comment;  // what begins a comment in the engine's language
  // "@OWNER/NAME COMMIT" of github.com, or the tag of a release, or a branch; then "PATH:LINE TEXT" of each line that was read there, or
  // "PATH TEXT" where the line is not known. Without @: a document.
  std::string_view sources;
  std::vector<EngineKnob> knobs;  // of the bias none for a kind of light: there are no lines
  std::vector<EngineFilterRow> filters = {};
  std::vector<EngineLookupRow> lookups = {};
  std::string_view no_lookup = {};  // what it has in place of other lookups, sentences
  EngineMapRow map = {};
  // What the choices of a setting are in the engine, in the order of the choices: {"map.cull", {"DoubleSide", "FrontSide", "BackSide"}}.
  std::vector<std::pair<std::string_view, std::vector<std::string_view>>> choices = {};
  std::string lines = {};   // then those of filter and bias, and then what stands behind a line "---"
  std::string limits = {};  // sentences that do not depend on the parts of the bias
  std::optional<EngineCascades> cascades = {};
  std::string_view no_cascades = {};                             // without them: why, a sentence
  std::vector<std::pair<std::string_view, double>> always = {};  // parts of a bias that it always adds, as settings
  void (*also)(Settings&, const AdvicePlace&) = nullptr;         // what else it does, as settings
  // Words of its own; empty: it has not this one.
  std::optional<std::string> (*own)(std::string_view word, const EngineText&) = nullptr;
  std::string (*literal)(double) = nullptr;  // a number in its language; null: number()
  // What it says of itself; null: as all others.
  EngineAdvice (*advice)(const Engine&, const AdvicePlace&, const std::vector<AdvisedPart>&, EngineAdvice) = nullptr;

  std::vector<EngineKnob> biases(LightKind kind) const;
  const EngineKnob* knob_of(std::string_view setting) const;                        // null if no field is this setting
  const EngineKnob* knob_of_word(std::string_view word, LightKind kind) const;      // null if there is none
  const std::vector<std::string_view>* choices_of(std::string_view setting) const;  // null if there are none
  CulledFaces culled(const AdvicePlace& place) const;                               // that its map does not draw
};

std::vector<Engine> engines();            // the table
Engine engine_of(std::string_view word);  // of engine_words(); throws std::logic_error

// Without the engine's map and filter.
AdvicePlace advice_place(const Settings& settings, const LightFrame& frame, const Scene& scene);
// The map that the engine draws with this resolution, or from the recommended one on the next power of two whose texels are no
// wider, up to the engine's most; it reaches what is farthest in view, or to map.reach_m.
EngineMap engine_map(const Engine& engine, const AdvicePlace& place, std::optional<int> resolution = {});
EngineFilter as_filter(const EngineFilterRow& row, double parameter, const EngineText& of);
// What the engine computes for the lookup of the settings; empty: it has none.
std::optional<EngineFilter> as_lookup(const Engine& engine, const AdvicePlace& place);
// The map's and the lookup's settings with the numbers that the engine's lines have.
Settings laid_settings(const EngineText& of);

std::vector<EngineSource> sources_of(const Engine& engine);
std::string place_of(const EngineSource& source);  // "PATH:LINE"
// The field that has the form of the part, on the part's own side if there is one on both; null if there is none.
const EngineKnob* knob_for(const std::vector<EngineKnob>& knobs, const AdvisedPart& part);

// The metres of each field, and what of the settings each holds, as a comment.
struct Typed {
  std::vector<double> metres;
  std::vector<std::string> from;
  std::vector<AdvisedPart> replaced;  // parts without a field of their form
  bool suffices = true;
};
Typed typed_amounts(const Engine& engine, const AdvicePlace& place, const std::vector<EngineKnob>& knobs,
                    const std::vector<AdvisedPart>& parts);

// The metres that each bias gives in each map with the number that is typed: [bias][map], as AdvisedPart::amount.
using ActingMetres = std::vector<std::vector<double>>;
// Sets advice.emulated, or why_not_emulated. of.place.filter and of.place.map: of the engine.
void emulate(const EngineText& of, const std::vector<EngineKnob>& knobs, const ActingMetres& metres,
             EngineAdvice& advice);

// The sentences that say what an engine cannot express of the settings, or expresses otherwise, and what to do instead.
// Why there are no lines: no one and no two fields of the engine can replace these parts, or the reference.
std::string unexpressed_bias(const std::vector<AdvisedPart>& parts, const AdvicePlace& place);
// knob: the field that takes the part; null if the engine has no field of its form. replaced: other fields hold it then.
std::vector<std::string> unexpressed_part(const AdvisedPart& part, const EngineKnob* knob, bool replaced);
std::string unexpressed_reference(const AdvicePlace& place, bool replaced);
std::string unexpressed_filter(const AdvicePlace& place);
std::vector<std::string> unexpressed_lookup(const AdvicePlace& place);
// expressed: further settings of the map that the engine expresses, beside resolution, format and volume.
std::vector<std::string> unexpressed_map(const AdvicePlace& place, const std::vector<std::string_view>& expressed);
std::string unexpressed_distance(const AdvicePlace& place);

// The lambda from 0 to 1 of practical splits whose ends are nearest to these, by least squares.
double nearest_lambda(double near_m, std::span<const double> ends_m);

// Which of the recommended ends a lambda misses, as a sentence; empty if it is right to a thousandth.
std::string missed_ends(const AdvisedCascades& cascades, double lambda);

// The settings with the maps that the engine lays for these ends.
Settings laid_by(const Engine& engine, Settings settings, double near_m, std::span<const double> ends_m);

// cascades.blend, if the engine can blend so, evenly; otherwise 0.
double blend_in(const EngineCascades& engine, const CascadeSettings& asked);

// Of what the engine does otherwise when it chooses, blends and fits cascades, and how wide their texels are.
std::vector<std::string> unexpressed_cascades(const Engine& engine, const AdvisedCascades& cascades);

// Of a field that is there once: what its greatest number is too much by in the cascade that needs least. Empty if all need
// the same. typed: of each cascade.
std::string one_for_all(std::string_view field, std::span<const double> typed);

// Widths of maps that several engines have: the sphere about the mean of the frustum's corners.
double mean_sphere_m(const SeenFrustum& seen, double far_m);

// The lines or sentences of a text.
std::vector<std::string> text_lines(std::string_view text, const EngineText& of);
// Each line of a text, whole, with its conditions and words.
std::vector<std::string> rows_of(std::string_view text);
// Whether a line is one that such a row writes, with any words. If it is, they are added to the values; {} has the word "".
bool read_line(const Engine& engine, std::string row, std::string_view line, EngineValues& values);

// The number with 6 significant digits, as the engines' languages read it.
std::string number(double value);
std::string place_name(BiasTarget target);
bool filter_is(const AdvicePlace& place, std::string_view kind, int size = 0);  // size 0: any
std::string no_lines_for_lookup(const std::string& lookup_kind, std::string_view of_engine);

}  // namespace noonmark
