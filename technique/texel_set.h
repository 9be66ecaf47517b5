// A set of texels of a map's image, and a number for each of them: 0 ... count() - 1. What is known of the texels that a
// lookup reads is kept in lists by that number, because a large map has many more texels than a picture asks for.
//
//   TexelSet texels(frame.map_size());
//   texels.add({12, 7});                      // from several threads, each texel as often as one likes
//   texels.close();
//   std::vector<float> depth(texels.count());
//   depth[texels.index({12, 7})] = 0.5f;
//
// A texel takes two bits of memory, whether it is in the set or not. The image is cut into tiles of 64 x 64 texels, and
// texels that are neighbours in the map mostly are neighbours in the numbers.
#pragma once
#include <atomic>
#include <bit>
#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace noonmark {

class TexelSet {
 public:
  static constexpr int side = 64;  // of a tile, in texels

  TexelSet() = default;
  // Empty. size: of the map's image (LightFrame::map_size()).
  explicit TexelSet(glm::ivec2 size)
      : size_(size),
        tiles_((size + (side - 1)) / side),
        rows_(static_cast<size_t>(tiles_.x) * static_cast<size_t>(tiles_.y) * side) {}

  // The texel must lie inside the image.
  void add(glm::ivec2 texel) {
    const std::atomic_ref<uint64_t> row(rows_[row_of(texel)].texels);
    // Most texels are asked for many times, and a load costs less than a store that other threads must see.
    if (!(row.load(std::memory_order_relaxed) & bit_of(texel))) row.fetch_or(bit_of(texel), std::memory_order_relaxed);
  }

  // Adds the texels of all these columns in all these rows; ascending in both.
  void add_square(std::span<const glm::ivec2> column_row) {
    for (const glm::ivec2 row : column_row)
      for (size_t from = 0; from < column_row.size();) {
        const int tile = column_row[from].x / side;
        uint64_t bits = 0;  // of the columns in one tile
        glm::ivec2 texel(column_row[from].x, row.y);
        for (; from < column_row.size() && column_row[from].x / side == tile; ++from)
          bits |= bit_of({column_row[from].x, row.y});
        const std::atomic_ref<uint64_t> of_row(rows_[row_of(texel)].texels);
        if ((of_row.load(std::memory_order_relaxed) & bits) != bits) of_row.fetch_or(bits, std::memory_order_relaxed);
      }
  }

  // Gives the texels their numbers. Called once, after the last add().
  void close() {
    count_ = 0;
    for (Row& row : rows_) {
      row.before = static_cast<uint32_t>(count_);
      count_ += static_cast<size_t>(std::popcount(row.texels));
    }
  }

  // How many texels have been added, before or after close().
  size_t asked() const {
    size_t all = 0;
    for (const Row& row : rows_) all += static_cast<size_t>(std::popcount(row.texels));
    return all;
  }

  // The following are for a closed set.
  glm::ivec2 size() const { return size_; }
  size_t count() const { return count_; }
  bool has(glm::ivec2 texel) const {
    return texel.x >= 0 && texel.y >= 0 && texel.x < size_.x && texel.y < size_.y &&
           (rows_[row_of(texel)].texels & bit_of(texel)) != 0;
  }
  // texel: one of the set.
  size_t index(glm::ivec2 texel) const {
    assert(has(texel));
    const Row& row = rows_[row_of(texel)];
    return row.before + static_cast<size_t>(std::popcount(row.texels & (bit_of(texel) - 1)));
  }

  // Appends the numbers of these texels of one row; columns: ascending, each as often as one likes.
  void indexes(int y, std::span<const glm::ivec2> columns, std::vector<uint32_t>& indexes) const {
    size_t at = indexes.size();
    indexes.resize(at + columns.size());
    int before = -2;
    uint32_t last = 0;
    for (const glm::ivec2 column : columns) {
      const int x = column.x;
      // The number of the next texel in the row of a tile is the next number.
      last = x == before + 1 && x % side != 0 ? last + 1 : static_cast<uint32_t>(index({x, y}));
      indexes[at++] = last;
      before = x;
    }
  }

  // Tile n holds the texels from origin(n) on. Its texels have consecutive numbers, row by row: `first` is the least.
  size_t tiles() const { return rows_.size() / side; }
  glm::ivec2 origin(size_t tile) const {
    const auto across = static_cast<size_t>(tiles_.x);
    return {static_cast<int>(tile % across) * side, static_cast<int>(tile / across) * side};
  }
  size_t first(size_t tile) const { return rows_[tile * side].before; }
  size_t count(size_t tile) const { return (tile + 1 < tiles() ? first(tile + 1) : count_) - first(tile); }
  // A bit for each texel of this row of a tile; bit 0 is its first column.
  uint64_t bits(size_t tile, int row) const { return rows_[tile * side + static_cast<size_t>(row)].texels; }

  // Calls visit(x, index) for each texel of this row of the image, in ascending order.
  template <class Visit>
  void each_in_row(int y, const Visit& visit) const {
    for (int x = 0; x < size_.x; x += side) {
      const Row& row = rows_[row_of({x, y})];
      size_t index = row.before;
      for (uint64_t bits = row.texels; bits; bits &= bits - 1, ++index) visit(x + std::countr_zero(bits), index);
    }
  }

 private:
  struct Row {  // of a tile
    uint64_t texels = 0;
    uint32_t before = 0;  // how many texels of the set come before it
  };
  size_t row_of(glm::ivec2 texel) const {
    const auto x = static_cast<size_t>(texel.x), y = static_cast<size_t>(texel.y);
    return (y / side * static_cast<size_t>(tiles_.x) + x / side) * side + y % side;
  }
  static uint64_t bit_of(glm::ivec2 texel) { return uint64_t{1} << (texel.x % side); }

  glm::ivec2 size_{0}, tiles_{0};
  std::vector<Row> rows_;  // of all tiles, one after the other
  size_t count_ = 0;
};

}  // namespace noonmark
