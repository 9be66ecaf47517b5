// What is typed into an engine, read back: lines to values, and values to settings.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "technique/setting_rules.h"
#include "tests/app/engine_case.h"

namespace noonmark {
namespace {

using namespace test;

// Random settings, as many as 1,000 for each engine. Same seed, same settings.
class Random {
 public:
  double between(double least, double most) { return std::uniform_real_distribution(least, most)(numbers_); }
  size_t below(size_t end) { return std::uniform_int_distribution<size_t>(0, end - 1)(numbers_); }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return *(values.begin() + below(values.size()));
  }

 private:
  std::mt19937 numbers_{20};
};

// Of the values that the engine's words tell apart.
void choose(Random& random, const Engine& engine, std::string_view setting, Settings& settings) {
  const Setting& row = find_setting(setting);
  for (const auto& [name, words] : engine.choices)
    if (name == setting) {
      const std::string_view word = words[random.below(words.size())];
      row.set(settings, row.choices[static_cast<size_t>(std::find(words.begin(), words.end(), word) - words.begin())]);
    }
}

Settings random_settings(Random& random, const Engine& engine) {
  Settings s = simple();
  s.map.resolution = 1 << (6 + random.below(6));
  s.map.extent_m = random.between(4, 60);
  s.map.near_m = random.between(0.1, 3);
  s.map.far_m = random.between(20, 90);
  for (const char* choice : {"map.cull", "map.format"}) choose(random, engine, choice, s);
  s.bias.unit = BiasUnit::m;
  const std::vector<EngineKnob> biases = engine.biases(LightKind::directional);
  for (const EngineKnob& knob : biases)
    if (random.below(3) > 0)
      for (const BiasPart* part : knob.parts())
        s.bias[part->name] = random.between(0, part->unit == "bias.unit" ? 0.05 : 2);
  if (!engine.lookups.empty() && random.below(4) == 0) {
    const EngineLookupRow& row = engine.lookups[random.below(engine.lookups.size())];
    s.lookup.kind = row.kind;
    if (row.kind == "three_vsm") {
      s.lookup["radius"] = random.between(0.5, 8);
      s.lookup["samples"] = static_cast<double>(2 + random.below(20));
    } else {
      s.lookup["exponent"] = random.between(5, 80);
      s.lookup["level"] = static_cast<double>(random.below(2));
      const int n = static_cast<int>(1 + random.below(4));
      s.filter = random.one_of<FilterSettings>(
          {{}, {"box", {{"size", 2 * n + 1}}}, {"gaussian", {{"size", 4 * n + 1}, {"sigma_texels", 4 * n / 6.0}}}});
    }
    for (const BiasPart& part : bias_parts())
      if (part.acts_on == BiasTarget::caster) s.bias[part.name] = 0;
    return s;
  }
  s.filter = random.one_of<FilterSettings>({{},
                                            {"hardware", {}},
                                            {"castano", {{"size", 3}}},
                                            {"castano", {{"size", 5}}},
                                            {"tent", {{"size", 5}}},
                                            {"tent", {{"size", 7}}}});
  return s;
}

// A number of 6 digits is at most half a unit of its last digit off.
void expect_as_written(const Setting& row, const Settings& read, const Settings& expected) {
  const std::string a = row.get(read), b = row.get(expected);
  if (row.type == ValueType::real && a != "auto" && b != "auto")
    EXPECT_NEAR(std::stod(a), std::stod(b), written * std::abs(std::stod(b))) << row.name;
  else
    EXPECT_EQ(a, b) << row.name;
}

class EngineReader : public testing::TestWithParam<std::string> {};

// The settings that are read from the lines are those that Noonmark measures for them.
TEST_P(EngineReader, ReadsWhatItWrites) {
  const Engine engine = engine_of(GetParam());
  Random random;
  size_t compared = 0;
  for (int i = 0; i < 1000 && !HasFailure(); ++i) {
    const Settings s = random_settings(random, engine);
    Settings condition = simple();
    condition.map.near_m = s.map.near_m, condition.map.far_m = s.map.far_m;  // of engines that fit them
    condition.map.format = s.map.format;
    condition.filter = s.filter;
    const Case c = make(s);
    const EngineAdvice given = advice_for_engine(GetParam(), c.settings, c.frame, c.scene);
    ASSERT_FALSE(given.lines.empty()) << given.cannot.front();
    std::vector<std::string> unread;
    const EngineValues values = read_values(GetParam(), given.lines, LightKind::directional, &unread);
    EXPECT_TRUE(unread.empty()) << unread.front();
    if (!given.emulated) continue;
    const Settings read = settings_of_values(GetParam(), values, condition, c.scene);
    ++compared;
    Settings expected = *given.emulated;
    // These stay those of the condition: the engine has no field for them.
    if (expected.map.reach_m) expected.map.near_m = read.map.near_m, expected.map.far_m = read.map.far_m;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("bias.") || row.name.starts_with("map.") || row.name.starts_with("filter.") ||
          row.name.starts_with("lookup."))
        expect_as_written(row, read, expected);
    if (HasFailure()) ADD_FAILURE() << "case " << i << "\n" << joined(given.lines);
  }
  EXPECT_GT(compared, 250u);
}

// In lines of a spot or point light, too, nothing is unread: each row's number stands in its line.
TEST_P(EngineReader, ReadsTheLinesOfOtherLights) {
  for (const LightChoice light : {LightChoice::spot, LightChoice::point}) {
    const Case c = make(constant_m(0.05, light));
    const EngineAdvice given = advice_for_engine(GetParam(), c.settings, c.frame, c.scene);
    std::vector<std::string> unread;
    const EngineValues values = read_values(GetParam(), given.lines, c.frame.kind, &unread);
    EXPECT_TRUE(unread.empty()) << unread.front();
    EXPECT_EQ(values.empty(), given.lines.empty());
  }
}

// The defaults are values that the engine takes, and the rows of sources are there.
TEST_P(EngineReader, TakesItsDefaults) {
  const Engine engine = engine_of(GetParam());
  const Case c = make(simple());
  EngineValues values;
  for (const EngineKnob& knob : engine.knobs) {
    EXPECT_LE(knob.source, static_cast<int>(sources_of(engine).size())) << knob.field;
    if (knob.preset && (knob.lights & directional_light)) values[std::string(knob.word())] = number(*knob.preset);
  }
  const Settings read = settings_of_values(GetParam(), values, c.settings, c.scene);
  for (const EngineKnob& knob : engine.biases(LightKind::directional))
    EXPECT_EQ(knob.preset.value_or(0) > 0, read.bias[knob.parts().front()->name] > 0) << knob.field;
}

void expect_refused(const EngineValues& values, const std::string& why) {
  const Case c = make(simple());
  try {
    settings_of_values("playcanvas", values, c.settings, c.scene);
    FAIL() << why;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(EngineValuesOfAUser, AreRefusedWithTheReason) {
  expect_refused({{"normalBias", "0.1"}}, "normalBias of PlayCanvas is no field");
  expect_refused({{"shadowBias", "much"}}, "is no number: 'much'");
  expect_refused({{"shadowBias", "-0.1"}}, "it is 0 to");
  expect_refused({{"shadowResolution", "16384"}}, "it is 1 to 8192");
  expect_refused({{"shadowResolution", "1000.5"}}, "it is a multiple of 1");
  expect_refused({{"filter", "7"}}, "filter of PlayCanvas");
}

INSTANTIATE_TEST_SUITE_P(Each, EngineReader, testing::ValuesIn(engine_words()),
                         [](const auto& engine) { return engine.param; });

}  // namespace
}  // namespace noonmark
