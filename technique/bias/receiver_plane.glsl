// Each tap is compared with the depth that the receiver's plane has where the tap lies (Isidoro, "Shadow Mapping: GPU-
// based Tips and Techniques", GDC 2006); what the grid needs on top is bias.constant's. A cap keeps steep planes from
// asking far away from their receiver.
real receiver_plane(TapPlace at) {
  precise real along = at.gradient.x * at.way.x;
  precise real across = at.gradient.y * at.way.y;
  precise real rise = clamp(along + across, -at.cap, at.cap);
  precise real depth = at.reference + rise;
  return depth;
}
