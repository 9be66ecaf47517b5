// How far a point lies in a cascade: at most 1 inside, and 1 where the cascade ends. GLSL and C++ compile this file.

// By the depth along the view. from, to: the depths at which the place is 0 and 1.
real place_by_depth(vec3 position, vec3 eye, vec3 forward, real from, real to) {
  precise vec3 way = position - eye;
  precise real depth = dot(way, forward);
  precise real place = (depth - from) / (to - from);
  return place;
}

// By the place in the map. middle: of the map's volume, in the world. right, up, forward: the light's axes. half_size: the
// map's half width and half height, within which all taps of a lookup lie in the map, and half its depth.
real place_by_map(vec3 position, vec3 middle, vec3 right, vec3 up, vec3 forward, vec3 half_size) {
  precise vec3 way = position - middle;
  precise real across = abs(dot(way, right)) / half_size.x;
  precise real along = abs(dot(way, up)) / half_size.y;
  precise real behind = dot(way, forward) / half_size.z;
  return max(max(across, along), behind);
}

// By the distance from the middle of a sphere.
real place_by_sphere(vec3 position, vec3 middle, real radius) {
  precise vec3 way = position - middle;
  precise real place = sqrt(dot(way, way)) / radius;
  return place;
}

// How far a place lies in the band in which the next cascade is blended in: 0 where it begins, 1 where the cascade ends.
// blend: the part of the cascade that the band is.
real way_into_band(real place, real blend) {
  precise real way = (place - (real(1) - blend)) / blend;
  return clamp(way, real(0), real(1));
}
