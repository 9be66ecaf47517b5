// technique/: what is judged, as plain data and arithmetic that the shaders and the host share: settings, biases, filters,
// the light's frame, and what gl and raytrace hand to compare. May include base and scenes. Draws nothing and traces
// nothing. Begin here, then technique/technique.h (a point's settings, resolved once).
//
// Every setting of a measurement. A setting is a struct member with a default here and one row in the table of
// settings.cpp: name, unit, range, help, the stages that read it, when it is idle, and the settings that it conflicts
// with. The command line, the experiment file, the sweep, the result store and the report all read that row. To add a
// setting, add one member here and one row there.
//
//   Settings s;
//   find_setting("map.resolution").set(s, "2048");       // throws Error(usage) naming the range
//   for (const Setting& row : settings_table()) print(row.name, row.get(s));
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/number_ranges.h"
#include "scenes/scene_settings.h"
#include "technique/bias_parts.h"
#include "technique/kind_parameters.h"

namespace noonmark {

enum class DepthFormat { d16, d24, d32f };
// The format of each number of a map of moments. f16 and f32 are floats, u16 is an integer of 16 bits for [0, 1].
enum class MomentFormat { f32, f16, u16 };
enum class Wrap { repeat, clamp_to_edge, clamp_to_border };
enum class CulledFaces { none, back, front };
enum class MapFit { scene, tight, view, sphere, casters, corner_sphere, corner_square, corner_box };
enum class DepthRange { fit, scene };
enum class CubePass { layered, six_passes };
enum class BiasUnit { depth, m, texel };
enum class OffsetUnit { texel, m };
enum class LightChoice { automatic, directional, spot, point };

struct LightSettings {  // automatic and empty: as the scene's light
  std::string name =
      "auto";                // of the scene's lights (technique/chosen_light.h); auto: by index or kind, else the first
  std::optional<int> index;  // of the scene's lights, from 0
  LightChoice kind = LightChoice::automatic;
  std::optional<glm::dvec3> position_m;
  std::optional<glm::dvec3> target_m;
  // directional: where the sun stands, seen from the scene (technique/sun.h); empty: as the rest says
  std::optional<double> azimuth_deg;
  std::optional<double> elevation_deg;
  std::optional<double> angular_diameter_deg;
  std::optional<double> radius_m;
  LightShape shape = LightShape::sphere;
  std::optional<double> cone_deg;
};

// To the corners of the part of the view's frustum that it covers, as engines do (technique/corner_fits.h).
inline bool fits_corners(MapFit fit) {
  return fit == MapFit::corner_sphere || fit == MapFit::corner_square || fit == MapFit::corner_box;
}

// Whether the map covers what the camera sees, and so depends on it.
inline bool fits_view(MapFit fit) { return fit == MapFit::view || fit == MapFit::sphere || fits_corners(fit); }

// Whether the fit also moves the map off the light's axis, as only a directional light's can be.
inline bool moves_map(MapFit fit) { return fits_view(fit) || fit == MapFit::casters; }

struct MapSettings {
  int resolution = 1024;             // texels along its width
  std::optional<double> aspect = 1;  // directional: width over height, in texels; empty: of what the fit holds
  DepthFormat format = DepthFormat::d24;
  MapFit fit = MapFit::scene;  // the source of empty extent, near and far: the scene's own values, or a fit
  std::optional<double>
      reach_m;  // sphere, corner_*: how far from the camera there are shadows; empty: the scene's diagonal
  std::optional<double> fit_fov_deg;  // sphere, corner_*: fitted to a picture of at least this vertical angle
  DepthRange depth_range =
      DepthRange::fit;                 // directional: empty near and far are those of `fit`, or of the whole scene
  std::optional<double> extent_m;      // directional: whole width; empty: from `fit`
  double extent_scale = 1;             // multiplies the extent, from whichever source it is
  std::optional<double> fov_deg;       // spot: whole angle of the map; empty: the light's cone
  std::optional<double> roll_deg = 0;  // directional, spot: of the map about the light's axis; empty: the least extent
  bool snap = false;                   // directional: the grid stays fixed in the world when the map moves over it
  double shift_u_texels = 0;           // moves the whole grid in the light's plane: along `right` ...
  double shift_v_texels = 0;           // ... and along `up`
  int placements = 1;                  // S: measured at S x S placements of the grid (technique/placements.h)
  std::optional<double> near_m;        // along the light's axis from its position; empty: the scene's own, or fitted
  std::optional<double> far_m;
  Wrap wrap = Wrap::clamp_to_border;  // the depth of the border is 1, which is lit
  bool lit_beyond_far = true;
  CulledFaces cull = CulledFaces::none;
  bool depth_clamp = false;  // geometry before near or beyond far is kept, at depth 0 or 1, instead of clipped
  MomentFormat moments = MomentFormat::f32;  // of a lookup in a map of moments
  bool pancake = false;  // directional: vertices before the near plane are moved onto it; depths are clamped too
  CubePass cube_pass = CubePass::layered;  // point: the method to draw the six faces; the map is the same
  std::optional<glm::dvec3> turn_deg;      // point: rotates the cube; axis times angle; empty: along the world's axes

