// Runs every target on its seeds, on the inputs that once broke it (regressions/<target>/), and on a few hundred
// mutants that are the same each time. scripts/fuzz continues with clang's libFuzzer.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/file.h"
#include "tests/fuzz/targets.h"
#include "tests/support/source_dir.h"

namespace noonmark::fuzz {
namespace {

// mutants: the number of mutants in one run, so that each target takes about a second.
struct Replay {
  const Target* target;
  int mutants;
};
std::ostream& operator<<(std::ostream& out, const Replay& replay) { return out << replay.target->name; }

// An assertion of a library ends the program: then the input is printed at which it did.
std::string input_at_hand;
void print_input(int signal) {
  const auto written = ::write(STDERR_FILENO, input_at_hand.data(), input_at_hand.size());
  std::signal(signal, SIG_DFL);
  std::raise(written < 0 ? SIGABRT : signal);
}

class Fuzz : public ::testing::TestWithParam<Replay> {
 protected:
  void run(const std::string& bytes, const std::string& what) {
    input_at_hand = "\n" + what + ":\n" + bytes + "\n";
    for (const int signal : {SIGABRT, SIGSEGV}) std::signal(signal, print_input);
    try {
      GetParam().target->run(bytes);
    } catch (const std::exception& error) {
      // The name is unique, because several of these programs may run at the same time.
      const std::string file =
          testing::TempDir() + "fuzz-" + std::string(GetParam().target->name) + "-" + std::to_string(::getpid());
      std::ofstream(file, std::ios::binary) << bytes;
      ADD_FAILURE() << what << " (written to " << file << "): " << error.what();
    }
  }
};

TEST_P(Fuzz, SeedsAndWhatOnceBroke) {
  const std::vector<std::string> seeds = GetParam().target->seeds();
  ASSERT_FALSE(seeds.empty());
  for (size_t i = 0; i < seeds.size(); ++i) run(seeds[i], "seed " + std::to_string(i));
  const std::filesystem::path folder =
      std::filesystem::path(noonmark::test::source_dir()) / "tests/fuzz/regressions" / GetParam().target->name;
  std::set<std::filesystem::path> files;
  if (std::filesystem::exists(folder))  // a target without a known failure has no folder
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.insert(entry.path());
  for (const std::filesystem::path& file : files) run(read_file(file.string()), file.filename().string());
}

// NOONMARK_FUZZ_MUTANTS sets another number of mutants, with another seed.
TEST_P(Fuzz, Mutants) {
  const Target& target = *GetParam().target;
  const std::vector<std::string> seeds = target.seeds();
  const char* asked = std::getenv("NOONMARK_FUZZ_MUTANTS");
  const int mutants = asked ? std::stoi(asked) : GetParam().mutants;
  Random random(asked ? std::random_device()() : 20240611);
  for (int i = 0; i < mutants && !HasFailure(); ++i) {
    std::string bytes = seeds[below(random, seeds.size())];
    for (size_t rounds = 1 + below(random, 3); rounds > 0; --rounds)
      bytes = target.mutate ? target.mutate(bytes, random, edit_bytes) : edit_bytes(bytes, random);
    run(bytes, "mutant " + std::to_string(i));
  }
}

INSTANTIATE_TEST_SUITE_P(Target, Fuzz,
                         ::testing::Values(Replay{&gltf_target, 5000}, Replay{&experiment_target, 3000},
                                           Replay{&formula_target, 2000}, Replay{&store_target, 200},
                                           Replay{&image_target, 3000}, Replay{&cells_target, 60},
                                           Replay{&frame_target, 300}, Replay{&numbers_target, 100},
                                           Replay{&measurement_target, 100}),
                         [](const auto& instance) { return std::string(instance.param.target->name); });

}  // namespace
}  // namespace noonmark::fuzz
