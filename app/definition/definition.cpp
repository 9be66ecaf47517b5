#include "app/definition/definition.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/definition/experiment_file.h"
#include "app/definition/experiment_text.h"
#include "base/error.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

constexpr auto replace_bad_bytes = nlohmann::ordered_json::error_handler_t::replace;  // a path may have any bytes

// The value that an overridden setting has: the same in all parts.
std::string given_value(const Experiment& experiment, const std::string& name) {
  const Experiment& any = experiment.parts.empty() ? experiment : experiment.parts.front();
  return find_setting(name).get(any.base);
}

}  // namespace

std::string definition_text(const Experiment& experiment) {
  nlohmann::ordered_json json;
  json["path"] = experiment.path;
  json["set"] = experiment.overridden;
  json["part"] = experiment.chosen;
  // The first line is a comment that names the file.
  const std::string text = experiment_text(experiment);
  json["text"] = text.substr(text.find('\n') + 1);
  return json.dump(-1, ' ', false, replace_bad_bytes);
}

std::string without_host_path(const std::string& definition) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(definition);
  const std::filesystem::path path = json.at("path").get<std::string>();
  if (path.is_absolute()) json["path"] = path.filename().string();
  return json.dump(-1, ' ', false, replace_bad_bytes);
}

Experiment experiment_of(const std::string& definition, const std::string& store) {
  try {
    const auto json = nlohmann::json::parse(definition);
    Experiment experiment = parse_experiment(json.at("text").get<std::string>(), json.at("path").get<std::string>());
    experiment.overridden = json.at("set").get<std::vector<std::string>>();
    experiment.chosen = json.at("part").get<std::vector<std::string>>();
    return experiment;
  } catch (const std::exception& error) {  // also an Error of the experiment's reader: this Noonmark wrote the text
    throw Error(ErrorKind::file, fmt::format("{}: the experiment that it holds cannot be read ({}); measure it again",
                                             store, error.what()));
  }
}

std::string definition_path(const std::string& definition) {
  return nlohmann::json::parse(definition).at("path").get<std::string>();
}

std::string with_path(const std::string& definition, const std::string& path) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(definition);
  json["path"] = path;
  return json.dump(-1, ' ', false, replace_bad_bytes);
}

std::string moved_scene(const std::string& scene, const std::string& from, const std::string& to) {
  if (!names_file(scene) || from == to) return scene;
  const std::filesystem::path path = scene_path_in(scene, from);
  if (path.is_absolute()) return path.string();
  return (std::filesystem::path(to).parent_path() / path).lexically_normal().string();
}

std::string share_command(const Experiment& experiment, const std::string& shard) {
  std::string command = "noonmark run " + shell_quoted(experiment.path);
  for (const std::string& name : experiment.overridden)
    command += " --set " + shell_quoted(name + "=" + given_value(experiment, name));
  for (const std::string& name : experiment.chosen) command += " --part " + shell_quoted(name);
  return shard.empty() ? command : command + " --shard " + shard;
}

}  // namespace noonmark
