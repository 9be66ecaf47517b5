// Each tap is compared with the depth that the receiver's plane has at the centre of the tap's texel (Dou et al.,
// "Adaptive Depth Bias for Shadow Maps", 2014), which is what the map holds of that plane.
real texel_plane(TapPlace at) {
  precise real along = at.gradient.x * at.way.x;
  precise real across = at.gradient.y * at.way.y;
  precise real depth = at.reference + (along + across);
  return depth;
}
