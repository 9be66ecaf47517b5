#include "tests/fuzz/target.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace noonmark::fuzz {

std::string edit_bytes(const std::string& bytes, Random& random) {
  std::string out = bytes;
  for (size_t edits = 1 + below(random, 4); edits > 0; --edits) {
    if (out.empty()) return std::string(1, static_cast<char>(random()));
    const size_t at = below(random, out.size());
    switch (below(random, 6)) {
      case 0:
        out[at] = static_cast<char>(random());
        break;
      case 1:
        out[at] = static_cast<char>(out[at] ^ 1 << below(random, 8));
        break;
      case 2:
        out.erase(at, 1 + below(random, 8));
        break;
      case 3:
        out.insert(at, out.substr(below(random, out.size()), 1 + below(random, 16)));
        break;
      case 4:
        out[at] = "0123456789-.eE\"[]{},:"[below(random, 21)];
        break;
      default:
        out.replace(at, 4, below(random, 2) == 0 ? std::string(4, '\xff') : std::string(4, '\0'));
        break;
    }
  }
  return out;
}

std::string edit_text(const std::string& text, Random& random, std::span<const std::string> words,
                      const EditBytes& edit) {
  static const std::vector<std::string> odd = {"0",  "-1",   "1e308", "nan",   "inf", "[]",
                                               "{}", "true", "''",    "[[0]]", "1"};
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  if (lines.empty() || below(random, 4) == 0) return edit(text, random);
  const auto word = [&] {
    return below(random, 3) == 0 || words.empty() ? odd[below(random, odd.size())] : words[below(random, words.size())];
  };
  for (size_t edits = 1 + below(random, 4); edits > 0 && !lines.empty(); --edits) {
    const size_t at = below(random, lines.size()), other = below(random, lines.size());
    std::string& line = lines[at];
    switch (below(random, 7)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1: {
        const std::string copy = line;
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(other), copy);
        break;
      }
      case 2:
        std::swap(line, lines[other]);
        break;
      case 3:  // another value: one of the format's words, or the value of another line
        line = line.substr(0, line.find('=')) + "= " +
               (below(random, 2) == 0 ? word() : lines[other].substr(lines[other].find('=') + 1));
        break;
      case 4:
        line.insert(below(random, line.size() + 1), word());
        break;
      case 5:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), word() + " = " + word());
        break;
      default:
        line = edit(line, random);
        break;
    }
  }
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

Folder::Folder() {
  path_ = (std::filesystem::temp_directory_path() / "noonmark-fuzz-XXXXXX").string();
  if (!::mkdtemp(path_.data())) throw std::runtime_error("cannot make the folder " + path_);
}

Folder::~Folder() {
  std::error_code none;
  std::filesystem::remove_all(path_, none);
}

void Folder::write(const std::string& name, std::string_view bytes) const {
  std::filesystem::remove(file(name));  // overwriting a file makes some file systems wait for the disk
  std::ofstream out(file(name), std::ios::binary);
  out << bytes;
  if (!out.flush()) throw std::runtime_error("cannot write " + file(name));
}

}  // namespace noonmark::fuzz
