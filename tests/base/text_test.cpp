// Text of unknown origin, as it is written to each medium.
#include "base/text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "compare/report/escape.h"

namespace noonmark {
namespace {

// All single bytes, the limits of UTF-8, and text that acts on a terminal or that is markup.
std::vector<std::string> samples() {
  std::vector<std::string> all;
  for (int byte = 0; byte < 256; ++byte) all.push_back(std::string(1, static_cast<char>(byte)));
  for (const char* text : {"\u0080",
                           "\u009b31m",
                           "\u00a0",
                           "ü",
                           "\u07ff",
                           "\u0800",
                           "\u200e",
                           "\u202e",
                           "\u2066",
                           "–",
                           "\ufffd",
                           "\ufffe",
                           "𝄞",
                           "\U0010ffff",
                           "\xc0\xaf",
                           "\xed\xa0\x80",
                           "\xf4\x90\x80\x80",
                           "\xe2\x82",
                           "\x1b[31mred",
                           "=1+1",
                           "-5",
                           "-5,1,2",
                           "+a",
                           "@a",
                           "-inf",
                           "|a|b|",
                           "**a**",
                           "<b>",
                           "&lt;",
                           "`a`",
                           "[a](b)",
                           "# a",
                           "a\nb",
                           "a\r# b",
                           "]]>",
                           "\"'",
                           "$x$",
                           "~~a~~",
                           "> a"})
    all.emplace_back(text);
  return all;
}

// UTF-8 by its definition, from the code point, without the tables in utf8_length.
std::string encoded(uint32_t c) {
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 63))};
  if (c < 0x10000)
    return {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 63)),
            static_cast<char>(0x80 | (c & 63))};
  return {static_cast<char>(0xf0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 63)),
          static_cast<char>(0x80 | (c >> 6 & 63)), static_cast<char>(0x80 | (c & 63))};
}

TEST(Text, KnowsEveryCharacterOfUnicodeAndNothingElse) {
  for (uint32_t c = 0; c < 0x110000; ++c) {
    const std::string text = encoded(c);
    const bool surrogate = c >= 0xd800 && c < 0xe000;
    ASSERT_EQ(utf8_length(text + "x"), surrogate ? 0 : text.size()) << c;
    for (size_t cut = 1; cut < text.size(); ++cut) ASSERT_EQ(utf8_length(text.substr(0, cut)), 0u) << c;
    if (surrogate) continue;
    const bool control = c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x200e || c == 0x200f ||
                         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
    ASSERT_EQ(is_control(text), control) << c;
  }
  EXPECT_EQ(utf8_length(""), 0u);
  EXPECT_EQ(utf8_length("\xc0\xaf"), 0u) << "an overlong encoding of '/'";
}

TEST(Text, PrintsNoControlCharacter) {
  for (const std::string& text : samples()) {
    for (const Lines lines : {Lines::one, Lines::many}) {
      const std::string shown = printable("a" + text + "b", lines);
      for (std::string_view rest = shown; !rest.empty();) {
        const size_t length = utf8_length(rest);
        ASSERT_GT(length, 0u) << shown;
        const std::string_view character = rest.substr(0, length);
        ASSERT_TRUE(!is_control(character) || (lines == Lines::many && (character == "\n" || character == "\t")))
            << shown;
        rest.remove_prefix(length);
      }
    }
  }
  EXPECT_EQ(printable("a\x1b[31m\xff ü\n"), "a\\x1b[31m\\xff ü\\x0a");
  EXPECT_EQ(printable("a\tb\n\r", Lines::many), "a\tb\n\\x0d");
}

// GitHub, for one, takes a line of a log for a command if it begins with two colons, after blanks too.
TEST(Text, OneLineIsNoCommandOfAServer) {
  EXPECT_EQ(printable("::error file=a::b"), "\\x3a:error file=a::b");
  EXPECT_EQ(printable("  ::error ::b"), "  \\x3a:error ::b");
  EXPECT_EQ(printable("a\n::error ::b"), "a\\x0a::error ::b");
  EXPECT_EQ(printable("\t::error ::b"), "\\x09::error ::b");
  for (const char* plain : {"a::b", ": a", ":", "", "  ", " a ::b"}) EXPECT_EQ(printable(plain), plain);
}

// A cell must read back as the printable text, or as that after an apostrophe. It must not begin as a formula does.
TEST(Text, CsvHasNoFormulas) {
  for (const std::string& text : samples()) {
    std::string cell = csv_text(text);
    if (cell.starts_with('"')) {
      std::string plain;
      for (size_t i = 1; i + 1 < cell.size(); ++i) {
        plain += cell[i];
        if (cell[i] == '"') ++i;
      }
      cell = plain;
    }
    const std::string shown = printable(text);
    EXPECT_TRUE(cell == shown || cell == "'" + shown) << text;
    EXPECT_EQ(cell.find_first_of("\t\r\n"), std::string::npos) << text;
    if (cell == shown && !cell.empty()) {
      EXPECT_EQ(std::string_view("=+@").find(cell[0]), std::string::npos) << text;
    }
  }
  EXPECT_EQ(csv_text("=HYPERLINK(\"x\")"), "\"'=HYPERLINK(\"\"x\"\")\"");
  EXPECT_EQ(csv_text("-cmd|' /C calc'!A0"), "'-cmd|' /C calc'!A0");
  for (const char* number : {"-5", "-0.25", "-inf", "-1e-07"})
    EXPECT_EQ(csv_text(number).find('\''), std::string::npos) << number;
  EXPECT_EQ(csv_text("-4,a"), "\"'-4,a\"");
  EXPECT_EQ(csv_text("-4,3,1"), "\"'-4,3,1\"") << "a position in space is text, not a number";
}

TEST(Text, MarkdownTakesNothingForMarkup) {
  for (const std::string& text : samples()) {
    const std::string run = markdown(text);
    EXPECT_EQ(run.find_first_of("\n\r\t\x1b<"), std::string::npos) << text;
    for (size_t i = 0; i < run.size(); ++i)
      if (std::string_view("|`*_[]#~$").find(run[i]) != std::string_view::npos) {
        ASSERT_GT(i, 0u) << run;
        EXPECT_EQ(run[i - 1], '\\') << run;
      }
    const std::string block = markdown_block(text);
    EXPECT_EQ(block.find_first_of("\r\t\x1b"), std::string::npos) << text;
    for (size_t at = 0; at < block.size(); at = block.find('\n', at) + 1)
      EXPECT_EQ(block.compare(at, 4, "    "), 0) << text;
  }
  EXPECT_EQ(markdown("a|b <i> \\ & c"), "a\\|b &lt;i> \\\\ &amp; c");
  EXPECT_EQ(markdown("- a"), "\\- a");
}

TEST(Text, XmlHoldsOnlyWhatXmlMay) {
  for (const std::string& text : samples()) {
    const std::string escaped = xml_text(text);
    EXPECT_EQ(escaped.find_first_of("<>\"\n\r\t"), std::string::npos) << text;
    for (std::string_view rest = escaped; !rest.empty();) {
      const size_t length = utf8_length(rest);
      ASSERT_GT(length, 0u) << escaped;
      ASSERT_FALSE(is_control(rest.substr(0, length)) || rest.starts_with("\ufffe")) << escaped;
      rest.remove_prefix(length);
    }
  }
  EXPECT_EQ(xml_text("a<b>&\"\n\x1b"), "a&lt;b&gt;&amp;&quot;&#10;\ufffd");
}

}  // namespace
}  // namespace noonmark
