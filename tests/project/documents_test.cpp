// Everything that documents and comments refer to must exist: files of this repository, chapters, settings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/file.h"
#include "compare/results/quantities.h"
#include "frames/frame_keys.h"
#include "technique/settings.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

const fs::path root = noonmark::test::source_dir();
const std::vector<std::string> folders = {"app",      "base",        "cmake",     "compare", "docs",
                                          "examples", "experiments", "gl",        "measure", "raytrace",
                                          "scenes",   "scripts",     "technique", "tests"};

std::string text_of(const fs::path& file) { return read_file(file.string(), uint64_t{1} << 24); }

// Documents for human readers. CHANGELOG.md is not among them, because it names files that no longer exist.
std::vector<fs::path> documents() {
  std::vector<fs::path> files = {root / "README.md", root / "CONTRIBUTING.md"};
  for (const char* folder : {"docs", "examples"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") files.push_back(entry.path());
  return files;
}

// Every file with text that people write, except patches and the test that plants files.
std::vector<fs::path> all_texts() {
  const std::set<std::string> endings = {".h",    ".cpp", ".glsl", ".vert", ".frag", ".geom", ".cmake", ".txt",
                                         ".toml", ".js",  ".css",  ".md",   ".in",   ".yml",  ""};
  std::vector<fs::path> files = {root / "README.md", root / "CONTRIBUTING.md", root / "CMakeLists.txt"};
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path& path = entry.path();
      if (entry.is_regular_file() && endings.contains(path.extension().string()) &&
          path.string().find("tests/fuzz/regressions") == std::string::npos &&
          path.filename() != "include_law_test.cmake")
        files.push_back(path);
    }
  return files;
}

std::vector<std::string> path_like_words(const std::string& text) {
  std::vector<std::string> words(1);
  for (char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("_/.*-").find(c) != std::string_view::npos)
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  for (std::string& word : words)
    while (word.ends_with('.')) word.pop_back();
  return words;
}

// "*" stands for any characters within one name.
bool matches(std::string_view name, std::string_view pattern) {
  const size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  if (!name.starts_with(pattern.substr(0, star))) return false;
  for (size_t skipped = star; skipped <= name.size(); ++skipped)
    if (matches(name.substr(skipped), pattern.substr(star + 1))) return true;
  return false;
}

bool is_there(const std::string& path) {
  if (path.find('*') == std::string::npos) return fs::exists(root / path);
  const fs::path pattern(path);
  if (!fs::is_directory(root / pattern.parent_path())) return false;
  for (const auto& entry : fs::directory_iterator(root / pattern.parent_path()))
    if (matches(entry.path().filename().string(), pattern.filename().string())) return true;
  return false;
}

bool begins_with_a_folder(const std::string& word) {
  return std::any_of(folders.begin(), folders.end(),
                     [&](const std::string& folder) { return word.starts_with(folder + "/"); });
}

TEST(Documents, EveryFileThatIsNamedIsThere) {
  int named = 0;
  for (const fs::path& file : all_texts())
    for (const std::string& word : path_like_words(text_of(file))) {
      if (!begins_with_a_folder(word)) continue;
      const std::string ending = fs::path(word).extension().string();
      if (ending.size() < 2 || !std::isalpha(static_cast<unsigned char>(ending[1]))) continue;
      if (ending == ".gltf") continue;  // a model of a corpus outside the repository, which has a folder base/ too
      if (word.starts_with("examples/jsm/")) continue;  // of three.js's repository
      ++named;
      EXPECT_TRUE(is_there(word) || fs::exists(file.parent_path() / word))
          << fs::relative(file, root).string() << " names " << word;
    }
  EXPECT_GT(named, 1000);
}

// The texts between backticks in one line, such as "`app/`" and "`tests/fuzz/*_target.cpp`".
std::vector<std::string> in_backticks(const std::string& markdown) {
  std::vector<std::string> words;
  bool fenced = false;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    if (fenced || line.starts_with("```")) continue;
    for (size_t open = line.find('`'); open != std::string::npos;) {
      const size_t close = line.find('`', open + 1);
      if (close == std::string::npos) break;
      words.push_back(line.substr(open + 1, close - open - 1));
      open = line.find('`', close + 1);
    }
  }
  return words;
}

