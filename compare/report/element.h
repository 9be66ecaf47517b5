// HTML as a type of its own, and the builder that makes it. A text becomes markup by a conversion that escapes it, so it is
// escaped once: markup is no text, and is never escaped again. Without escaping there is only Markup::unescaped().
//
//   tr(css(held ? "held" : "broken"), row_head(point_link(4, "4")), td("a < b"), td(17));
//   paragraph(css("small"), prose("{} of {} points are in {}.", 3, count, code("results.csv")));
#pragma once
#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace noonmark::report {

template <class Number>
concept WholeNumber = std::integral<Number> && !std::same_as<Number, bool> && !std::same_as<Number, char>;

class Markup {
 public:
  Markup() = default;
  // Text for people, of any origin. Bytes that are not UTF-8, and control characters except line breaks and tabs, become
  // U+FFFD.
  template <std::convertible_to<std::string_view> Text>
  Markup(const Text& text) : html_(escaped(text)) {}
  template <WholeNumber Number>
  Markup(Number number) : html_(fmt::format("{}", number)) {}
  // What is markup already. Never for text from outside.
  static Markup unescaped(std::string html);

  const std::string& html() const { return html_; }
  bool empty() const { return html_.empty(); }
  Markup& operator+=(const Markup& next);
  friend Markup operator+(Markup first, const Markup& next) { return std::move(first += next); }
  friend bool operator==(const Markup&, const Markup&) = default;

 private:
  static std::string escaped(std::string_view text);
  std::string html_;
};

// The name of an element or of an attribute: a literal of letters, digits and hyphens.
struct Name {
  std::string_view text;
  consteval Name(const char* literal) : text(literal) {
    for (const char c : text)
      if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '-')
        throw "a name in HTML has letters, digits and hyphens";
  }
};

class Attribute {
 public:
  Attribute(Name name, std::string_view value);
  template <WholeNumber Number>
  Attribute(Name name, Number value) : Attribute(name, fmt::format("{}", value)) {}
  // An attribute without a value ("open", "checked"), or none.
  template <std::same_as<bool> Flag>
  Attribute(Name name, Flag present) : html_(present ? fmt::format(" {}", name.text) : "") {}
  const std::string& html() const { return html_; }  // with the space before it

 private:
  friend Attribute css(std::string_view classes);
  Attribute() = default;
  std::string html_;
};

// The attribute class. None if there is no class: css(held ? "" : "broken").
Attribute css(std::string_view classes);

// What an element consists of: attributes, and then its content.
struct Parts {
  std::string attributes;
  Markup content;
  void add(const Attribute& attribute) { attributes += attribute.html(); }
  void add(const Markup& part) { content += part; }
};
Markup element_of(Name name, const Parts& parts);

// An element of attributes, markup and text, in any number. Elements that are always empty (br, img) have no end.
template <class... Each>
Markup element(Name name, const Each&... each) {
  Parts parts;
  (parts.add(each), ...);
  return element_of(name, parts);
}

// The elements that a report is mostly made of. A row and a paragraph end their line.
template <class... Each>
Markup td(const Each&... each) {
  return element("td", each...);
}
template <class... Each>
Markup th(const Each&... each) {
  return element("th", each...);
}
// The head of a row.
template <class... Each>
Markup row_head(const Each&... each) {
  return element("th", each..., Attribute("scope", "row"));
}
template <class... Each>
Markup tr(const Each&... each) {
  return element("tr", each...) + "\n";
}
template <class... Each>
Markup paragraph(const Each&... each) {
  return element("p", each...) + "\n";
}
template <class... Each>
Markup div(const Each&... each) {
  return element("div", each...);
}
template <class... Each>
Markup span(const Each&... each) {
  return element("span", each...);
}
inline Markup bold(const Markup& content) { return element("b", content); }
inline Markup italic(const Markup& content) { return element("i", content); }
inline Markup small(const Markup& content) { return element("small", content); }
inline Markup code(const Markup& content) { return element("code", content); }
inline Markup line_break() { return element("br"); }

Markup joined(const std::vector<Markup>& list, const Markup& between);

// What stands in a text for a value: a number for its format, anything else as markup.
template <class Value>
auto in_prose(const Value& value) {
  if constexpr (WholeNumber<Value> || std::floating_point<Value>)
    return value;
  else
    return Markup(value).html();
}

// A literal with places for values. One that holds a tag, or a character that has to be escaped, does not compile.
template <class... Values>
struct Prose {
  fmt::format_string<decltype(in_prose(std::declval<Values>()))...> format;
  consteval Prose(const char* literal) : format(literal) {
    for (const char* c = literal; *c; ++c)
      if (*c == '<' || *c == '>' || *c == '&') throw "a literal has no markup; give an element as a value";
  }
};

// A sentence with values, texts and elements in it, as fmt::format: prose("{:.1f} of {}", 0.5, code("a.csv")).
template <class... Values>
Markup prose(std::type_identity_t<Prose<Values...>> literal, const Values&... values) {
  return Markup::unescaped(fmt::format(literal.format, in_prose(values)...));
}

}  // namespace noonmark::report
