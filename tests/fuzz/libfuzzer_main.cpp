// The functions that libFuzzer calls, for the target that the build names (FUZZ_TARGET, a name in targets.h).
//
//   fuzz_gltf --write FOLDER     writes seeds to FOLDER/seeds and the dictionary to FOLDER/words.dict; does not fuzz
//   fuzz_gltf FOLDER/corpus FOLDER/seeds -dict=FOLDER/words.dict -max_total_time=60
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/targets.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace noonmark::fuzz {
namespace {

const Target& target() { return FUZZ_TARGET; }

void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A dictionary of libFuzzer has one quoted word per line, with \xNN for characters that are not plain.
std::string dictionary(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (word.empty()) continue;
    text += '"';
    for (const char c : word) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned char>(c));
      const bool plain = c >= 0x20 && c < 0x7f && c != '"' && c != '\\';
      text += plain ? std::string(1, c) : std::string(escaped);
    }
    text += "\"\n";
  }
  return text;
}

void write_start(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "seeds");
  size_t count = 0;
  for (const std::string& seed : target().seeds()) write(folder / "seeds" / std::to_string(count++), seed);
  write(folder / "words.dict", dictionary(target().words()));
}

// `bytes` after libFuzzer's own mutations.
std::string edit_with_libfuzzer(const std::string& bytes, Random&) {
  std::string room(std::max<size_t>(2 * bytes.size(), 64), '\0');
  std::copy(bytes.begin(), bytes.end(), room.begin());
  room.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(room.data()), bytes.size(), room.size()));
  return room;
}

}  // namespace
}  // namespace noonmark::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  if (*count == 3 && std::strcmp((*arguments)[1], "--write") == 0) {
    noonmark::fuzz::write_start((*arguments)[2]);
    std::exit(0);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    noonmark::fuzz::target().run(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::abort();
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed) {
  const noonmark::fuzz::Target& target = noonmark::fuzz::target();
  noonmark::fuzz::Random random(seed);
  // Every fourth time only bytes are mutated, even if the target knows the format. This gives damage that no exporter
  // can write.
  if (!target.mutate || random() % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::string next = target.mutate(std::string(reinterpret_cast<const char*>(data), size), random,
                                         noonmark::fuzz::edit_with_libfuzzer);
  if (next.empty() || next.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(next.begin(), next.end(), data);
  return next.size();
}
