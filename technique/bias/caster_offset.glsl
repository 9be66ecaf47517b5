// The caster's vertex is moved away from the light (URP's depth bias). On a plane it gains what a constant bias gains.
vec3 caster_offset_way(Surface at) { return real(-1) * at.to_light; }
