// The fields of a point's record that are neither settings, metrics, times nor its curve, described once: each row has
// a member of PointRecord, its unit and its meaning. The store, CSV and point.json are made from these rows.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "compare/results/records.h"

namespace noonmark {

struct RecordField {
  std::string_view name;  // in the store and in CSV: "worst_x"
  std::string_view
      group;              // "worst": point.json has the fields of a group as one object; "": only tables have the field
  std::string_view unit;  // "px", "fraction"; text: ""
  std::string_view help;  // one sentence
  using Member =
      std::variant<std::string PointRecord::*, int PointRecord::Worst::*, double PointRecord::Worst::*,
                   std::string PointRecord::Worst::*, std::string PointRecord::Delivery::*, std::string Machine::*>;
  Member member;

  // The name within its group: "x".
  std::string_view key() const { return group.empty() ? name : name.substr(group.size() + 1); }
};
std::span<const RecordField> record_fields();

// The struct of the record that has the member. Record: PointRecord, or const PointRecord.
template <class Record, class T>
Record& owner(Record& record, T PointRecord::*) {
  return record;
}
template <class Record, class T>
auto& owner(Record& record, T PointRecord::Worst::*) {
  return record.worst;
}
template <class Record, class T>
auto& owner(Record& record, T PointRecord::Delivery::*) {
  return record.delivery;
}
template <class Record, class T>
auto& owner(Record& record, T Machine::*) {
  return record.machine;
}

// The group of the fields that say where and when a point was measured. They are no results: two runs differ in them.
inline constexpr std::string_view machine_group = "machine";
// The group of the fields that only another renderer's frame has.
inline constexpr std::string_view delivery_group = "delivery";

// Calls use(value) with the field's value: a text, an int or a double.
template <class Use>
decltype(auto) with_value(const RecordField& field, const PointRecord& record, const Use& use) {
  return std::visit([&](auto member) { return use(owner(record, member).*member); }, field.member);
}

}  // namespace noonmark
