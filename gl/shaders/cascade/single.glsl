// One map for all receivers.
bool in_this_map(vec3 position) { return true; }
