// The table of verbs, as the parser, the help and the completion see it.
#include "app/verbs/verbs.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "app/verbs/command_line.h"
#include "app/verbs/option_values.h"
#include "compare/ladder/bias_curves.h"
#include "measure/phase_diagram.h"

namespace noonmark {
namespace {

// What CLI11 knows of a verb.
class Added {
 public:
  explicit Added(const Verb& row) : verb_(program_.add_subcommand(row.name, row.help)), run_(row.add(*verb_)) {}

  std::vector<const CLI::Option*> options() const { return std::as_const(*verb_).get_options(); }
  std::string default_of(const std::string& option) const { return verb_->get_option(option)->get_default_str(); }

 private:
  CLI::App program_;
  CLI::App* verb_;
  RunVerb run_;
};

const Verb& row_of(std::string_view name) {
  for (const Verb& row : verb_table())
    if (name == row.name) return row;
  throw std::logic_error("no such verb");
}

TEST(Verbs, EachHasItsOwnNameAndALineOfHelp) {
  std::set<std::string> names;
  for (const Verb& row : verb_table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    const std::string help = row.help;
    EXPECT_GT(help.size(), 10u) << row.name;
    EXPECT_EQ(help.find('\n'), std::string::npos) << row.name;
    EXPECT_FALSE(help.ends_with('.')) << row.name;
    EXPECT_LE(help.size(), 86u) << row.name << ": more than a line of the help";
    EXPECT_NE(std::string(row.heading), "") << row.name;
  }
}

// Each word that begins with -- is an option of the verb.
TEST(Verbs, TheExampleIsACommandOfTheVerb) {
  for (const Verb& row : verb_table()) {
    std::istringstream words(row.example);
    std::string program, verb;
    words >> program >> verb;
    EXPECT_EQ(program + " " + verb, std::string("noonmark ") + row.name);
    const Added added(row);
    for (std::string word; words >> word;)
      if (word.starts_with("--")) {
        EXPECT_NO_THROW((void)added.default_of(word)) << row.example;
      }
  }
}

// The help adds "(default: ...)" from CLI11's default string, which comes from the member. A text of its own could differ.
TEST(Verbs, NoTextOfAnOptionRepeatsItsDefault) {
  size_t defaults = 0;
  for (const Verb& row : verb_table())
    for (const Added added(row); const CLI::Option* option : added.options()) {
      EXPECT_EQ(option->get_description().find("default:"), std::string::npos) << row.name << " " << option->get_name();
      EXPECT_FALSE(option->get_description().empty()) << row.name << " " << option->get_name();
      defaults += !option->get_default_str().empty();
    }
  EXPECT_GE(defaults, 10u);
}

TEST(Verbs, TheDefaultsOfTheHelpAreThoseOfTheMembers) {
  const Added map(row_of("map"));
  const PhaseOptions phase;
  EXPECT_EQ(map.default_of("--rows"), std::to_string(phase.rows));
  EXPECT_EQ(map.default_of("--from"), std::to_string(phase.coarsest));
  EXPECT_EQ(map.default_of("--to"), std::to_string(phase.finest));
  EXPECT_EQ(map.default_of("--placements"), std::to_string(phase.placements));
  EXPECT_NEAR(std::stod(map.default_of("--acne")), 100 * phase.acne_bound, 1e-12);
  EXPECT_TRUE(map.default_of("--acne").ends_with('%'));
  EXPECT_NEAR(std::stod(map.default_of("--peter-panning")), 100 * phase.peter_panning_bound, 1e-12);
  const Added recommend(row_of("recommend"));
  EXPECT_NEAR(std::stod(recommend.default_of("--acne")), 100 * CurveOptions().acne_bound, 1e-12);
  EXPECT_EQ(recommend.default_of("--out"),
            "out/recommend-plate for plate, out/checks/recommend-helmet for "
            "checks/helmet.toml");
}

TEST(Verbs, ListsMayHaveBlanksBesideTheirCommas) {
  EXPECT_EQ(words_of({"vsm, msm", " esm ,evsm4 ", "compare"}),
            (std::vector<std::string>{"vsm", "msm", "esm", "evsm4", "compare"}));
  const CLI::Validator list = noonmark::list_of(std::vector<std::string>{"vsm", "msm"});
  EXPECT_EQ(list("vsm, msm"), "");
  EXPECT_NE(list("vsm, ,msm"), "") << "a comma without a name";
  EXPECT_NE(list("vsm msm"), "") << "a blank is no comma";
}

TEST(Verbs, TheVocabularyHasEveryOptionThatTakesAValue) {
  const Vocabulary vocabulary = CommandLine().vocabulary();
  EXPECT_EQ(vocabulary.verbs.size(), verb_table().size());
  for (const char* option : {"--set", "--out", "--views", "--error", "--budget", "--baseline-times", "--shard"})
    EXPECT_TRUE(vocabulary.options_with_a_value.contains(option)) << option;
  for (const char* flag : {"--help", "--json", "--overwrite", "--dry-run", "--cascades"})
    EXPECT_FALSE(vocabulary.options_with_a_value.contains(flag)) << flag;
}

}  // namespace
}  // namespace noonmark
