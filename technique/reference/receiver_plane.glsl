// Each tap is compared with the depth of the receiver's plane at the tap's exact place (Isidoro, "Shadow Mapping:
// GPU-based Tips and Techniques", GDC 2006). bias.constant must add what the grid of texels needs. A cap limits the
// depth on steep planes, so that it stays near the receiver's own depth.
real receiver_plane(TapPlace at) {
  precise real along = at.gradient.x * at.way.x;
  precise real across = at.gradient.y * at.way.y;
  precise real rise = clamp(along + across, -at.cap, at.cap);
  precise real depth = at.reference + rise;
  return depth;
}
