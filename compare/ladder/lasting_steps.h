// Which step of a chain of rungs a change belongs to: the step from which the change lasts.
//
//   std::array<double, 2> parts;
//   lasting_steps(std::array{1.0, 0.0, 0.25}, parts);   // parts = {-0.75, 0}: the first step darkens, and so much of it stays
//
// A step gets what it adds to the part of the change that all later rungs keep. So steps that undo each other are not
// counted, and a chain that ends where it began has no part. If all rungs are 0 or 1, the whole change belongs to the
// step to the rung from which the pixel stays at its last value.
#pragma once
#include <span>

namespace noonmark {

// rungs: x0 ... xn in the order of the chain, at least one, of any unit. parts: n numbers of that unit; parts[k - 1] is that
// of the step from x(k-1) to xk. With s the sign of xn - x0:
//
//   m_k = max(0, min over j >= k of s (x_j - x0)),   parts[k - 1] = s (m_k - m_(k-1)),   m_0 = 0.
//
// No part has the sign against s. Each part has one rounding, so the parts' sum as doubles, from the first to the last, is
// xn - x0 as a double but for a share of n 2^-53 / (1 - n 2^-53) of it, and exactly that if all rungs are multiples of 2^-k
// and the rungs and their differences are below 2^(53-k). A rung that is NaN makes the parts of all steps up to the one after
// it NaN; one that is first or last makes all of them NaN.
// Throws std::logic_error if the sizes do not agree.
void lasting_steps(std::span<const double> rungs, std::span<double> parts);

}  // namespace noonmark
