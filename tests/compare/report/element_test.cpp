// Text is escaped once on its way into a page, and markup never.
#include "compare/report/element.h"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "compare/report/blocks.h"

namespace noonmark::report {
namespace {

// Markup is no text, so that it cannot be escaped again, and cannot be an attribute's value. What must not compile at all is
// in markup_test.cmake.
static_assert(std::is_convertible_v<std::string, Markup> && std::is_convertible_v<const char*, Markup>);
static_assert(std::is_convertible_v<std::string_view, Markup> && std::is_convertible_v<size_t, Markup>);
static_assert(!std::is_convertible_v<Markup, std::string> && !std::is_constructible_v<std::string, Markup>);
static_assert(!std::is_convertible_v<Markup, std::string_view> && !fmt::is_formattable<Markup>::value);
static_assert(!std::is_constructible_v<Attribute, Name, Markup>);
static_assert(!std::is_constructible_v<Markup, bool> && !std::is_constructible_v<Markup, char>);
static_assert(!std::is_constructible_v<Markup, double>, "a number for people has a format");

const std::string evil = "<b onclick=\"x('&')\">";
const std::string harmless = "&lt;b onclick=&quot;x(&#39;&amp;&#39;)&quot;&gt;";

TEST(Markup, EscapesEachCharacterThatHtmlCanRead) {
  const std::map<char, std::string> entities{
      {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  for (char c = ' '; c <= '~'; ++c) {
    const std::string text(1, c), expected = entities.contains(c) ? entities.at(c) : text;
    EXPECT_EQ(Markup(text).html(), expected);
    EXPECT_EQ(Markup("ä" + text).html(), "ä" + expected) << "a text that is not plain";
    EXPECT_EQ(element("p", Attribute("title", text)).html(), "<p title=\"" + expected + "\"></p>");
  }
}

TEST(Markup, HasNoControlCharacters) {
  EXPECT_EQ(Markup("a\x1b[31m\u202e\u0085<").html(), "a\uFFFD[31m\uFFFD\uFFFD&lt;");
  EXPECT_EQ(Markup("a\tb\nc").html(), "a\tb\nc");
  EXPECT_EQ(Markup("\xff").html(), "\uFFFD");
  EXPECT_EQ(Attribute("alt", "\xff\x7f").html(), " alt=\"\uFFFD\uFFFD\"");
}

TEST(Markup, EscapesTextOnce) {
  const Markup text = evil;
  EXPECT_EQ(text.html(), harmless);
  EXPECT_EQ((text + evil).html(), harmless + harmless);
  EXPECT_EQ((evil + text).html(), harmless + harmless);
  EXPECT_EQ(td(text).html(), "<td>" + harmless + "</td>") << "markup is not escaped again";
  EXPECT_EQ(td(bold(small(evil))).html(), "<td><b><small>" + harmless + "</small></b></td>");
  EXPECT_EQ(prose("{}, {}, {}", evil, text, code(evil)).html(),
            harmless + ", " + harmless + ", <code>" + harmless + "</code>");
  EXPECT_EQ(joined({evil, bold(evil)}, "<").html(), harmless + "&lt;<b>" + harmless + "</b>");
  EXPECT_EQ(Markup::unescaped("<hr>").html(), "<hr>");
}

TEST(Markup, KeepsALiteralThatIsSafe) {
  EXPECT_EQ(prose("the light's \"own\" {:.1f} of {} {}", 2.0 / 3, 1234, "a<").html(),
            "the light's \"own\" 0.7 of 1234 a&lt;");
}

TEST(Element, HasItsAttributesInOrderAndThenItsContent) {
  EXPECT_EQ(element("a", Attribute("href", "#p1"), "see ", Attribute("data-show", evil), bold("1")).html(),
            "<a href=\"#p1\" data-show=\"" + harmless + "\">see <b>1</b></a>");
  EXPECT_EQ(row_head(css("text"), 7).html(), "<th class=\"text\" scope=\"row\">7</th>");
  EXPECT_EQ(td(Attribute("colspan", 6), css("")).html(), "<td colspan=\"6\"></td>") << "no class, no attribute";
  EXPECT_EQ(element("details", Attribute("open", true)).html(), "<details open></details>");
  EXPECT_EQ(element("details", Attribute("open", false)).html(), "<details></details>");
  EXPECT_EQ(tr(td(), paragraph()).html(), "<tr><td></td><p></p>\n</tr>\n");
}

TEST(Element, HasNoEndWhereItIsAlwaysEmpty) {
  EXPECT_EQ(line_break().html(), "<br>");
  EXPECT_EQ(element("img", Attribute("alt", "")).html(), "<img alt=\"\">") << "an empty text is a value";
  EXPECT_EQ(element("rect", Attribute("x", 1)).html(), "<rect x=\"1\"/>");
  for (const char* content : {"a", " "}) {
    EXPECT_THROW(element("br", content), std::logic_error);
    EXPECT_THROW(element("line", content), std::logic_error);
  }
}

TEST(Blocks, EscapeTheirTitles) {
  EXPECT_EQ(section(evil, evil, bold("x")).html(),
            "<section id=\"" + harmless + "\"><h2>" + harmless + "</h2>\n<b>x</b></section>\n");
  EXPECT_EQ(folded("more", true, evil, "y").html(),
            "<details class=\"more\" open><summary>" + harmless + "</summary>\ny</details>\n");
  EXPECT_EQ(table("numbers", heads({evil, bold("a")}), tr(td(1))).html(),
            "<table class=\"numbers\"><thead><tr><th>" + harmless +
                "</th><th><b>a</b></th></tr></thead><tbody>\n<tr><td>1</td></tr>\n</tbody></table>");
  EXPECT_EQ(with_small(evil, evil).html(), harmless + " <small>" + harmless + "</small>");
  EXPECT_EQ(with_small(evil, "").html(), harmless);
  EXPECT_EQ(terms("made", term(evil, evil)).html(),
            "<dl class=\"made\">\n<div><dt>" + harmless + "</dt><dd>" + harmless + "</dd></div>\n</dl>");
  EXPECT_EQ(legend_entry("acne", evil).html(), "<span><i class=\"sw c-acne\"></i>" + harmless + "</span>\n");
  EXPECT_EQ(point_link(-3, evil).html(), "<a href=\"#p-3\">" + harmless + "</a>");
}

}  // namespace
}  // namespace noonmark::report