TEST(Documents, EveryFolderThatIsNamedIsThere) {
  for (const fs::path& file : documents())
    for (const std::string& word : in_backticks(text_of(file)))
      if (begins_with_a_folder(word) && word.find_first_of("<> :") == std::string::npos) {
        EXPECT_TRUE(is_there(word)) << fs::relative(file, root).string() << " names " << word;
      }
}

// If a setting is renamed, its old name must not remain anywhere.
TEST(Documents, EverySettingThatIsNamedIsThere) {
  std::set<std::string> groups, names;
  for (const Setting& row : settings_table()) {
    groups.insert(std::string(row.name.substr(0, row.name.find('.'))));
    names.insert(std::string(row.name));
  }
  for (const FrameKey& key : frame_keys()) names.insert(fmt::format("{}.{}", key.object, key.name));
  names.insert(cascade_number_names().begin(), cascade_number_names().end());
  const std::set<std::string> endings = {".h", ".cpp", ".exr", ".glb", ".glsl"};
  for (const fs::path& file : documents())
    for (const std::string& word : in_backticks(text_of(file))) {
      const std::string name = word.substr(0, word.find_first_of(" =\""));
      const size_t dot = name.find('.');
      if (dot == std::string::npos || !groups.contains(name.substr(0, dot))) continue;
      if (endings.contains(name.substr(dot)) || name.find_first_of("*<") != std::string::npos) continue;
      EXPECT_TRUE(names.contains(name)) << fs::relative(file, root).string() << " names " << word;
    }
}

// Comments may cite only documents of this repository. `check` writes summary.md, so it is an exception.
TEST(Documents, EveryDocumentThatIsCitedIsThere) {
  for (const fs::path& file : all_texts())
    for (const std::string& word : path_like_words(text_of(file)))
      if (word.ends_with(".md") && word != ".md" && fs::path(word).filename() != "summary.md") {
        const std::string from_root = word.substr(word.find_first_not_of('/'));
        EXPECT_TRUE(fs::exists(root / from_root) || fs::exists(file.parent_path() / word))
            << fs::relative(file, root).string() << " cites " << word;
      }
}

// A heading without its links and marks: "[R0](#r0) and `x`" is "R0 and x".
std::string plain(const std::string& heading) {
  const std::string linked = std::regex_replace(heading, std::regex("\\[([^\\]]*)\\]\\([^)]*\\)"), "$1");
  return std::regex_replace(linked, std::regex("[`*]"), "");
}

// The anchor that GitHub makes of a heading.
std::string anchor_of_github(std::string_view heading) {
  std::string anchor;
  for (char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '_' || c == '-' || byte >= 0x80) anchor += static_cast<char>(std::tolower(byte));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

// The anchor that mkdocs makes of it: ASCII only, and several spaces or hyphens are one hyphen.
std::string anchor_of_mkdocs(std::string_view heading) {
  std::string anchor;
  for (char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) || c == '_')) anchor += static_cast<char>(std::tolower(byte));
    if ((c == ' ' || c == '-') && !anchor.empty() && anchor.back() != '-') anchor += '-';
  }
  while (anchor.ends_with('-')) anchor.pop_back();
  return anchor;
}

// The anchors of a document that are the same on GitHub and in the site that scripts/docs builds.
std::set<std::string> anchors_of(const std::string& markdown) {
  std::set<std::string> anchors, twice;
  bool fenced = false;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    const size_t text = line.find_first_not_of('#');
    if (fenced || text == 0 || text == std::string::npos || line[text] != ' ') continue;
    const std::string heading = plain(line.substr(text + 1));
    const std::string anchor = anchor_of_github(heading);
    if (anchor == anchor_of_mkdocs(heading) && !anchors.insert(anchor).second) twice.insert(anchor);
  }
  for (const std::string& anchor : twice) anchors.erase(anchor);  // the second heading gets another one
  return anchors;
}

