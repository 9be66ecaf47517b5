// Reads what an experiment, or a part of it, asserts of its results: [[bound]], [let] and [[law]]. The fixed settings, the
// sweeps and [curve] must have been read before, because conditions and metrics are checked against them.
#pragma once
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/definition/toml_reader.h"

namespace noonmark {

class PromiseReader : private SettingsReader {
 public:
  // Adds to the experiment, which must stay where it is.
  PromiseReader(const std::string& path, Experiment& experiment) : SettingsReader(path), experiment_(experiment) {}

  // Each throws Error(usage) with the place in the file.
  void read_bounds(const toml::node& node);
  void read_laws(const toml::node& node);
  void read_let(const toml::table& table);

 private:
  void read_bound(const toml::table& table);
  Conditions read_conditions(const toml::node& node, const std::string& name);
  void condition(const std::string& name, const toml::node& value);
  std::vector<std::string> values_of(const Setting& row) const;
  void read_law(const toml::table& table);

  Experiment& experiment_;
  Conditions* where_ = nullptr;  // those that are being read
};

}  // namespace noonmark
