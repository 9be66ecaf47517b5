// The first step of a recommendation: which settings hold the bounds under the first condition and at one placement, in a
// small picture. What cannot be an answer is not measured.
//
//   Screening screening(bench, request, searched_bounds(request.curve), say);
//   screening.run();                                     // again, after some of what held was refuted
//   for (Candidate& one : screening.candidates()) print(name_of(one.tried, request));
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/advise/recommend.h"
#include "app/advise/recommend_verify.h"

namespace noonmark {

// What a view and a light have in common for all settings.
struct SeenShare {
  double facing = 0;  // share of the pixels that look up
  // Texels of a map, in squares of map.resolution: 6 for a cube; of several maps that of one of them.
  double map_squares = 1;
};

// A bias of more parts, or a map that holds for some views alone, must be this factor better, or it does not pay.
inline constexpr double factor_that_pays = 1.25;

struct Candidate {
  Tried tried;                   // it holds as far as is known while tried.why_not is empty
  size_t level = 0;              // in AdviceRequest::levels
  double edges_mean_pixels = 0;  // how far edges lie off in the picture of full size, as the small one tells
  bool edges_too_far = false;
  bool possible = true;  // the settings go together, and the map fits into memory
  bool confirmed = false;
  size_t conditions = 0;             // that it was measured under
  bool narrow = false;               // refuted, because its window is too narrow for a margin
  std::optional<Verified> verified;  // at other placements

  bool holds() const { return tried.why_not.empty(); }
};

class Screening {
 public:
  // The references must outlive this. searched: the bounds.
  Screening(Workbench& bench, const AdviceRequest& request, const CurveOptions& searched,
            const std::function<void(const std::string&)>& say)
      : bench_(bench), request_(request), say_(say), searched_(searched) {}

  // Measures what can be an answer beside what holds now, from the coarsest map on. What is known is not measured again.
  // Throws Error.
  void run();

  // Measures the settings of `like` at another resolution; false if they are known already.
  bool try_at(const Candidate& like, int resolution);

  // texel_work of the settings of `like` at another resolution.
  double cost_at(const Candidate& like, int resolution) const;

  // texel_work of settings of full size.
  double cost(const Settings& settings) const;

  // Advice::least_costs.
  std::map<std::string, double> least_costs() const;

  std::vector<Candidate>& candidates() { return candidates_; }
  const std::vector<Candidate>& candidates() const { return candidates_; }

  Settings of_choice(Settings condition, size_t level, size_t place, const FilterSettings& filter,
                     int resolution) const;

  // The accuracy of the settings, with what was chosen for them, under the first condition and at one placement.
  double error_of(const Tried& tried) const;

  // What was measured tells the largest share of receivers that are dark in the truth. Throws Error(usage) if the truth of too many
  // receivers is ambiguous for any answer.
  void see(const PointRecord& record);
  double shadowed() const { return shadowed_; }
  double lit() const { return lit_; }

 private:
  struct Choice {
    size_t level, place;
    const FilterSettings& filter;
    int resolution;
  };
  const Candidate* known(const Choice& choice) const;
  template <typename Is>
  const Candidate* find(const Is& is) const;
  bool is_filtered(const Choice& choice) const;
  double cost_of(const Choice& choice) const;
  double most_cost() const;
  bool worth_measuring(const Choice& choice) const;
  bool cannot_win(const Choice& choice) const;
  bool fails_for_good(const Choice& choice) const;
  bool another_bias_can_pay(const Choice& choice) const;
  bool lesser_filter_has_no_window(const Choice& choice) const;
  bool more_blur_is_worse(const Choice& choice) const;
  bool finer_is_not_better(const Choice& choice) const;
  bool nothing_is_wrong_for_less(const Choice& choice) const;
  void judge_edges(Candidate& candidate) const;
  void measure(const Choice& choice);

  Workbench& bench_;
  const AdviceRequest& request_;
  const std::function<void(const std::string&)>& say_;
  const CurveOptions& searched_;
  std::vector<Candidate> candidates_;
  std::optional<SeenShare> seen_;  // empty until some settings are measured
  double shadowed_ = 0;
  double lit_ = 0;
};

// For people: "one constant bias, 512 texels, filter none".
std::string name_of(const Tried& tried, const AdviceRequest& request);

// What a level can be combined with: the filters, or its own blurs.
const std::vector<FilterSettings>& filters_of(const AdviceRequest& request, size_t level);

// The bound on how far 95% of the edges may lie off, in pixels; infinite without one.
double most_edges(const AdviceRequest& request);

// Empty if its error is within the one that is asked for.
std::string why_too_wrong(const Tried& tried, const AdviceRequest& request);

}  // namespace noonmark
