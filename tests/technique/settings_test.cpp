// The table of settings: each value has one canonical text, and text that is no value is refused.
#include "technique/settings.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "technique/filters.h"
#include "technique/setting_rules.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string text_after(const Setting& row, std::string_view given) {
  Settings settings;
  row.set(settings, given);
  return row.get(settings);
}
std::string text_after(std::string_view name, std::string_view given) { return text_after(find_setting(name), given); }

// The message of the Error with which the text is refused. The test fails if the text is accepted.
std::string refusal(const Setting& row, std::string_view given) {
  Settings settings;
  const std::string before = row.get(settings);
  try {
    row.set(settings, given);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_EQ(row.get(settings), before) << row.name << ": a refused text changed the value";
    return error.what();
  }
  ADD_FAILURE() << row.name << " accepted '" << given << "' as " << row.get(settings);
  return "";
}
std::string refusal(std::string_view name, std::string_view given) { return refusal(find_setting(name), given); }

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(SettingsTable, HasAWholeRowForEverySetting) {
  // Numbers without a unit.
  const std::set<std::string_view> pure = {
      "scene.plates",        "scene.animation",      "map.placements", "map.extent_scale", "truth.standard_error",
      "bias.polygon_factor", "bias.polygon_units",   "view.up",        "motion.frame",     "motion.zoom",
      "light.index",         "map.aspect",           "cascades.count", "cascades.lambda",  "cascades.exponent",
      "cascades.blend",      "cascades.bias_scales", "lookup.level",   "lookup.exponent",  "lookup.negative_exponent"};
  const std::set<std::string_view> units = {"s",    "bias.offset_unit", "px",        "m",     "deg",     "texels",
                                            "taps", "frames",           "bias.unit", "depth", "depth^2", "fraction"};
  std::set<std::string_view> names;
  for (const Setting& row : settings_table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " twice";
    EXPECT_EQ(&find_setting(row.name), &row);
    EXPECT_TRUE(row.help.ends_with('.') && row.help.size() > 10) << row.name;
    EXPECT_FALSE(row.range_text().empty()) << row.name;
    EXPECT_TRUE(row.get && row.set) << row.name;
    const bool number = row.type == ValueType::integer || row.type == ValueType::real;
    if (number || row.is_of_numbers())
      EXPECT_TRUE(units.contains(row.unit) != pure.contains(row.name)) << row.name << " in '" << row.unit << "'";
    else
      EXPECT_EQ(row.unit, "") << row.name;
    // The suffix of a name is its unit.
    for (const auto& [suffix, unit] :
         {std::pair("_m", "m"), std::pair("_deg", "deg"), std::pair("_px", "px"), std::pair("_s", "s")})
      if (row.name.ends_with(suffix)) {
        EXPECT_EQ(row.unit, unit) << row.name;
      }
    if (number) {
      EXPECT_LT(row.min, row.max) << row.name;
    }
    EXPECT_EQ(row.type == ValueType::choice, row.choices.size() > 1) << row.name;
    EXPECT_EQ(row.range_text().ends_with(" or auto"), row.may_be_auto) << row.name;
  }
}

// A member without a row could not be set, and no key would contain it. So the members of each struct are counted.
TEST(SettingsTable, HasARowForEveryMember) {
  std::map<std::string, int> rows;
  for (const Setting& row : settings_table()) ++rows[std::string(row.name.substr(0, row.name.find('.')))];
  // A structured binding compiles only if it has as many names as the struct has members.
  const Settings s;
  [[maybe_unused]] const auto& [a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11, a12, a13, a14, a15, a16] = s.scene;
  [[maybe_unused]] const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, motion] = s.view;
  [[maybe_unused]] const auto& [e1, e2, e3, e4, e5, e6, e7, e8, e9] = motion;
  [[maybe_unused]] const auto& [c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11] = s.light;
  [[maybe_unused]] const auto& [d1, d2, d3, d4, d5, d6, d7, d8, d9, d10, d11, d12, d13, d14, d15, d16, d17, d18, d19,
                                d20, d21, d22, d23, d24, d25] = s.map;
  [[maybe_unused]] const auto& [i1, i2, i3, i4, i5, i6, i7, i8, i9, i10, i11, i12, i13, i14, i15] = s.cascades;
  [[maybe_unused]] const auto& [g1, g2] = s.truth;
  [[maybe_unused]] const auto& [h1] = s.given;
  // The units of depths and of offsets, reference and plane_cap, and every parameter of a part.
  const int bias = 4 + static_cast<int>(bias_parameters().size());
  // The kind, and every parameter that a filter reads.
  const int filter = 1 + static_cast<int>(FilterTable::parameters().size());
  const int lookup = 1 + static_cast<int>(LookupTable::parameters().size());
  EXPECT_EQ(rows, (std::map<std::string, int>{{"scene", 16},
                                              {"view", 11},
                                              {"motion", 9},
                                              {"light", 11},
                                              {"map", 25},
                                              {"cascades", 15},
                                              {"bias", bias},
                                              {"filter", filter},
                                              {"lookup", lookup},
                                              {"truth", 2},
                                              {"given", 1}}));
}

