#include "scenes/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "scenes/error.h"

namespace noonmark {
namespace {

template <class T>
std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const Setting& row, std::string_view text) {
  throw Error(ErrorKind::usage,
              fmt::format("{} = '{}' is not allowed; it takes {}", row.name, text, row.range_with_unit()));
}

// The shortest decimal that reads back as the same double. -0 becomes 0, so that equal values have equal keys.
std::string number_text(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

double parse_real(const Setting& row, std::string_view text) {
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !std::isfinite(*value) || *value < row.min || *value > row.max) refuse(row, text);
  return *value;
}

glm::dvec3 parse_point(const Setting& row, std::string_view text) {
  glm::dvec3 point;
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (axis == 2)) refuse(row, text);
    std::string_view part = rest.substr(0, comma);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    const std::optional<double> value = parse_number<double>(part);
    if (!value || !std::isfinite(*value)) refuse(row, text);
    point[axis] = *value;
    if (axis < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

std::string point_text(glm::dvec3 p) {
  return fmt::format("{},{},{}", number_text(p.x), number_text(p.y), number_text(p.z));
}

// The rows below are built by these five, one for each kind of member. `member` maps Settings& to a reference.

template <class Member>
Setting integer(std::string_view name, std::string_view unit, double min, double max, std::string_view help,
                Member member) {
  Setting row{name, unit, ValueType::integer, min, max, false, {}, help, {}, {}};
  row.get = [member](const Settings& s) { return fmt::format("{}", member(const_cast<Settings&>(s))); };
  row.set = [member, row](Settings& s, std::string_view text) {
    const std::optional<int> value = parse_number<int>(text);
    if (!value || *value < row.min || *value > row.max) refuse(row, text);
    member(s) = *value;
  };
  return row;
}

template <class Member>
Setting real(std::string_view name, std::string_view unit, double min, double max, std::string_view help,
             Member member) {
  constexpr bool is_optional = std::is_same_v<std::invoke_result_t<Member, Settings&>, std::optional<double>&>;
  Setting row{name, unit, ValueType::real, min, max, is_optional, {}, help, {}, {}};
  row.get = [member](const Settings& s) {
    const auto& value = member(const_cast<Settings&>(s));
    if constexpr (is_optional)
      return value ? number_text(*value) : std::string("auto");
    else
      return number_text(value);
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if constexpr (is_optional) {
      if (text == "auto") {
        member(s).reset();
        return;
      }
    }
    member(s) = parse_real(row, text);
  };
  return row;
}

template <class Member>
Setting point(std::string_view name, std::string_view help, Member member) {
  Setting row{name, "m", ValueType::point, 0, 0, true, {}, help, {}, {}};
  row.get = [member](const Settings& s) {
    const auto& value = member(const_cast<Settings&>(s));
    return value ? point_text(*value) : std::string("auto");
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if (text == "auto")
      member(s).reset();
    else
      member(s) = parse_point(row, text);
  };
  return row;
}

template <class Member>
Setting flag(std::string_view name, std::string_view help, Member member) {
  Setting row{name, "", ValueType::flag, 0, 0, false, {}, help, {}, {}};
  row.get = [member](const Settings& s) { return std::string(member(const_cast<Settings&>(s)) ? "true" : "false"); };
  row.set = [member, row](Settings& s, std::string_view text) {
    if (text != "true" && text != "false") refuse(row, text);
    member(s) = text == "true";
  };
  return row;
}

// choices: in the order of the enumerators.
template <class Member>
Setting choice(std::string_view name, std::vector<std::string_view> choices, std::string_view help, Member member) {
  Setting row{name, "", ValueType::choice, 0, 0, false, choices, help, {}, {}};
  row.get = [member, choices](const Settings& s) {
    return std::string(choices[static_cast<size_t>(member(const_cast<Settings&>(s)))]);
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    const auto found = std::find(row.choices.begin(), row.choices.end(), text);
    if (found == row.choices.end()) refuse(row, text);
    using Enum = std::remove_reference_t<std::invoke_result_t<Member, Settings&>>;
    member(s) = static_cast<Enum>(found - row.choices.begin());
  };
  return row;
}

template <class Member>
Setting text(std::string_view name, std::string_view help, Member member) {
  Setting row{name, "", ValueType::text, 0, 0, false, {}, help, {}, {}};
  row.get = [member](const Settings& s) { return member(const_cast<Settings&>(s)); };
  row.set = [member, row](Settings& s, std::string_view value) {
    if (value.empty()) refuse(row, value);
    member(s) = std::string(value);
  };
  return row;
}

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

std::vector<Setting> make_table() {
  return {
      text("scene.name", "A built-in scene, or the path of a .gltf or .glb file.", MEMBER(scene.name)),
      real("scene.theta_deg", "deg", 0, 89.9, "plane: the angle between its normal and the light.",
           MEMBER(scene.theta_deg)),
      real("scene.phi_deg", "deg", -360, 360,
           "plane: azimuth of its slope in the light's plane, against the texel axes; plate: its turn about the "
           "vertical.",
           MEMBER(scene.phi_deg)),
      real("scene.thickness_m", "m", 1e-4, 10, "wall, plate: thickness.", MEMBER(scene.thickness_m)),
      real("scene.height_m", "m", 0, 100, "plate: height of its lit face above the floor.", MEMBER(scene.height_m)),
      choice("scene.mesh", {"as_built", "one_mesh", "split", "reversed", "doubled"},
             "The scene's surface as built, or in other triangles: welded into one mesh, each triangle cut in four, "
             "triangles and vertices in reverse order, each triangle there twice.",
             MEMBER(scene.mesh)),
      integer("view.width_px", "px", 1, 8192, "Width of the picture.", MEMBER(view.width_px)),
      integer("view.height_px", "px", 1, 8192, "Height of the picture.", MEMBER(view.height_px)),
      point("view.eye_m", "Where the camera is; auto: the scene's.", MEMBER(view.eye_m)),
      point("view.target_m", "What the camera looks at; auto: the scene's.", MEMBER(view.target_m)),
      real("view.fov_deg", "deg", 1, 170, "Whole vertical angle of view; auto: the scene's.", MEMBER(view.fov_deg)),
      point("light.position_m", "Where the light's map measures depth from; auto: the scene's.",
            MEMBER(light.position_m)),
      point("light.target_m", "What the light points at, the middle of its map; auto: the scene's.",
            MEMBER(light.target_m)),
      real("light.angular_diameter_deg", "deg", 0, 90,
           "Of a sun with a size, for R0 (the real sun: 0.53); auto: the scene's.", MEMBER(light.angular_diameter_deg)),
      integer("map.resolution", "texels", 1, 16384, "Texels on a side of the shadow map.", MEMBER(map.resolution)),
      choice("map.format", {"16", "24", "32f"}, "Depth format of the shadow map.", MEMBER(map.format)),
      real("map.extent_m", "m", 1e-6, 1e9, "Whole width of what the map covers; auto: the scene's, or fitted tightly.",
           MEMBER(map.extent_m)),
      real("map.extent_scale", "", 1e-3, 1e3, "Multiplies the extent, however it came about.",
           MEMBER(map.extent_scale)),
      real("map.shift_u_texels", "texels", -1, 1,
           "Moves the map and its grid to the light's right: another alignment of texels and edges.",
           MEMBER(map.shift_u_texels)),
      real("map.shift_v_texels", "texels", -1, 1, "Moves the map and its grid up, as the light sees it.",
           MEMBER(map.shift_v_texels)),
      real("map.near_m", "m", -1e9, 1e9,
           "Near plane along the light's axis from its position; auto: the scene's, or fitted.", MEMBER(map.near_m)),
      real("map.far_m", "m", -1e9, 1e9,
           "Far plane along the light's axis from its position; auto: the scene's, or fitted.", MEMBER(map.far_m)),
      choice("map.wrap", {"repeat", "clamp_to_edge", "clamp_to_border"},
             "What a lookup outside the map finds; the border is lit.", MEMBER(map.wrap)),
      flag("map.lit_beyond_far", "Receivers beyond the far plane are lit without a comparison.",
           MEMBER(map.lit_beyond_far)),
      choice("map.cull", {"none", "back", "front"}, "Faces left out of the shadow map.", MEMBER(map.cull)),
      choice("bias.form", {"none", "constant", "slope", "normal_offset"},
             "none; constant; slope: max(bias.slope * (1 - N.L), bias.floor); normal_offset: the receiver is looked up "
             "bias.normal_offset along its normal.",
             MEMBER(bias.form)),
      choice("bias.unit", {"depth", "m", "texel"},
             "Unit of bias.constant, bias.slope and bias.floor: window depth, metres along the light's axis, or texels "
             "of the map.",
             MEMBER(bias.unit)),
      real("bias.constant", "bias.unit", 0, 1e6, "The constant form's bias.", MEMBER(bias.constant)),
      real("bias.slope", "bias.unit", 0, 1e6, "The slope form's factor of (1 - N.L).", MEMBER(bias.slope)),
      real("bias.floor", "bias.unit", 0, 1e6, "The slope form's least bias.", MEMBER(bias.floor)),
      real("bias.normal_offset", "texels", 0, 1e6,
           "How far the normal_offset form moves a receiver along its normal before it is looked up; times texel_m, in "
           "metres. It has no one-pass bias curve: sweep it.",
           MEMBER(bias.normal_offset)),
      choice("filter.kind", {"none", "box"}, "none: one nearest tap; box: the mean of N x N nearest taps.",
             MEMBER(filter.kind)),
      integer("filter.size", "texels", 1, 31, "box: taps on a side, odd.", MEMBER(filter.size)),
      real("truth.standard_error", "", 1e-3, 0.5,
           "Largest standard error of R0 at a receiver, for a light with a size.", MEMBER(truth.standard_error)),
  };
}

#undef MEMBER

// Levenshtein distance, one row at a time.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

int kernel_size(const FilterSettings& filter) { return filter.kind == FilterKind::box ? filter.size : 1; }

std::string Setting::range_text() const { return may_be_auto ? bare_range() + " or auto" : bare_range(); }

std::string Setting::range_with_unit() const {
  std::string range = bare_range();
  if (!unit.empty()) range += fmt::format(" {}", unit);
  return may_be_auto ? range + ", or auto" : range;
}

std::string Setting::bare_range() const {
  switch (type) {
    case ValueType::integer:
    case ValueType::real:
      return fmt::format("{:g} ... {:g}", min, max);
    case ValueType::flag:
      return "true | false";
    case ValueType::choice:
      return fmt::format("{}", fmt::join(choices, " | "));
    case ValueType::text:
      return "a name or a path";
    case ValueType::point:
      return "x,y,z";
  }
  throw std::logic_error("unknown value type");
}

std::span<const Setting> settings_table() {
  static const std::vector<Setting> table = make_table();
  return table;
}

const Setting& find_setting(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Setting& row : settings_table()) {
    if (row.name == name) return row;
    names.push_back(row.name);
  }
  const std::string near = nearest_name(name, names);
  throw Error(ErrorKind::usage, fmt::format("there is no setting '{}'{} (noonmark settings lists them)", name,
                                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

void validate(const Settings& s) {
  if (s.filter.size % 2 == 0)
    throw Error(ErrorKind::usage,
                fmt::format("filter.size = {} is even; a box has an odd number of taps on a side, so that "
                            "one is at the receiver",
                            s.filter.size));
  if (s.map.near_m && s.map.far_m && *s.map.near_m >= *s.map.far_m)
    throw Error(ErrorKind::usage,
                fmt::format("map.near_m = {} is not less than map.far_m = {}", *s.map.near_m, *s.map.far_m));
}

std::string nearest_name(std::string_view wrong, std::span<const std::string_view> names) {
  std::string_view best;
  size_t best_distance = std::max<size_t>(2, wrong.size() / 3) + 1;
  for (std::string_view name : names) {
    size_t distance = edit_distance(wrong, name);
    // "resolution" is meant as "map.resolution".
    if (name.size() > wrong.size() + 1 && name.ends_with(wrong) && name[name.size() - wrong.size() - 1] == '.')
      distance = 0;
    // "bias.const" is meant as "bias.constant", not as "bias.unit", though that is as few letters away.
    if (2 * wrong.size() > name.size() && name.starts_with(wrong)) distance = std::min<size_t>(distance, 1);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  }
  return std::string(best);
}

}  // namespace noonmark
