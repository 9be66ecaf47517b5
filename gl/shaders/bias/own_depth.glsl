// For bias forms that compare every tap with the receiver's own depth.
float tap_depth(Receiver receiver, vec3 offset, MapAddress at) { return receiver.reference; }
