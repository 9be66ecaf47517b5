// What is fuzzed, for both drivers: libfuzzer_main.cpp (clang, preset `fuzz`) and replay_test.cpp (every test run). A
// target is one file, <name>_target.cpp, one line in targets.h and one in CMakeLists.txt.
//
//   target.run(bytes);                              // throws if a result is not allowed; catches the allowed errors
//   std::string next = target.mutate(bytes, random, edit_bytes);
#pragma once
#include <functional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark::fuzz {

using Random = std::mt19937;

// Mutations of bytes without knowledge of the format: libFuzzer's own, or edit_bytes().
using EditBytes = std::function<std::string(const std::string&, Random&)>;

struct Target {
  std::string_view name;
  // One execution. Every exception is a finding.
  void (*run)(const std::string& bytes);
  // The inputs at which mutation starts. Code makes them, so that they follow changes of the formats.
  std::vector<std::string> (*seeds)();
  // Words of the format, for libFuzzer's dictionary.
  std::vector<std::string> (*words)();
  // Mutations with knowledge of the format; null: only bytes are mutated.
  std::string (*mutate)(const std::string& bytes, Random& random, const EditBytes& edit);
};

// A property that did not hold.
struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};
inline void require(bool holds, const std::string& what) {
  if (!holds) throw Broken(what);
}

// One to four random edits.
std::string edit_bytes(const std::string& bytes, Random& random);

// Doubles, removes or moves lines, replaces their values, or inserts words; or calls `edit`.
std::string edit_text(const std::string& text, Random& random, std::span<const std::string> words,
                      const EditBytes& edit);

// Target::mutate of a text, with the target's own words.
template <auto words>
std::string mutate_text(const std::string& text, Random& random, const EditBytes& edit) {
  static const std::vector<std::string> known = words();
  return edit_text(text, random, known, edit);
}

inline size_t below(Random& random, size_t n) { return static_cast<size_t>(random() % n); }

// A folder of this process below TMPDIR. It is removed at the end, unless a signal ends the process.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  // Replaces the file. Unlike the program's own files, it is not flushed to the disk.
  void write(const std::string& name, std::string_view bytes) const;

 private:
  std::string path_;
};

}  // namespace noonmark::fuzz
