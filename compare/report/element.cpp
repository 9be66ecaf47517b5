#include "compare/report/element.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/text.h"
#include "compare/report/escape.h"

namespace noonmark::report {
namespace {

// HTML's own have no end ("void elements" of the HTML standard, section 13.1.2); those of SVG are closed in the tag.
constexpr std::array always_empty{"br", "img", "input"};
constexpr std::array always_empty_in_svg{"line", "rect"};

bool one_of(const auto& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Most texts are numbers and plain words.
bool is_plain(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return c >= ' ' && c <= '~' && c != '&' && c != '<' && c != '>' && c != '"' && c != '\'';
  });
}

}  // namespace

std::string Markup::escaped(std::string_view text) {
  if (is_plain(text)) return std::string(text);
  // nlohmann's writer replaces bytes that are not UTF-8. Reading its text back undoes only its escapes.
  const std::string dumped = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::string valid = nlohmann::json::parse(dumped).get<std::string>();
  std::string out;
  for (std::string_view rest = valid; !rest.empty();) {
    const std::string_view character = rest.substr(0, std::max<size_t>(utf8_length(rest), 1));
    rest.remove_prefix(character.size());
    if (const std::string_view entity = markup_entity(character); !entity.empty())
      out += entity;
    else if (is_control(character) && character != "\n" && character != "\t")
      out += "\uFFFD";
    else
      out += character;
  }
  return out;
}

Markup Markup::unescaped(std::string html) {
  Markup markup;
  markup.html_ = std::move(html);
  return markup;
}

Markup& Markup::operator+=(const Markup& next) {
  html_ += next.html_;
  return *this;
}

Attribute::Attribute(Name name, std::string_view value)
    : html_(fmt::format(" {}=\"{}\"", name.text, Markup(value).html())) {}

Attribute css(std::string_view classes) { return classes.empty() ? Attribute() : Attribute("class", classes); }

Markup element_of(Name name, const Parts& parts) {
  const bool empty = one_of(always_empty, name.text), in_svg = one_of(always_empty_in_svg, name.text);
  if ((empty || in_svg) && !parts.content.empty())
    throw std::logic_error(fmt::format("an element {} has no content", name.text));
  if (empty || in_svg)
    return Markup::unescaped(fmt::format("<{}{}{}", name.text, parts.attributes, in_svg ? "/>" : ">"));
  return Markup::unescaped(fmt::format("<{0}{1}>{2}</{0}>", name.text, parts.attributes, parts.content.html()));
}

Markup joined(const std::vector<Markup>& list, const Markup& between) {
  Markup all;
  for (const Markup& one : list) all += (&one == &list.front() ? Markup() : between) + one;
  return all;
}

}  // namespace noonmark::report
