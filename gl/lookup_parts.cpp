#include "gl/lookup_parts.h"

#include <stdexcept>

namespace noonmark::gl {
namespace {

struct BiasRow {
  BiasForm form;
  const char* file;
};
constexpr BiasRow bias_rows[] = {
    {BiasForm::none, "shaders/bias/none.glsl"},
    {BiasForm::constant, "shaders/bias/constant.glsl"},
    {BiasForm::slope, "shaders/bias/slope.glsl"},
    {BiasForm::normal_offset, "shaders/bias/normal_offset.glsl"},
};

struct FilterRow {
  FilterKind kind;
  const char* file;
};
constexpr FilterRow filter_rows[] = {
    {FilterKind::none, "shaders/filter/none.glsl"},
    {FilterKind::box, "shaders/filter/box.glsl"},
};

}  // namespace

const char* bias_file(BiasForm form) {
  for (const BiasRow& row : bias_rows)
    if (row.form == form) return row.file;
  throw std::logic_error("a bias form without a row in gl/lookup_parts.cpp");
}

const char* filter_file(FilterKind kind) {
  for (const FilterRow& row : filter_rows)
    if (row.kind == kind) return row.file;
  throw std::logic_error("a filter without a row in gl/lookup_parts.cpp");
}

}  // namespace noonmark::gl
