// The bias grows with the tangent of the slope. A map with texels of one size needs exactly this (law 1).
real tan_factor(Surface at) { return at.tan_theta; }