TEST(SettingsTable, TakesItsOwnTextsBack) {
  for (const Setting& row : settings_table()) {
    const std::string text = row.get(Settings{});
    EXPECT_EQ(text_after(row, text), text) << row.name;
    for (std::string_view choice : row.choices) EXPECT_EQ(text_after(row, choice), choice) << row.name;
    if (row.may_be_auto) {
      EXPECT_EQ(text_after(row, "auto"), "auto") << row.name;
    }
    if (row.type == ValueType::flag) {
      EXPECT_EQ(text_after(row, "true") + text_after(row, "false"), "truefalse") << row.name;
    }
  }
}

TEST(SettingsTable, ChangesOneMemberEach) {
  for (const Setting& row : settings_table()) {
    // A value in the row's range that is not the default.
    const std::string before = row.get(Settings{});
    std::string other = "1,2,3";
    if (row.type == ValueType::integer || row.type == ValueType::real)
      other = std::to_string(static_cast<int>(row.max));
    if (row.type == ValueType::choice) other = before == row.choices[0] ? row.choices[1] : row.choices[0];
    if (row.type == ValueType::flag) other = before == "true" ? "false" : "true";
    if (row.type == ValueType::text) other = "other";
    if (row.name == "truth.standard_error" || row.name == "cascades.blend" || row.name == "lookup.reduction")
      other = "0.25";  // ranges that end below 1
    ASSERT_NE(other, before) << row.name;
    Settings settings;
    row.set(settings, other);
    for (const Setting& each : settings_table())
      EXPECT_EQ(each.get(settings), each.name == row.name ? other : each.get(Settings{}))
          << row.name << " changed " << each.name;
  }
}

TEST(SettingsTable, HoldsItsRangesToTheLastFloat) {
  for (const Setting& row : settings_table()) {
    if (row.type == ValueType::real) {
      const auto text = [](double v) {
        char buffer[40];
        std::snprintf(buffer, sizeof buffer, "%.17g", v);
        return std::string(buffer);
      };
      for (double end : {row.min, row.max}) EXPECT_EQ(std::stod(text_after(row, text(end))), end) << row.name;
      // The next double below 0 is the smallest denormal, which a decimal parser need not accept. So the test uses a
      // normal number there.
      const double below = row.min == 0 ? -1e-300 : std::nextafter(row.min, -infinity);
      EXPECT_TRUE(contains(refusal(row, text(below)), row.range_with_unit())) << row.name;
      EXPECT_TRUE(contains(refusal(row, text(std::nextafter(row.max, infinity))), row.range_with_unit())) << row.name;
    } else if (row.type == ValueType::integer) {
      const int min = static_cast<int>(row.min), max = static_cast<int>(row.max);
      for (int end : {min, max}) EXPECT_EQ(text_after(row, std::to_string(end)), std::to_string(end)) << row.name;
      EXPECT_TRUE(contains(refusal(row, std::to_string(min - 1)), row.range_with_unit())) << row.name;
      EXPECT_TRUE(contains(refusal(row, std::to_string(max + 1)), row.range_with_unit())) << row.name;
    } else if (row.type == ValueType::point) {
      EXPECT_TRUE(std::isfinite(row.min) && std::isfinite(row.max) && row.min < row.max) << row.name;
      for (int axis = 0; axis < 3; ++axis) {
        const auto text = [&](double v) {
          glm::dvec3 p(0);
          p[axis] = v;
          char buffer[80];
          std::snprintf(buffer, sizeof buffer, "%.17g,%.17g,%.17g", p.x, p.y, p.z);
          return std::string(buffer);
        };
        for (double end : {row.min, row.max}) text_after(row, text(end));
        for (double beyond : {std::nextafter(row.min, -infinity), std::nextafter(row.max, infinity)})
          EXPECT_TRUE(contains(refusal(row, text(beyond)), row.range_with_unit())) << row.name;
      }
    }
  }
}

