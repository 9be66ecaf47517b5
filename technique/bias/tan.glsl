// As steep as the surface is against the light. A map of texels of one size needs exactly this (law 1).
real tan_factor(Surface at) { return at.tan_theta; }
