// The check before toml++: what it accepts and what it refuses, at every kind of place in a TOML text.
#include "app/definition/toml_text.h"

#include <gtest/gtest.h>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

std::string utf8(char32_t c) {
  const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
  if (c < 0x800) return {byte(0xc0 | c >> 6), byte(0x80 | (c & 0x3f))};
  if (c < 0x10000) return {byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f))};
  return {byte(0xf0 | c >> 18), byte(0x80 | (c >> 12 & 0x3f)), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f))};
}

// Characters for each branch of toml++'s test: inside a range, white space or not, and beyond the last range.
constexpr char32_t characters[] = {0x80,   0x85,   0xa0,   0xe9,   0x3a9,  0x1680, 0x2003, 0x2028,
                                   0x3000, 0x3042, 0x4e2d, 0xfb26, 0xfcbf, 0xfefe, 0xfeff, 0x1f600};

// The text with '@' replaced by the character.
std::string placed(std::string text, char32_t c) { return text.replace(text.find('@'), 1, utf8(c)); }

template <class Read>
std::string message(const Read& read) {
  return refusal_of(ErrorKind::usage, read);
}
std::string refusal_of_text(const std::string& text) {
  return message([&] { check_toml_text(text, "x.toml"); });
}

TEST(TomlText, OutsideOfStringsAndCommentsEveryCharacterIsAscii) {
  for (const char* text :
       {"@ = 1", "a@ = 1", "a @= 1", "a.@ = 1", "a = @", "a = 1@", "a = 1 @", "[@]", "[a@]", "[a]@", "[[@]]", "a = [@]",
        "a = [1,@]", "a = [1@]", "a = {@}", "a = {b@=1}", "a = true@", "a = 1979-05-27@", "a = 1979-05-27T@", "a = 1_@",
        "a = \"\"@", "a = ''@", "a = \"x\"@", "a = 'x'@", "a = \"\"\"x\"\"\"@", "a = \"\"\"x\"\"\"\"@",
        "a = \"\"\"x\"\"\"\"\"@", "a = '''x'''@", "a = '''x''''@", "a = '''x'''''@", "a = \"\\\"\"@", "a = '\\'@",
        "a = \"\"\"\\\"\"\"\"@", "\"a\"@ = 1", "a = '\"'@", "a = \"'\"@", "a = \"#\"@",
        // Here the quote begins no string, because it is inside a word.
        "a = +\"@\"", "a = 1\"@\"", "a = 1.\"@\"", "a = [1.\"@\"]", "a = t'@'", "a = =\"@\"", "a = [=\"@\"]",
        "a\"@\" = 1", "a = {b = +\"@\"}", "a = ;'@'"}) {
    for (const char32_t c : characters) {
      const std::string before = "title = \"é\"  # 中\n", whole = before + placed(text, c) + "\n";
      const std::string place =
          "x.toml:2:" + std::to_string(std::string_view(text).find('@') + 1) + ": the character U+";
      EXPECT_TRUE(refusal_of_text(whole).starts_with(place)) << whole << refusal_of_text(whole);
      EXPECT_EQ(message([&] { parse_experiment(whole, "x.toml"); }), refusal_of_text(whole))
          << "toml++ read the text before the check";
    }
  }
}

TEST(TomlText, InStringsAndCommentsEveryCharacterMayStand) {
  for (const char* text : {"# @",
                           "a = 1 # @",
                           "[a] # @",
                           "a = \"@\"",
                           "a = '@'",
                           "a = \"x@y\"",
                           "a = \"\\\"@\"",
                           "a = \"\\\\@\"",
                           "a = \"\"\"@\"\"\"",
                           "a = \"\"\"\n@\"\"\"",
                           "a = \"\"\"\"@\"\"\"",
                           "a = \"\"\"\"\"@\"\"\"",
                           "a = '''@'''",
                           "a = '''\n'@'''",
                           "a = '''\\@'''",
                           "a = '\\@'",
                           "a = \"\"\"\\\n x@\"\"\"",
                           "a = \"\"\"\\t@\"\"\"",
                           "a = \"\"\"\\\\@\"\"\"",
                           "a = \"\"\"x\\\n \"@\"\"\"",
                           "\"@\" = 1",
                           "'@' = 1",
                           "[\"@\"]",
                           "a = {'@' = 1}",
                           "a.\"@\" = 1",
                           "[a.'@']",
                           "a=\"@\"",
                           "a=['@','x']",
                           "a = [\n'x',\n\"@\"]",
                           "a = [\n[1]]\nb.\"@\" = 1"}) {
    for (const char32_t c : characters) EXPECT_EQ(refusal_of_text(placed(text, c) + "\n"), "") << text;
  }
}

TEST(TomlText, BehindALineThatABackslashEndedACharacterIsRefused) {
  for (const char* text : {"a = \"\"\"\\\n@\"\"\"", "a = \"\"\"\\\n  @\"\"\"", "a = \"\"\"\\ \n\n@\"\"\"",
                           "a = \"\"\"\\\r\n@\"\"\"", "a = \"\"\"x\\@\"\"\""})
    EXPECT_NE(refusal_of_text(placed(text, 0xe9)).find("the character U+00E9 cannot be read after a backslash"),
              std::string::npos)
        << text;
}

TEST(TomlText, AccentsComeThroughToTheExperiment) {
  const Experiment e = parse_experiment("\xef\xbb\xbftitle = \"Größe ’ 影\"  # é\n", "x.toml");
  EXPECT_EQ(e.title, "Größe ’ 影");
}

TEST(TomlText, BytesThatAreNoCharactersAreNamed) {
  EXPECT_TRUE(refusal_of_text("a = \xff\n").starts_with("x.toml:1:5: the byte 0xff, which is not UTF-8,"));
  EXPECT_TRUE(refusal_of_text("\xef\xbb\xbf\xe9 = 1").starts_with("x.toml:1:1: the byte 0xe9, which is not UTF-8,"));
}

// toml++ reports a missing quote. The text after it must not be checked as if it were a name.
TEST(TomlText, AfterAStringWithoutEndNothingIsRefused) {
  EXPECT_EQ(refusal_of_text("a = \"x\né = 1\n"), "");
  EXPECT_EQ(refusal_of_text("a = 'x\né = 1\n"), "");
  EXPECT_EQ(refusal_of_text("a = \"\"\"x\né"), "");
  EXPECT_EQ(refusal_of_text("a = \"\\"), "");
  EXPECT_EQ(refusal_of_text("a = \"\"\"\\"), "");
}

}  // namespace
}  // namespace noonmark