// Lists have brackets in TOML files and none on the command line. The error message says what to type.
TEST(SettingsTable, SaysHowToWriteNumbersWithoutBrackets) {
  EXPECT_TRUE(contains(refusal("cascades.bounds_m", "[10,20]"), "; write cascades.bounds_m = 10,20, without brackets"));
  EXPECT_TRUE(contains(refusal("view.eye_m", "(0, 1, 2)"), "; write view.eye_m = 0, 1, 2, without brackets"));
  for (const char* other : {"20,10", "[", "]10,20["})
    EXPECT_FALSE(contains(refusal("cascades.bounds_m", other), "brackets")) << other;
  EXPECT_FALSE(contains(refusal("map.resolution", "[64]"), "brackets")) << "it is one number";
}

// Of the junk below, what a list takes.
bool is_list(std::string_view text) { return text == "1,2" || text == "1,2,3,4"; }

TEST(SettingsTable, RefusesWhatIsNoValue) {
  for (const Setting& row : settings_table()) {
    refusal(row, "");
    if (row.type == ValueType::text) continue;
    const bool lists =
        row.type == ValueType::list || row.type == ValueType::whole_list || row.type == ValueType::real_list;
    for (std::string_view junk : {" ",
                                  "nonsense",
                                  "1x",
                                  "1 2",
                                  "--1",
                                  "+1",
                                  "0x10",
                                  "1,2",
                                  "1,2,3,",
                                  ",1,2",
                                  "1;2;3",
                                  "nan",
                                  "inf",
                                  "-inf",
                                  "infinity",
                                  "1e999",
                                  "99999999999999999999",
                                  "Auto",
                                  "AUTO",
                                  "auto ",
                                  "TRUE",
                                  "1.0.0",
                                  "nan,0,0",
                                  "0,inf,0",
                                  "1,,2",
                                  "1,2,3,4"})
      if (!(lists && is_list(junk))) refusal(row, junk);
    if (row.type != ValueType::real && row.type != ValueType::list && row.type != ValueType::real_list)
      refusal(row, "0.5");
    if (row.type != ValueType::flag) refusal(row, "true");
    if (!row.is_of_numbers()) refusal(row, "1,2,3");
    if (row.type == ValueType::list)
      for (const char* junk : {"3,2", "2,2", "-1,2", "1,1e30"}) refusal(row, junk);
    if (row.type == ValueType::real_list)
      for (const char* junk : {"-1,2", "1,1e30"}) refusal(row, junk);
    if (row.type == ValueType::whole_list)
      for (const char* junk : {"2,1.5", "2,0", "-1,2", "1,1e30"}) refusal(row, junk);
    const bool may_be_auto = row.may_be_auto || std::count(row.choices.begin(), row.choices.end(), "auto") > 0;
    if (!may_be_auto) refusal(row, "auto");
  }
  refusal("map.resolution", "1024.0");
  refusal("map.resolution", "1e3");
  refusal("map.resolution", "1024 ");
  refusal("map.resolution", " 1024");
  refusal("map.extent_m", "20m");
  refusal("map.format", "32F");
  const std::string message = refusal("map.resolution", "huge");
  for (std::string_view part : {"map.resolution", "'huge'", "1 ... 16384", "texels"})
    EXPECT_TRUE(contains(message, part)) << message;
  EXPECT_TRUE(contains(refusal("map.format", "8"), "16 | 24 | 32f"));
}

