// The caster's vertex is moved away from the light (URP's depth bias). On a plane this has the effect of a constant
// bias.
vec3 caster_offset_way(Surface at) { return real(-1) * at.to_light; }
