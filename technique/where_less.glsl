// yes if a < b, else no. The formulas that GLSL and C++ share choose with it, so that the host can also compile them with
// error bounds (technique/bounded.h: both choices where the errors leave the order open, else the bound of the one) and
// with counters. Unlike that of min(), its bound does not include the error of the value that is not chosen.
real where_less(real a, real b, real yes, real no) { return a < b ? yes : no; }
