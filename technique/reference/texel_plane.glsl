// Each tap is compared with the depth of the receiver's plane at the centre of the tap's texel (Dou et al., "Adaptive
// Depth Bias for Shadow Maps", 2014). The map stores the depth of that plane at the same point.
real texel_plane(TapPlace at) {
  precise real along = at.gradient.x * at.way.x;
  precise real across = at.gradient.y * at.way.y;
  precise real depth = at.reference + (along + across);
  return depth;
}
