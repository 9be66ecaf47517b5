// Thousands of files with random damage: each gives a whole, finite scene or one Error(file), and nothing else. The
// seed is fixed, so that a failure can be repeated.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <random>

#include "tests/scenes/gltf/expect.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::test {
namespace {

struct Tally {
  int loaded = 0, refused = 0;
};

// Loads one file and counts the outcome. Anything but a sound scene or one Error(file) fails the test.
void try_file(const std::string& path, Tally& tally, const std::string& what, const Pose& pose = {}) {
  try {
    const Scene scene = load_gltf(path, pose);
    ++tally.loaded;
    ASSERT_EQ(defect_of(scene), "") << what;
  } catch (const Error& e) {
    ++tally.refused;
    ASSERT_EQ(e.kind(), ErrorKind::file) << what << ": " << e.what();
    ASSERT_EQ(std::string(e.what()).find('\n'), std::string::npos) << what << ": " << e.what();
  } catch (const std::exception& e) {
    FAIL() << what << " threw " << e.what();
  }
}

std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](size_t n) { return static_cast<size_t>(random() % n); };
  for (size_t edits = 1 + below(4); edits > 0 && !bytes.empty(); --edits) {
    const size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 2:
        bytes.erase(at, 1 + below(8));
        break;
      case 3:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(16)));
        break;
      case 4:
        bytes[at] = "0123456789-.eE\"[]{},:"[below(21)];
        break;
      default:
        bytes.replace(at, 4, below(2) == 0 ? std::string(4, '\xff') : std::string(4, '\0'));
        break;
    }
  }
  return bytes;
}

// Every value of a document, in order, so that one can be picked.
void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (!value.is_structured()) return;
  for (json& inner : value) collect(inner, all);
}

// Replaces one value by one that is of another type, out of range, or from elsewhere in the document.
json damaged(json d, std::mt19937& random) {
  static const json odd = {0,
                           1,
                           2,
                           3,
                           -1,
                           255,
                           65535,
                           2147483647,
                           2147483648u,
                           4294967295u,
                           4294967296u,
                           0xffffffffffffffffu,
                           1e-300,
                           1e300,
                           -0.0,
                           3.5,
                           nullptr,
                           true,
                           "",
                           "../x",
                           json::array(),
                           json::object(),
                           {0},
                           {0, 0},
                           "MASK"};
  for (size_t edits = 1 + random() % 3; edits > 0; --edits) {
    std::vector<json*> all;
    collect(d, all);
    json& victim = *all[1 + random() % (all.size() - 1)];
    switch (random() % 4) {
      case 0:
        victim = json(*all[random() % all.size()]);
        break;
      case 1:
        if (victim.is_object() && !victim.empty()) {
          victim.erase(std::next(victim.begin(), static_cast<std::ptrdiff_t>(random() % victim.size())));
          break;
        }
        [[fallthrough]];
      default:
        victim = odd[random() % odd.size()];
        break;
    }
  }
  return d;
}

// Every test run takes these mutants, which are the same each time; NOONMARK_MUTANTS=N takes N times as many. scripts/fuzz
// continues with others (tests/fuzz/gltf_target.cpp).
int times(int mutants) {
  const char* const factor = std::getenv("NOONMARK_MUTANTS");
  return factor ? std::stoi(factor) * mutants : mutants;
}

class GltfMutation : public ::testing::Test {
 protected:
  void report(const char* kind, const Tally& tally) {
    std::printf("%s: %d loaded, %d refused\n", kind, tally.loaded, tally.refused);
    EXPECT_GT(tally.loaded, 0) << "no mutant was near enough to a valid file to test anything behind the parser";
    EXPECT_GT(tally.refused, 0);
  }
  TemporaryFolder folder_;
  std::mt19937 random_{20240611};
};

TEST_F(GltfMutation, TheSourceIsSound) {
  EXPECT_EQ(defect_of(load_gltf(folder_.write("scene.gltf", rich().dump()))), "");
  EXPECT_EQ(defect_of(load_gltf(folder_.write("scene.gltf", moving().dump()), {1.0, 0})), "");
}

TEST_F(GltfMutation, BytesOfABinaryFile) {
  json d = rich();
  d["buffers"][0] = {{"byteLength", 60}};
  const std::string whole = glb(d.dump(), square_bytes());
  Tally tally;
  for (int i = 0; i < times(1000) && !HasFatalFailure(); ++i) {
    try_file(folder_.write("scene.glb", mutated(whole, random_)), tally, "mutant " + std::to_string(i));
  }
  report("bytes of a .glb", tally);
}

TEST_F(GltfMutation, BytesOfTheData) {
  json d = square();
  d["buffers"][0] = {{"byteLength", 60}};
  const std::string text = d.dump();
  Tally tally;
  for (int i = 0; i < times(500) && !HasFatalFailure(); ++i) {
    std::string bin = mutated(square_bytes(), random_);
    bin.resize(60);
    try_file(folder_.write("scene.glb", glb(text, bin)), tally, "mutant " + std::to_string(i));
  }
  report("bytes of the data", tally);
}

TEST_F(GltfMutation, BytesOfText) {
  const std::string whole = rich().dump();
  Tally tally;
  for (int i = 0; i < times(1000) && !HasFatalFailure(); ++i) {
    try_file(folder_.write("scene.gltf", mutated(whole, random_)), tally, "mutant " + std::to_string(i));
  }
  report("bytes of a .gltf", tally);
}

TEST_F(GltfMutation, ValuesOfTheDocument) {
  const json whole = rich();
  Tally tally;
  for (int i = 0; i < times(2000) && !HasFatalFailure(); ++i) {
    const std::string text = damaged(whole, random_).dump();
    try_file(folder_.write("scene.gltf", text), tally, "mutant " + std::to_string(i) + " " + text);
  }
  report("values of a .gltf", tally);
}

TEST_F(GltfMutation, ValuesOfADocumentThatMoves) {
  const json whole = moving();
  Tally tally;
  for (int i = 0; i < times(1500) && !HasFatalFailure(); ++i) {
    const std::string text = damaged(whole, random_).dump();
    try_file(folder_.write("scene.gltf", text), tally, "mutant " + std::to_string(i) + " " + text, {1.0, 0});
  }
  report("values of a .gltf that moves", tally);
}

}  // namespace
}  // namespace noonmark::test
