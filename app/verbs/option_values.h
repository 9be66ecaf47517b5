// What the values of options and arguments are: the word that the help shows for each kind, and the checks.
//
//   verb.add_option("--picture", picture, "Judge this picture ...")->check(not_empty())->type_name(value_kind::picture);
//   verb.add_option("--rows", rows, "Number of texel sizes")->check(whole_number(2, 200))->capture_default_str();
//
// The help adds "(default: ...)" to the text of an option that has CLI11's default string. The string is made from the
// member, so that a default stands once.
#pragma once
#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <vector>

#include "app/definition/share_text.h"
#include "scenes/number_ranges.h"

namespace noonmark {

// Completion (app/shell/completion.bash) reads these words in the help and offers values by them; of FILE.toml the files
// with this ending, and nothing for a number. A word in lower case is itself a value. A value of several kinds has their words, separated by "|".
namespace value_kind {
inline constexpr const char* experiment = "FILE.toml";
inline constexpr const char* scene = "SCENE|FILE.gltf|FILE.glb|FILE.vrm";  // a built-in scene, or a model
inline constexpr const char* model = "FILE.gltf|FILE.glb|FILE.vrm";
inline constexpr const char* picture = "FILE.exr|FILE.png|FILE.npy";
inline constexpr const char* capture = "FILE.rdc";
inline constexpr const char* frame =
    "FILE.json|FILE.rdc|SCENE|FILE.gltf|FILE.glb|FILE.vrm";  // what another renderer handed over
inline constexpr const char* baseline = "FILE.json";
inline constexpr const char* folder = "FOLDER";
inline constexpr const char* setting = "NAME=VALUE";  // a setting and its value
inline constexpr const char* part = "PART";           // a part of the experiment on the command line
inline constexpr const char* verb = "VERB";
inline constexpr const char* share = "SHARE";  // a number from 0 to 1, or a percentage
inline constexpr const char* number = "NUMBER";
inline constexpr const char* pixel = "X,Y";            // of a picture, row 0 on top
inline constexpr const char* metric = "METRIC=VALUE";  // a metric and its bound
}  // namespace value_kind

// For CLI::Option::check. They return the mistake in the text, or an empty string.
CLI::Validator not_empty();
CLI::Validator whole_number(long least, long most = std::numeric_limits<long>::max());
CLI::Validator above_zero();
CLI::Validator number_in(const NumberRange& range);
// One of these words; a wrong one suggests the nearest. joined(): the words as the option's kind, "one|other".
CLI::Validator one_of(std::vector<std::string> words);
std::string joined(const std::vector<std::string>& words);
// list_of: checks a list of these words, such as "vsm,msm" or "vsm, msm". words_of: the words of such lists, in their order.
CLI::Validator list_of(std::vector<std::string> words);
std::vector<std::string> words_of(const std::vector<std::string>& lists);

// For CLI::Option::transform: a share as "0.005" or "0.5%" becomes its number (app/definition/share_text.h).
CLI::Validator as_share();

// An option for a share, whose value in `share` is a number from 0 to 1. unset: what the help says is taken without it; empty: nothing.
template <class Share>  // double, or an optional one
void add_share(CLI::App& verb, const char* name, Share& share, const std::string& help, const std::string& unset) {
  CLI::Option* const option = verb.add_option(name, share, help)->transform(as_share())->type_name(value_kind::share);
  if (!unset.empty()) option->default_str(unset);
}

}  // namespace noonmark
