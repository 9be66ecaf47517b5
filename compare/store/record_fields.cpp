#include "compare/store/record_fields.h"

namespace noonmark {
namespace {

using Worst = PointRecord::Worst;

constexpr RecordField fields_of_records[] = {
    {"part", "", "", "The experiment's part; empty if it has no parts.", &PointRecord::part},
    {"worst_x", "worst", "px", "The worst pixel's column.", &Worst::x},
    {"worst_y", "worst", "px", "The worst pixel's row, 0 on top.", &Worst::y},
    {"worst_error", "worst", "fraction", "Its error.", &Worst::error},
    {"worst_cause", "worst", "", "Its cause.", &Worst::cause},
};

}  // namespace

std::span<const RecordField> record_fields() { return fields_of_records; }

}  // namespace noonmark
