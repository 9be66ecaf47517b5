// The same bias everywhere (Williams 1978).
real constant_factor(Surface at) { return real(1); }