TEST(Settings, HaveOneTextForEachValue) {
  for (const char* same : {"1000", "1e3", "1000.0", "1.0e+3", "1E3", "0.1e4"})
    EXPECT_EQ(text_after("map.extent_m", same), "1000") << same;
  for (const char* same : {"0.005", "5e-3", ".005", "0.0050", "0.005000000000000000001"})
    EXPECT_EQ(text_after("bias.constant", same), "0.005") << same;
  for (const char* zero : {"0", "-0", "0.0", "-0.0", "0e5", "-0e-5"})
    EXPECT_EQ(text_after("map.near_m", zero), "0") << zero;
  for (const char* same : {"1,-2.5,0", "1.0,-25e-1,-0", "1, -2.5, 0"})
    EXPECT_EQ(text_after("view.eye_m", same), "1,-2.5,0") << same;
  EXPECT_EQ(text_after("map.extent_m", "1e9"), text_after("map.extent_m", "1000000000"));
}

RC_GTEST_PROP(Settings, ReadTheirOwnNumbersBackBitForBit, ()) {
  // A double of any size within the row's range.
  const double value = std::ldexp(1 + static_cast<double>(*rc::gen::inRange<int64_t>(0, int64_t{1} << 52)) * 0x1p-52,
                                  *rc::gen::inRange(-300, 28)) *
                       *rc::gen::element(-1, 1);
  Settings settings;
  settings.map.near_m = value;
  settings.light.position_m = glm::dvec3(value, -value, value / 3);
  const Setting &number = find_setting("map.near_m"), &point = find_setting("light.position_m");
  Settings back;
  number.set(back, number.get(settings));
  point.set(back, point.get(settings));
  RC_ASSERT(*back.map.near_m == value);
  RC_ASSERT(*back.light.position_m == *settings.light.position_m);
  RC_ASSERT(number.get(back) == number.get(settings));
  // 17 digits identify a double, so such a long text gives the same canonical text.
  char long_text[64];
  std::snprintf(long_text, sizeof long_text, "%.17e", value);
  RC_ASSERT(text_after(number, long_text) == number.get(settings));
}

TEST(NearestName, FindsTypingErrorsAndNothingElse) {
  const auto suggestion = [](std::string_view wrong) -> std::string {
    const std::string what = refusal_of(ErrorKind::usage, [&] { find_setting(wrong); });
    if (what.empty()) return "found";
    const size_t at = what.find("did you mean '");
    return at == std::string::npos ? "" : what.substr(at + 14, what.find('\'', at + 14) - at - 14);
  };
  EXPECT_EQ(suggestion("map.resolutoin"), "map.resolution");
  EXPECT_EQ(suggestion("resolution"), "map.resolution");
  EXPECT_EQ(suggestion("constant"), "bias.constant");
  EXPECT_EQ(suggestion("bias.const"), "bias.constant");  // though "bias.unit" differs by no more letters
  EXPECT_EQ(suggestion("Map.Wrap"), "map.wrap");
  EXPECT_EQ(suggestion("map.near"), "map.near_m");
  EXPECT_EQ(suggestion("zzz"), "");
  EXPECT_EQ(suggestion("completely.different.thing"), "");
  EXPECT_EQ(suggestion("map.resolution"), "found");
}

RC_GTEST_PROP(NearestName, ForgivesTwoSlipsInAnyName, ()) {
  const Setting& row =
      settings_table()[static_cast<size_t>(*rc::gen::inRange(0, static_cast<int>(settings_table().size())))];
  std::string wrong(row.name);
  for (int slip = 0; slip < 2; ++slip) {
    const size_t at = static_cast<size_t>(*rc::gen::inRange(0, static_cast<int>(wrong.size())));
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        wrong.erase(at, 1);
        break;
      case 1:
        wrong.insert(at, 1, '#');
        break;
      default:
        wrong[at] = '#';
    }
  }
  const std::vector<std::string_view> only = {row.name};
  RC_ASSERT(nearest_name(wrong, only) == row.name);
}

TEST(NearestName, PrefersTheNearestAndTheFirstOfEquals) {
  const std::vector<std::string_view> names = {"abcd", "abce", "abxx"};
  EXPECT_EQ(nearest_name("abcf", names), "abcd");
  EXPECT_EQ(nearest_name("abce", names), "abce");
  EXPECT_EQ(nearest_name("abxy", names), "abxx");
  EXPECT_EQ(nearest_name("wxyz", names), "");
  EXPECT_EQ(nearest_name("abcd", {}), "");
  EXPECT_EQ(nearest_name("", names), "");
}

}  // namespace
}  // namespace noonmark