  // Whether what lies before near or beyond far is kept. With pancake it must be: rounding leaves some of the moved
  // vertices just before the near plane.
  bool keeps_clipped() const { return depth_clamp || pancake; }
  // Texels along its height. With aspect auto this is the most that a fit gives it; LightFrame::rows says how many.
  int rows() const { return aspect ? static_cast<int>(std::max(1.0, std::round(resolution / *aspect))) : resolution; }
};

// Cascades: the map of a directional light as several maps, each for a slice of the view's depth (technique/cascades.h).
// Of what cascades.blend is a share: of the slice's depth, of the depth of its end, or of that depth's square over the way
// from near to the reach.
enum class CascadeBlendOf { slice, end, square };
// Between which depths the slices lie: the camera's planes, or what the picture's pixels show.
enum class CascadeDepths { planes, visible };

struct CascadeSettings {
  int count = 1;                     // 1: one map for all of the view
  std::string splits = "practical";  // the name of one of cascade_splits() (technique/cascade_splits.h)
  double lambda = 0.5;               // practical: 0 even, 1 logarithmic
  double exponent = 3;               // exponent: how much deeper each slice is than the one before
  std::optional<double> first_m;     // first_bound: the end of the first slice
  std::vector<double> bounds_m;      // manual: the ends of all slices but the last, ascending; empty: not given
  std::string select = "depth";      // the name of one of cascade_selections() (technique/cascade_selections.h)
  double blend = 0;                  // the part of a cascade in which the next one is blended in
  CascadeBlendOf blend_of = CascadeBlendOf::slice;
  std::string blend_shape = "linear";  // the name of one of cascade_blends() (technique/cascade_blends.h)
  CascadeDepths depths = CascadeDepths::planes;
  bool cover_band = true;           // the next cascade's map holds that part too
  std::vector<double> resolutions;  // whole texels, one number for each cascade; empty: map.resolution
  std::vector<double> bias_scales;  // of the compared depth\'s bias, one number for each cascade; empty: all 1
  double radius_round_m =
      0;  // map.fit = sphere, corner_*: the radius is rounded up to a multiple of it; 0: not rounded
};
inline constexpr int most_cascades = 8;

// A bias is the sum of its parts (technique/bias_parts.h). Each part is 0 unless it is set.
struct BiasSettings {
  BiasUnit unit = BiasUnit::depth;             // the unit of the parts whose own unit is "bias.unit"
  OffsetUnit offset_unit = OffsetUnit::texel;  // the same of those whose unit is "bias.offset_unit"
  std::string reference = "own_depth";         // the name of one of tap_references()
  std::optional<double> plane_cap = {};        // in bias.unit; empty: no cap

  // A parameter of a part: its amount ("slope"), floor ("slope_floor") or cap ("tan_cap"; infinity means no cap).
  double& operator[](std::string_view parameter) { return values_[bias_parameter_index(parameter)]; }
  double operator[](std::string_view parameter) const { return values_[bias_parameter_index(parameter)]; }

