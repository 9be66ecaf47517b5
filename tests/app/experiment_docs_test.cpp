// The documents on experiment files. The program must read their examples like a user's file, and refuse their mistakes with the
// message that stands there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "base/file.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

std::string document(const std::string& name) {
  return read_file(noonmark::test::source_dir() + "/" + name, uint64_t{1} << 24);
}

struct Block {
  std::string language;  // the word after the opening fence: "toml", "toml-refused", "text" ...
  std::string text;
  int line = 0;  // number of the fence's line, from 1
};

std::vector<Block> blocks_of(const std::string& markdown) {
  std::vector<Block> blocks;
  size_t indent = std::string::npos;  // of the block's fences; of none outside
  int number = 0;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const size_t text = line.find_first_not_of(' ');
    const bool inside = indent != std::string::npos;
    if (text != std::string::npos && line.compare(text, 3, "```") == 0) {
      if (!inside) blocks.push_back({line.substr(text + 3), "", number});
      indent = inside ? std::string::npos : text;
    } else if (inside) {
      blocks.back().text += line.substr(std::min(indent, line.size())) + "\n";
    }
  }
  EXPECT_EQ(indent, std::string::npos) << "the last code block has no end";
  return blocks;
}

// The error message for the text; empty if the text can be read.
std::string refusal(const std::string& toml) {
  return refusal_of(ErrorKind::usage, [&] { points(parse_experiment(toml, "shadows.toml")); });
}

TEST(ExperimentDocuments, EveryExampleIsRead) {
  int examples = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(noonmark::test::source_dir() + "/docs")) {
    if (entry.path().extension() != ".md") continue;
    const std::string name =
        "docs/" + std::filesystem::relative(entry.path(), noonmark::test::source_dir() + "/docs").string();
    for (const Block& block : blocks_of(document(name))) {
      if (block.language != "toml") continue;
      ++examples;
      EXPECT_EQ(refusal(block.text), "") << name << ":" << block.line;
    }
  }
  EXPECT_GT(examples, 20);
}

// What stands between backticks outside of the blocks: "map.snap = true". It may go on in the next line, not in the next
// paragraph.
std::vector<std::string> codes_of(const std::string& markdown) {
  std::vector<std::string> codes;
  std::string paragraph;
  bool fenced = false;
  const auto end = [&] {
    for (size_t open = paragraph.find('`'); open != std::string::npos;) {
      const size_t close = paragraph.find('`', open + 1);
      if (close == std::string::npos) break;
      codes.push_back(paragraph.substr(open + 1, close - open - 1));
      open = paragraph.find('`', close + 1);
    }
    paragraph.clear();
  };
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    const size_t text = std::min(line.find_first_not_of(' '), line.size());
    const bool fence = line.compare(text, 3, "```") == 0;
    if (fence) fenced = !fenced;
    if (fence || fenced || text == line.size())
      end();
    else
      paragraph += (paragraph.empty() ? "" : " ") + line.substr(text);
  }
  end();
  return codes;
}

// The experiment of one code: "name = value" or "--set name=value --set name=value"; empty if it gives no setting. A line
// writes a word with and without quotes.
std::string given_by(const std::string& code) {
  std::string toml;
  const std::regex given("(?:^|--set )([a-z_]+\\.[a-z_]+) ?= ?(\"[^\"]*\"|[^ ].*?)(?= --set |$)");
  for (std::sregex_iterator found(code.begin(), code.end(), given), end; found != end; ++found) {
    const std::string name = (*found)[1], value = (*found)[2];
    const std::span<const Setting> rows = settings_table();
    if (std::none_of(rows.begin(), rows.end(), [&](const Setting& row) { return row.name == name; })) continue;
    const bool word = std::isalpha(static_cast<unsigned char>(value[0])) && value != "true" && value != "false";
    toml += fmt::format("{}{} = {}{}{}\n", value.starts_with("[[") ? "[over]\n" : "", name, word ? "\"" : "", value,
                        word ? "\"" : "");
  }
  return toml;
}

// What a reader types from a line works by itself, without what stands in the lines around it.
TEST(ExperimentDocuments, EverySettingThatALineGivesIsRead) {
  int given = 0;
  std::vector<std::string> pages = {"README.md", "docs/tutorial/own-model.md"};
  for (const auto& entry : std::filesystem::directory_iterator(noonmark::test::source_dir() + "/docs/how-to"))
    pages.push_back("docs/how-to/" + entry.path().filename().string());
  for (const std::string& page : pages)
    for (const std::string& code : codes_of(document(page))) {
      const std::string toml = given_by(code);
      if (toml.empty()) continue;
      ++given;
      EXPECT_EQ(refusal(toml), "") << page << ": `" << code << "`";
    }
  EXPECT_GT(given, 10);
}

// A block "toml-refused" is followed by a block "text" that holds the message.
TEST(ExperimentDocuments, EveryMistakeIsRefusedWithTheMessageGiven) {
  const std::vector<Block> blocks = blocks_of(document("docs/reference/experiment.md"));
  int mistakes = 0;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].language != "toml-refused") continue;
    ++mistakes;
    ASSERT_LT(i + 1, blocks.size());
    EXPECT_EQ(refusal(blocks[i].text) + "\n", blocks[i + 1].text) << "docs/reference/experiment.md:" << blocks[i].line;
  }
  EXPECT_GT(mistakes, 0);
}

}  // namespace
}  // namespace noonmark
