// Includes in GLSL files, and errors that name the file and line they came from.
#include <map>

#include "gl/egl_context.h"
#include "gl/lookup_parts.h"
#include "gl/program.h"
#include "gl/shader_text.h"
#include "technique/setting_rules.h"
#include "tests/gl/fixture.h"
#include "tests/support/bias_of.h"

namespace noonmark::gl {
namespace {

ShaderFiles files_of(const std::map<std::string, std::string, std::less<>>& files) {
  return [&files](std::string_view name) -> std::string_view {
    const auto found = files.find(name);
    return found == files.end() ? std::string_view() : std::string_view(found->second);
  };
}

const std::map<std::string, std::string, std::less<>> planted = {
    {"ok.vert", "#version 450 core\nvoid main() { gl_Position = vec4(0); }\n"},
    {"main.frag",
     "#version 450 core\n#include \"part.glsl\"\n#include <slot>\nout float c;\nvoid main() {\n  c = part() + "
     "slot();\n}\n"},
    {"part.glsl", "float part() { return 1.0; }\n"},
    {"good.glsl", "#include \"part.glsl\"\nfloat slot() { return part(); }\n"},
    {"bad.glsl", "// a comment\nfloat slot() {\n  return no_such_name;\n}\n"},
    {"tail.frag", "#version 450 core\n#include \"part.glsl\"\nout float c;\nvoid main() {\n  c = nothing_here;\n}\n"},
    {"lost.frag", "#version 450 core\n\n#include \"missing.glsl\"\n"},
    {"odd.frag", "#version 450 core\n#include part.glsl\n"},
};

TEST(ShaderText, IncludesEachFileOnceWithItsNumber) {
  const ShaderText text = expand_includes("main.frag", {{"slot", "good.glsl"}}, files_of(planted));
  EXPECT_EQ(text.files, (std::vector<std::string>{"main.frag", "part.glsl", "good.glsl"}));
  EXPECT_EQ(text.text,
            "#version 450 core\n"
            "#line 1 1\nfloat part() { return 1.0; }\n"
            "#line 3 0\n"
            "#line 1 2\n#line 2 2\nfloat slot() { return part(); }\n"
            "#line 4 0\nout float c;\nvoid main() {\n  c = part() + slot();\n}\n");
}

TEST(ShaderText, WhatIsMissingIsNamedWithItsPlace) {
  const auto message = [](const char* file, const ShaderSlots& slots) {
    std::string text;
    EXPECT_EQ(kind_thrown([&] { expand_includes(file, slots, files_of(planted)); }, &text),
              static_cast<int>(ErrorKind::device));
    return text;
  };
  EXPECT_NE(message("lost.frag", {}).find("lost.frag:3: there is no shader file 'missing.glsl'"), std::string::npos);
  EXPECT_NE(message("main.frag", {}).find("main.frag:3: no file is chosen for the slot <slot>"), std::string::npos);
  EXPECT_NE(message("odd.frag", {}).find("odd.frag:2: cannot read"), std::string::npos);
}

TEST(ShaderText, NamesTheLinesOfEveryDriversLog) {
  const std::vector<std::string> files = {"a.frag", "b.glsl"};
  EXPECT_EQ(name_lines("1:12(5): error: bad\n", files), "b.glsl:12: error: bad");
  EXPECT_EQ(name_lines("1(12) : error C1008: bad\n0(3) : warning C7050: meh\n", files),
            "b.glsl:12: error C1008: bad\na.frag:3: warning C7050: meh");
  EXPECT_EQ(name_lines("ERROR: 0:7: 'x' : undeclared", files), "a.frag:7: 'x' : undeclared");
  EXPECT_EQ(name_lines("9:1(1): error: elsewhere", files), "9:1(1): error: elsewhere");
}

TEST(ShaderErrors, NameFileAndLine) {
  EglContext context(DebugMode::fatal);
  const auto message = [](const char* fragment, const ShaderSlots& slots) {
    std::string text;
    EXPECT_EQ(kind_thrown(
                  [&] {
                    Program({"ok.vert", fragment}, slots, files_of(planted));
                  },
                  &text),
              static_cast<int>(ErrorKind::device));
    return text;
  };
  EXPECT_NE(message("main.frag", {{"slot", "bad.glsl"}}).find("bad.glsl:3: "), std::string::npos)
      << message("main.frag", {{"slot", "bad.glsl"}});
  EXPECT_NE(message("tail.frag", {}).find("tail.frag:5: "), std::string::npos)
      << "the line numbers continue after an include";
  context.forget_errors();  // drivers may report a failed compilation through the debug callback too
  EXPECT_EQ(kind_thrown([&] { Program({"ok.vert", "main.frag"}, {{"slot", "good.glsl"}}, files_of(planted)); }), 0);
  EXPECT_EQ(kind_thrown([&] { context.check("compiling"); }), 0);
}

TEST(LookupParts, EveryLightBiasAndFilterBuilds) {
  EglContext context(DebugMode::fatal);
  ProgramCache programs;
  int built = 0, refused = 0;
  // LightKind has one enumerator for each choice of light.kind, except for its first choice, `auto`.
  for (size_t l = 0; l + 1 < find_setting("light.kind").choices.size(); ++l)
    for (const BiasSettings& bias : every_bias())
      for (size_t f = 0; f < find_setting("filter.kind").choices.size(); ++f) {
        Settings settings;
        settings.bias = bias;
        settings.filter.kind = std::string(find_setting("filter.kind").choices[f]);
        if (kind_thrown([&] { validate(settings, static_cast<LightKind>(l)); })) {
          ++refused;
          continue;
        }
        LightFrame frame;
        frame.kind = static_cast<LightKind>(l);
        const ShaderSlots slots = lookup_slots(programs, {settings, frame});
        const ShaderStages stages{"shaders/screen.vert", "shaders/lookup.frag"};
        const Program& first = programs.get(stages, slots);
        EXPECT_EQ(&first, &programs.get(stages, slots)) << "built once";
        ++built;
      }
  // Two lights have flat maps: they refuse the filters of cube maps, and two references together with a blended filter.
  // One light has a cube map: it refuses the filters of flat maps, and the same two references.
  const auto count = [](auto&& meant) { return static_cast<int>(std::ranges::count_if(filters(), meant)); };
  const int biases = static_cast<int>(every_bias().size());
  const int flat = count([](const Filter& f) { return f.map != FilterMap::cube; });
  const int cube = count([](const Filter& f) { return f.map != FilterMap::flat; });
  const int blended = count([](const Filter& f) { return f.blended; });
  EXPECT_EQ(built, 2 * (biases * flat - 2 * blended) + (biases - 2) * cube);
  EXPECT_EQ(refused, 3 * biases * static_cast<int>(filters().size()) - built);
  EXPECT_EQ(kind_thrown([&] { context.check("building"); }), 0);
}

}  // namespace
}  // namespace noonmark::gl
