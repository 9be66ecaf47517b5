// A fingerprint of bytes. It shows whether something was edited, cut short or rounded. It does not protect against a
// deliberate forgery.
//
//   Digest digest;
//   digest.value(1.5);
//   digest.text("of any length");
//   store(digest.hex());
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace noonmark {

// FNV-1a over 64 bits (Fowler, Noll, Vo).
class Digest {
 public:
  void bytes(const void* data, size_t size) {
    for (size_t i = 0; i < size; ++i) hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3;
  }
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    bytes(&v, sizeof v);
  }
  // The length is added too, so that two texts in a row cannot be confused with two other texts.
  void text(std::string_view v) {
    value(v.size());
    bytes(v.data(), v.size());
  }
  std::string hex() const { return fmt::format("{:016x}", hash_); }

 private:
  uint64_t hash_ = 0xcbf29ce484222325;
};

inline std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.bytes(bytes.data(), bytes.size());
  return digest.hex();
}

}  // namespace noonmark
