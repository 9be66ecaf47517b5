#include "compare/results/record_fields.h"

namespace noonmark {
namespace {

using Worst = PointRecord::Worst;
using Delivery = PointRecord::Delivery;

constexpr RecordField fields_of_records[] = {
    {"part", "", "", "The experiment's part; empty if it has no parts.", &PointRecord::part},
    {"scene_digest", "", "", "The digest of the contents of the point's scene.", &PointRecord::scene_digest},
    {"worst_x", "worst", "px", "The worst pixel's column.", &Worst::x},
    {"worst_y", "worst", "px", "The worst pixel's row, 0 on top.", &Worst::y},
    {"worst_error", "worst", "fraction", "The worst pixel's error.", &Worst::error},
    {"worst_cause", "worst", "", "The worst pixel's cause.", &Worst::cause},
    {"delivery_refused", delivery_group, "", "Why another renderer's frame is not judged; empty if it is.",
     &Delivery::refused},
    {"delivery_accepted", delivery_group, "", "The checks of another renderer's frame that failed and were accepted.",
     &Delivery::accepted},
    {"delivery_not_checked", delivery_group, "", "The checks of another renderer's frame that had too little to go on.",
     &Delivery::not_checked},
    {"machine_host", "machine", "", "The name of the host that measured the point.", &Machine::host},
    {"machine_cpu", "machine", "", "The processor of the host that measured the point.", &Machine::cpu},
    {"machine_driver", "machine", "", "The OpenGL that drew the point: vendor, renderer and version.",
     &Machine::driver},
    {"machine_ray_tracer", "machine", "", "The Embree that traced the point: version and instruction set.",
     &Machine::ray_tracer},
    {"machine_clock", "machine", "", "When the point was finished, by the host's clock (UTC).", &Machine::clock},
};

}  // namespace

std::span<const RecordField> record_fields() { return fields_of_records; }

}  // namespace noonmark
