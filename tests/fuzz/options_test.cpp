// Every option of every verb that takes a number, with odd numbers: it is refused, or it is the number that was given. The
// options are those of the table of verbs, so a new one is tested by itself.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "app/verbs/option_values.h"
#include "app/verbs/verbs.h"
#include "tests/fuzz/odd_numbers.h"

namespace noonmark::fuzz {
namespace {

// Of a value that is one number; CLI11's own words are those of an option that gives none.
bool takes_a_number(const CLI::Option& option) {
  static const std::set<std::string> kinds = {value_kind::number, value_kind::share, "INT", "UINT", "FLOAT"};
  return kinds.contains(option.get_type_name());
}

TEST(Options, TakeANumberAsItIsOrRefuseIt) {
  int options = 0, taken = 0, refused = 0;
  for (const Verb& row : verb_table()) {
    CLI::App app;
    CLI::App* const verb = app.add_subcommand(row.name, row.help);
    row.add(*verb);
    for (CLI::Option* option : verb->get_options()) {
      if (!takes_a_number(*option)) continue;
      ++options;
      for (const std::string_view odd : odd_numbers) {
        const std::string text(odd), where = std::string(row.name) + " " + option->get_name() + " " + text;
        option->clear();
        option->add_result(text);
        try {
          option->run_callback();
        } catch (const CLI::ParseError& error) {
          EXPECT_NE(std::string(error.what()).find(option->get_name()), std::string::npos)
              << where << ": " << error.what();
          ++refused;
          continue;
        }
        ++taken;
        const auto value = option->as<double>();
        EXPECT_TRUE(std::isfinite(value)) << where;
        EXPECT_EQ(value, std::strtod(text.c_str(), nullptr)) << where;
        EXPECT_GE(value, 0) << where;
      }
    }
  }
  EXPECT_GE(options, 15) << "the kinds of numbers have other names";
  EXPECT_GT(taken, 0);
  EXPECT_GT(refused, 10 * options);
}

}  // namespace
}  // namespace noonmark::fuzz
