// What the tables of filters (technique/filters.h) and of lookups (technique/lookups.h) share: rows that read parameters. A
// parameter that at least one row reads is a setting of the table's group, and a uniform in the shaders of these rows.
//
//   constexpr KindParameter size{.setting = "filter.size", .unit = "taps", .type = ValueType::integer};
//   Filter box{.name = "box", .reads = {{&size}}};
#pragma once
#include <algorithm>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noonmark {

enum class ValueType { integer, real, flag, choice, text, point, list, whole_list, real_list };

// A number, flag or choice that at least one row reads.
struct KindParameter {
  std::string_view setting;  // "filter.size"
  std::string_view unit;
  ValueType type = ValueType::real;
  double min = 0, max = 0;  // integer, real: inclusive limits
  double initial = 0;       // the default; of a choice its index
  std::string_view help;    // after the names of the rows that read it: "box, gaussian: <help>"
  std::span<const std::string_view> choices = {};
  bool of_blur = false;  // of a lookup: which texels a receiver reads depends on it, as on filter.*

  std::string_view name() const { return setting.substr(setting.find('.') + 1); }
};

// That a row reads a parameter. Both functions get settings whose kind is this row. They return the reason, or an empty
// text. Values: the settings of the group.
template <class Values>
struct KindRead {
  const KindParameter* parameter;
  std::string (*why_refused)(const Values&) = nullptr;  // the row has no meaning for this value
  std::string (*why_idle)(const Values&) = nullptr;     // another parameter switches this one off
};

// Every parameter that a row reads, once, in the order of the rows.
template <class Rows>
std::vector<const KindParameter*> parameters_of(const Rows& rows) {
  std::vector<const KindParameter*> all;
  for (const auto& row : rows)
    for (const auto& read : row.reads)
      if (std::find(all.begin(), all.end(), read.parameter) == all.end()) all.push_back(read.parameter);
  return all;
}

// The read of this parameter; null if the row does not read it.
template <class Row>
auto find_read(const Row& row, const KindParameter& parameter) {
  const auto found =
      std::find_if(row.reads.begin(), row.reads.end(), [&](const auto& read) { return read.parameter == &parameter; });
  return found == row.reads.end() ? nullptr : &*found;
}

// The settings of such a group: which row, and the value of every parameter of the table.
// Table: static std::string_view first, and static std::span<const KindParameter* const> parameters().
template <class Table>
struct KindSettings {
  KindSettings() = default;
  // ("box", {{"size", 5}})
  KindSettings(std::string kind_name, std::initializer_list<std::pair<std::string_view, double>> parameters)
      : kind(std::move(kind_name)) {
    for (const auto& [name, value] : parameters) (*this)[name] = value;
  }

  std::string kind{Table::first};  // the name of a row

  // A parameter by its name without the group: "size" is filter.size. A flag is 0 or 1; a choice is the index of its
  // value. Throws std::logic_error if no row has such a parameter.
  double& operator[](std::string_view parameter) { return values_[index(parameter)]; }
  double operator[](std::string_view parameter) const { return values_[index(parameter)]; }
  int whole(std::string_view parameter) const { return static_cast<int>((*this)[parameter]); }

  // The same kind, and the same value of each parameter, also of those that this kind does not read.
  bool operator==(const KindSettings&) const = default;

 private:
  static size_t index(std::string_view parameter) {
    const std::span<const KindParameter* const> all = Table::parameters();
    for (size_t i = 0; i < all.size(); ++i)
      if (all[i]->name() == parameter) return i;
    throw std::logic_error("no row has a parameter '" + std::string(parameter) + "'");
  }
  static std::vector<double> defaults() {
    std::vector<double> values;
    for (const KindParameter* parameter : Table::parameters()) values.push_back(parameter->initial);
    return values;
  }
  std::vector<double> values_ = defaults();  // in the order of Table::parameters()
};

}  // namespace noonmark
