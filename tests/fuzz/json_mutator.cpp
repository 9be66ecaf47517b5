#include "tests/fuzz/json_mutator.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

namespace noonmark::fuzz {
namespace {

using nlohmann::json;

// Long documents are slow and find nothing that short ones do not find.
constexpr size_t most_values = 3000;

void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (!value.is_structured() || all.size() > most_values) return;
  for (json& inner : value) collect(inner, all);
}

json odd_value(Random& random, std::span<const std::string> words) {
  static const std::vector<json> odd = {0,
                                        1,
                                        2,
                                        3,
                                        -1,
                                        255,
                                        65535,
                                        2147483647,
                                        2147483648u,
                                        5120,
                                        5121,
                                        5122,
                                        5123,
                                        5125,
                                        5126,
                                        4294967295u,
                                        4294967296u,
                                        0xffffffffffffffffu,
                                        1e-45,
                                        1e-30,
                                        1e-300,
                                        3.4e38,
                                        1e39,
                                        1e300,
                                        -0.0,
                                        3.5,
                                        0.70710678,
                                        1e6,
                                        -1e6,
                                        4,
                                        16777217,
                                        nullptr,
                                        true,
                                        false,
                                        "",
                                        "../x",
                                        5,
                                        6,
                                        "MASK",
                                        "VEC3",
                                        {0},
                                        {0, 0},
                                        {1, 2, 3},
                                        {0, 0, 0, 1},
                                        json::array(),
                                        7,
                                        8,
                                        12,
                                        36,
                                        "\xef\xbf\xbd",
                                        "%00",
                                        "a\x01b",
                                        {0.5, 0.5, 0.5, 0.5},
                                        json::object()};
  if (!words.empty() && below(random, 5) == 0) return words[below(random, words.size())];
  return odd[below(random, odd.size())];
}

// A number that differs a little or a lot: counts, lengths, offsets and indices that just fit or just do not fit.
json near_number(const json& number, Random& random) {
  if (number.is_number_integer()) {
    const auto value = number.get<int64_t>();
    switch (below(random, 6)) {
      case 0:
        return value > -1000000 ? value - 1 : value;
      case 1:
        return value < 1000000 ? value + 1 : value;
      case 2:
        return value / 2;
      case 3:
        return value < 100000 ? value * 2 : value;
      case 4:
        return static_cast<int64_t>(below(random, 12));
      default:
        return value ^ static_cast<int64_t>(1) << below(random, 20);
    }
  }
  const double value = number.get<double>();
  switch (below(random, 5)) {
    case 0:
      return -value;
    case 1:
      return std::nextafter(static_cast<float>(value), 0.0f);
    case 2:
      return value * std::pow(10.0, static_cast<double>(below(random, 80)) - 40);
    case 3:
      return value + 1;
    default:
      return std::round(value);
  }
}

json& any_of(std::vector<json*>& all, Random& random) { return *all[below(random, all.size())]; }

void edit_object(json& object, std::vector<json*>& all, Random& random, std::span<const std::string> words) {
  if (object.empty() || below(random, 4) == 0) {
    if (!words.empty()) object[words[below(random, words.size())]] = odd_value(random, words);
    return;
  }
  auto member = std::next(object.begin(), static_cast<std::ptrdiff_t>(below(random, object.size())));
  if (below(random, 3) == 0 && !words.empty()) {  // the same value under another name
    json value = member.value();
    object.erase(member);
    object[words[below(random, words.size())]] = std::move(value);
  } else if (below(random, 2) == 0) {
    object.erase(member);
  } else {
    json copy = any_of(all, random);
    member.value() = std::move(copy);
  }
}

void edit_array(json& array, std::vector<json*>& all, Random& random, std::span<const std::string> words) {
  if (array.empty()) {
    array.push_back(odd_value(random, words));
    return;
  }
  const size_t at = below(random, array.size());
  const auto place = array.begin() + static_cast<std::ptrdiff_t>(at);
  switch (below(random, 5)) {
    case 0:
      array.erase(place);
      break;
    case 1: {
      json copy = array[at];
      array.insert(place, std::move(copy));
      break;
    }
    case 2:
      std::swap(array[at], array[below(random, array.size())]);
      break;
    case 3: {
      json copy = any_of(all, random);
      array.push_back(std::move(copy));
      break;
    }
    default:
      array.push_back(odd_value(random, words));
      break;
  }
}

}  // namespace

void mutate_json(json& document, Random& random, std::span<const std::string> words, const EditBytes& edit) {
  for (size_t edits = 1 + below(random, 4); edits > 0; --edits) {
    std::vector<json*> all;
    collect(document, all);
    if (all.size() > most_values) return;
    json& victim = any_of(all, random);
    const size_t kind = below(random, 8);
    if (kind == 0) {
      victim = odd_value(random, words);
    } else if (kind == 1) {
      json copy = any_of(all, random);
      victim = std::move(copy);
    } else if (victim.is_object()) {
      edit_object(victim, all, random, words);
    } else if (victim.is_array()) {
      edit_array(victim, all, random, words);
    } else if (victim.is_number()) {
      json number = near_number(victim, random);
      victim = std::move(number);
    } else if (victim.is_string()) {
      victim = edit(victim.get<std::string>(), random);
    } else {
      victim = odd_value(random, words);
    }
  }
}

}  // namespace noonmark::fuzz