 private:
  static std::vector<double> no_bias();
  std::vector<double> values_ = no_bias();  // in the order of bias_parameters()
};

// Of one of filters() (technique/filters.h).
struct FilterTable {
  static constexpr std::string_view first = "none";
  static std::span<const KindParameter* const> parameters();
};
struct FilterSettings : KindSettings<FilterTable> {
  using KindSettings::KindSettings;
};

// Of one of lookups() (technique/lookups.h): how the lookup answers from what it reads.
struct LookupTable {
  static constexpr std::string_view first = "compare";
  static std::span<const KindParameter* const> parameters();
};
struct LookupSettings : KindSettings<LookupTable> {
  using KindSettings::KindSettings;
};

// Which frame of another renderer a point judges. Only [[frame]] of an experiment gives it.
struct GivenSettings {
  std::string frame = "none";
};

// How the truth is found. The verdicts are the same.
enum class TruthMethod : uint8_t {
  automatic,  // what is certain without a ray, scan conversion of flat maps, and rays for the rest
  rays        // rays for everything
};

struct TruthSettings {
  double standard_error = 0.01;  // standard error of R0 at each receiver, for a light with a size
  TruthMethod method = TruthMethod::automatic;
};

struct Settings {
  SceneSettings scene;
  ViewSettings view;
  LightSettings light;
  MapSettings map;
  CascadeSettings cascades;
  int maps() const { return cascades.count; }  // of a point: its receivers are looked up in one of them, or in two
  BiasSettings bias;
  FilterSettings filter;
  LookupSettings lookup;
  TruthSettings truth;
  GivenSettings given;
};

// The stages of a measurement (measure/stages.h), in their order.
enum class Stage : uint8_t { scene = 1, view = 2, truth = 4, map = 8, lookup = 16, ladder = 32 };

struct Stages {
  uint8_t bits = 0;
  constexpr Stages(std::initializer_list<Stage> stages = {}) {
    for (Stage stage : stages) bits = static_cast<uint8_t>(bits | static_cast<uint8_t>(stage));
  }
  constexpr bool has(Stage stage) const { return (bits & static_cast<uint8_t>(stage)) != 0; }
};

// One row of the table. A value is stored as text in one canonical form: "auto" for an empty optional or list, "x,y,z" for a
// point, "5,15,50" for a list, the shortest decimal that reads back as the same double. So the same value always has the same key in the
// store.
struct Setting {
  std::string_view name;  // "map.resolution"
  std::string_view unit;  // "texels", "m", "deg", "" ...
  ValueType type;
  double min = 0, max = 0;                // integer, real, and each number of a point or a list: inclusive limits
  bool may_be_auto = false;               // "auto" is a value
  std::vector<std::string_view> choices;  // choice
  std::string help;                       // one sentence
  std::function<std::string(const Settings&)> get;
  std::function<void(Settings&, std::string_view)> set;  // throws Error(usage): what, range

  // The stages that read it. The results of these stages are kept while the value stays the same.
  Stages read_by = {};
  // The reason why it is not read at this point ("on a point light"). Empty text: it is read. Empty function: it is
  // always read.
  std::function<std::string(const Settings&, LightKind)> why_idle = {};
  // The reason why it conflicts with other settings (technique/setting_rules.h). Empty text: no conflict. Empty
  // function: it never conflicts.
  std::function<std::string(const Settings&, std::optional<LightKind>)> why_refused = {};

  // For the rows of the table.
  Setting idle(std::function<std::string(const Settings&, LightKind)> why) const;
  Setting refused(std::function<std::string(const Settings&, std::optional<LightKind>)> why) const;
  Setting only_read_by(Stages stages) const;

  NumberRange range() const { return {min, max}; }

  // True if a value is several numbers: an experiment file may give them as an array.
  bool is_of_numbers() const {
    return type == ValueType::point || type == ValueType::list || type == ValueType::whole_list ||
           type == ValueType::real_list;
  }

  std::string range_text() const;       // "1 ... 170 or auto", "16 | 24 | 32f" ...
  std::string range_with_unit() const;  // "1 ... 170 deg, or auto"

 private:
  std::string bare_range() const;
};

std::span<const Setting> settings_table();

// Every setting by its row's name, in canonical text: PointRecord::settings.
std::map<std::string, std::string> settings_map(const Settings& settings);

// Throws Error(usage) that suggests the nearest name.
const Setting& find_setting(std::string_view name);

}  // namespace noonmark
