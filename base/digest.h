// A fingerprint of bytes. It shows whether something was edited, cut short or rounded. It does not protect against a
// deliberate forgery.
//
//   Digest digest;
//   digest.value(1.5);
//   digest.text("of any length");
//   print(digest.hex());
#pragma once
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace noonmark {

// FNV-1a over 64 bits (Fowler, Noll, Vo).
class Digest {
 public:
  void bytes(const void* data, size_t size) {
    for (size_t i = 0; i < size; ++i) hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[i]) * prime;
  }
  // The bytes of the value as this machine stores them (little-endian). Most integers are below 256: their other bytes are
  // 0, and a byte of 0 only multiplies, so that all of them are one multiplication.
  template <class T>
  void value(const T& v) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    static_assert(std::endian::native == std::endian::little);
    if constexpr (std::is_integral_v<T>) {
      if (const auto bits = static_cast<uint64_t>(v); bits < 256) {
        constexpr uint64_t power = power_of_prime(sizeof(T));
        hash_ = (hash_ ^ bits) * power;
        return;
      }
    }
    bytes(&v, sizeof v);
  }
  // The length is added too, so that two texts in a row cannot be confused with two other texts.
  void text(std::string_view v) {
    value(v.size());
    bytes(v.data(), v.size());
  }
  std::string hex() const { return fmt::format("{:016x}", hash_); }

 private:
  static constexpr uint64_t prime = 0x100000001b3;
  static constexpr uint64_t power_of_prime(size_t exponent) {
    uint64_t power = 1;
    for (size_t i = 0; i < exponent; ++i) power *= prime;
    return power;
  }
  uint64_t hash_ = 0xcbf29ce484222325;
};

inline std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.bytes(bytes.data(), bytes.size());
  return digest.hex();
}

}  // namespace noonmark
