// Joins the points of several stores of one experiment, measured on several machines.
//
//   JoinedStore joined = store.join("out/share-2-of-4/results.sqlite", scene_name);   // ResultStore
//   joined.differences;  // points that both have, with other numbers
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

namespace sqlite {
class Database;
}

// A number of a point that both stores have, and not the same in both.
struct Difference {
  int64_t point = 0;
  std::string what;                    // "acne"; "setting map.resolution"; "the bias curve"
  std::string here, there;             // the values as text; empty for what is more than one number
  std::vector<PointRecord> records{};  // both points with their metrics alone, for compare/judge/soundness.h
};

struct JoinedStore {
  std::vector<int64_t> points;          // those that were taken over, ascending
  int64_t shared = 0;                   // those that were here already
  std::vector<PointPictures> pictures;  // of the points that were taken over
  std::vector<Difference> differences;  // the first of each shared point, for a few points
  int64_t differing = 0;                // all shared points that differ
};

// Takes over the points and phase diagrams that `db` lacks, with their seals, in one transaction. The points that both have
// are compared in settings, metrics (but times), bias curve, part and worst pixel; those of `db` stay. Ids must mean the same
// points in both stores. Points that were set aside are left out. The rows of `path` must match their seals (open it before,
// and call require_sealed). Memory does not grow with the number of points, but for their ids.
//
// scene_name: what a scene's name in `path` is here, because paths of scene files are of one host. It is written into the
// points and phase diagrams that are taken over, which are sealed again.
using SceneName = std::function<std::string(const std::string&)>;
JoinedStore join_store(sqlite::Database& db, const std::string& path, const SceneName& scene_name);

}  // namespace noonmark