// The targets of the links and pictures of a document: "[text](target)".
std::vector<std::string> links_of(const std::string& markdown) {
  std::vector<std::string> links;
  bool fenced = false;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(' ') != std::string::npos && line.substr(line.find_first_not_of(' ')).starts_with("```"))
      fenced = !fenced;
    if (fenced) continue;
    for (size_t at = line.find("]("); at != std::string::npos; at = line.find("](", at + 1))
      links.push_back(line.substr(at + 2, line.find(')', at) - at - 2));
  }
  return links;
}

TEST(Documents, EveryLinkLeadsSomewhere) {
  int links = 0, anchors = 0;
  for (const fs::path& file : documents())
    for (const std::string& link : links_of(text_of(file))) {
      const std::string where = fs::relative(file, root).string() + " links to " + link;
      if (link.starts_with("http")) continue;
      ++links;
      const size_t hash = link.find('#');
      const fs::path target = hash == 0 ? file : file.parent_path() / link.substr(0, hash);
      EXPECT_TRUE(fs::is_regular_file(target)) << where << ": no such file (a folder has no page)";
      if (hash == std::string::npos || !fs::is_regular_file(target)) continue;
      ++anchors;
      EXPECT_TRUE(anchors_of(text_of(target)).contains(link.substr(hash + 1)))
          << where << ": no heading has this anchor, on GitHub and in the site";
    }
  EXPECT_GT(links, 100);
  EXPECT_GT(anchors, 30);
}

// GitHub reads more than mkdocs does: a list begins after an empty line, and what is in an item is 4 spaces further in.
TEST(Documents, EveryListIsReadByMkdocs) {
  const std::regex item("(- |[0-9]+\\. ).*"), before("(- |[0-9]+\\. |#| ).*|");
  for (const fs::path& file : documents()) {
    bool fenced = false;
    std::string last;
    std::istringstream lines(text_of(file));
    for (std::string line; std::getline(lines, line); last = line) {
      if (line.starts_with("```")) fenced = !fenced;
      EXPECT_FALSE(!fenced && std::regex_match(line, std::regex(" {1,3}(- |[|]).*")))
          << fs::relative(file, root).string() << ": " << line;
      if (fenced || !std::regex_match(line, item)) continue;
      EXPECT_TRUE(std::regex_match(last, before)) << fs::relative(file, root).string() << ": " << line;
    }
  }
}

// The pages that mkdocs.yml names: the words of its lines that end in .md.
std::set<std::string> pages_of_the_site() {
  std::set<std::string> pages;
  for (const std::string& word : path_like_words(text_of(root / "mkdocs.yml")))
    if (word.ends_with(".md")) pages.insert(word);
  return pages;
}

TEST(Documents, EveryPageStandsInTheSiteAndInReadme) {
  const std::set<std::string> pages = pages_of_the_site();
  for (const std::string& page : pages) EXPECT_TRUE(fs::exists(root / page)) << "mkdocs.yml names " << page;
  std::set<std::string> linked;
  for (const std::string& link : links_of(text_of(root / "README.md"))) linked.insert(link);
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() != ".md") continue;
    const std::string page = fs::relative(entry.path(), root).string();
    EXPECT_TRUE(pages.contains(page)) << "mkdocs.yml lacks " << page;
    EXPECT_TRUE(linked.contains(page)) << "README.md does not link to " << page;
  }
}

// Longer documents are not read to their end.
TEST(Documents, EveryPageIsShort) {
  size_t all = 0;
  for (const fs::path& file : documents()) {
    const std::string text = text_of(file);
    all += text.size();
    EXPECT_LE(text.size(), size_t{12} << 10) << fs::relative(file, root).string();
  }
  EXPECT_LE(all, 400'000u);
  std::istringstream words(text_of(root / "README.md"));
  EXPECT_LE(std::distance(std::istream_iterator<std::string>(words), {}), 1200);
}

}  // namespace
}  // namespace noonmark
