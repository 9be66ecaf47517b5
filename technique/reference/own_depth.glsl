// Every tap is compared with the receiver's own depth.
real own_depth(TapPlace at) { return at.reference; }
