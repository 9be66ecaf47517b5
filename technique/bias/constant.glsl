// The bias is the same everywhere (Williams 1978).
real constant_factor(Surface at) { return real(1); }
