#include "compare/judge/formula.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string_view>

#include "base/error.h"

namespace noonmark {
namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr const char* name_characters = "0123456789_.@abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

constexpr const char* functions =
    "sin cos tan asin acos atan atan2 sin_deg cos_deg tan_deg atan_deg hypot sqrt exp ln log2 log10 abs min max floor";

// muParser assigns to variables with a lone '='.
bool assigns(const std::string& text) {
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos) return true;
  }
  return false;
}

}  // namespace

struct Formula::Impl {
  std::string text;
  mu::Parser parser;
  std::map<std::string, double> values;  // muParser keeps pointers into it
  std::vector<std::string> names;
};

Formula::Formula(const std::string& text) : impl_(std::make_unique<Impl>()) {
  impl_->text = text;
  mu::Parser& parser = impl_->parser;
  if (assigns(text)) throw Error(ErrorKind::usage, fmt::format("the formula '{}' assigns; compare with ==", text));
  try {
    parser.ClearFun();  // muParser's own list has functions not documented here; its log changed base between versions
    parser.ClearConst();
    parser.DefineNameChars(name_characters);
    parser.DefineConst("pi", std::numbers::pi);
    const auto define = [&](const char* name, double (*function)(double)) { parser.DefineFun(name, function); };
    define("sin", [](double x) { return std::sin(x); });
    define("cos", [](double x) { return std::cos(x); });
    define("tan", [](double x) { return std::tan(x); });
    define("asin", [](double x) { return std::asin(x); });
    define("acos", [](double x) { return std::acos(x); });
    define("atan", [](double x) { return std::atan(x); });
    define("sin_deg", [](double x) { return std::sin(x * degree); });
    define("cos_deg", [](double x) { return std::cos(x * degree); });
    define("tan_deg", [](double x) { return std::tan(x * degree); });
    define("atan_deg", [](double x) { return std::atan(x) / degree; });
    define("sqrt", [](double x) { return std::sqrt(x); });
    define("exp", [](double x) { return std::exp(x); });
    define("ln", [](double x) { return std::log(x); });
    define("log2", [](double x) { return std::log2(x); });
    define("log10", [](double x) { return std::log10(x); });
    define("abs", [](double x) { return std::abs(x); });
    define("floor", [](double x) { return std::floor(x); });
    parser.DefineFun(
        "atan2", +[](double y, double x) { return std::atan2(y, x); });
    parser.DefineFun(
        "hypot", +[](double x, double y) { return std::hypot(x, y); });
    parser.DefineFun(
        "min", +[](const double* x, int count) { return *std::min_element(x, x + count); });
    parser.DefineFun(
        "max", +[](const double* x, int count) { return *std::max_element(x, x + count); });
    parser.SetExpr(text);
    for (const auto& [name, pointer] : parser.GetUsedVar()) impl_->names.push_back(name);
    for (const std::string& name : impl_->names) parser.DefineVar(name, &impl_->values[name]);
    parser.Eval();  // finds what parsing does not: a wrong number of arguments, several results
    if (parser.GetNumResults() != 1)
      throw Error(ErrorKind::usage, fmt::format("the formula '{}' has several values; write one", text));
  } catch (const mu::Parser::exception_type& error) {
    throw Error(ErrorKind::usage,
                fmt::format("the formula '{}' cannot be read: {} (functions: {})", text, error.GetMsg(), functions));
  }
}

Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;

const std::vector<std::string>& Formula::names() const { return impl_->names; }

double Formula::value(const std::function<double(const std::string&)>& value_of) const {
  bool known = true;  // min, max and comparisons would drop a NaN
  for (auto& [name, value] : impl_->values) {
    value = value_of(name);
    known = known && !std::isnan(value);
  }
  if (!known) return std::numeric_limits<double>::quiet_NaN();
  try {
    return impl_->parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw Error(ErrorKind::usage, fmt::format("the formula '{}' has no value: {}", impl_->text, error.GetMsg()));
  }
}

}  // namespace noonmark
