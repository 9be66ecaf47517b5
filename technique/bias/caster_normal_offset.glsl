// The caster's vertex is moved against its normal by the same amount at every slope.
vec3 caster_normal_offset_way(Surface at) { return real(-1) * at.normal; }
