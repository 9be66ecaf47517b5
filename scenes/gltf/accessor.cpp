#include "scenes/gltf/accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "scenes/gltf/element.h"
#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

template <class T>
T read(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

uint32_t read_unsigned(const uint8_t* at, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *at;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read<uint16_t>(at);
    default:
      return read<uint32_t>(at);
  }
}

// The bytes from `offset` to the end of the view.
std::span<const uint8_t> view_bytes(Buffers& buffers, int view, size_t offset) {
  return buffers.view(view).subspan(offset);
}

}  // namespace

AccessorReader::AccessorReader(const tinygltf::Accessor& a, std::span<const uint8_t> packed)
    : count_(a.count),
      stride_(packed_stride(a)),
      component_bytes_(static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a.componentType)))),
      component_type_(a.componentType),
      normalized_(a.normalized),
      data_(packed) {}

AccessorReader::AccessorReader(const Document& document, Buffers& buffers, int accessor)
    : AccessorReader(document.model.accessors[static_cast<size_t>(accessor)], {}) {
  const tinygltf::Accessor& a = document.model.accessors[static_cast<size_t>(accessor)];
  stride_ = element_stride(document, a);
  if (a.bufferView != -1) data_ = view_bytes(buffers, a.bufferView, a.byteOffset);
  if (!a.sparse.isSparse) return;
  sparse_count_ = static_cast<size_t>(a.sparse.count);
  sparse_index_type_ = a.sparse.indices.componentType;
  sparse_indices_ = view_bytes(buffers, a.sparse.indices.bufferView, static_cast<size_t>(a.sparse.indices.byteOffset));
  sparse_values_ = view_bytes(buffers, a.sparse.values.bufferView, static_cast<size_t>(a.sparse.values.byteOffset));
  sparse_stride_ = packed_stride(a);
  check_sparse(document, accessor);
}

void AccessorReader::check_sparse(const Document& document, int accessor) const {
  for (size_t i = 0; i < sparse_count_; ++i) {
    const uint32_t here = sparse_index(i);
    if (here < count_ && (i == 0 || sparse_index(i - 1) < here)) continue;
    refuse(document.file, fmt::format("accessors[{}].sparse.indices", accessor),
           fmt::format("element {} is {}, which is not above the one before and below the count {}", i, here, count_),
           "export the file again");
  }
}

uint32_t AccessorReader::sparse_index(size_t i) const {
  const size_t bytes =
      static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse_index_type_)));
  return read_unsigned(sparse_indices_.data() + i * bytes, sparse_index_type_);
}

const uint8_t* AccessorReader::element(size_t i) const {
  size_t low = 0, high = sparse_count_;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    (sparse_index(middle) < i ? low = middle + 1 : high = middle);
  }
  if (low < sparse_count_ && sparse_index(low) == i) return sparse_values_.data() + low * sparse_stride_;
  return data_.empty() ? nullptr : data_.data() + i * stride_;
}

// glTF 2.0, section 3.11: f = c / 255, max(c / 127, -1) and so on.
double AccessorReader::component(const uint8_t* at) const {
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const double c = read<int8_t>(at);
      return normalized_ ? std::max(c / 127.0, -1.0) : c;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return normalized_ ? *at / 255.0 : *at;
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const double c = read<int16_t>(at);
      return normalized_ ? std::max(c / 32767.0, -1.0) : c;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const double c = read<uint16_t>(at);
      return normalized_ ? c / 65535.0 : c;
    }
    default:
      return static_cast<double>(read<float>(at));
  }
}

double AccessorReader::value(size_t i, size_t k) const {
  const uint8_t* at = element(i);
  return at == nullptr ? 0 : component(at + k * component_bytes_);
}

glm::dvec3 AccessorReader::vec3(size_t i) const {
  const uint8_t* at = element(i);
  if (at == nullptr) return glm::dvec3(0);
  return {component(at), component(at + component_bytes_), component(at + 2 * component_bytes_)};
}

// Columns of four components of 4 bytes need no padding between them.
glm::dmat4 AccessorReader::mat4(size_t i) const {
  glm::dmat4 m(0);
  const uint8_t* at = element(i);
  for (int k = 0; at != nullptr && k < 16; ++k)
    m[k / 4][k % 4] = component(at + static_cast<size_t>(k) * component_bytes_);
  return m;
}

uint32_t AccessorReader::index(size_t i, size_t k) const {
  const uint8_t* at = element(i);
  return at == nullptr ? 0 : read_unsigned(at + k * component_bytes_, component_type_);
}

uint32_t AccessorReader::restart_index() const {
  return component_bytes_ == 1 ? 0xffu : component_bytes_ == 2 ? 0xffffu : 0xffffffffu;
}

const AccessorReader& Readers::operator()(int accessor) {
  if (const auto known = readers_.find(accessor); known != readers_.end()) return known->second;
  const tinygltf::Accessor& a = document_.model.accessors[static_cast<size_t>(accessor)];
  if (a.sparse.isSparse) sparse_elements_ += static_cast<uint64_t>(a.sparse.count);
  if (sparse_elements_ > max_vertices) {
    refuse(document_.file, fmt::format("accessors[{}].sparse.count", accessor),
           fmt::format("the scene has more than {} sparse elements", max_vertices), "export without sparse accessors");
  }
  return readers_.try_emplace(accessor, document_, buffers_, accessor).first->second;
}

}  // namespace noonmark::gltf
