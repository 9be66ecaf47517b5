// Which cascades a receiver is looked up in. The file that includes this one has defined
//   float cascade_place(int cascade, vec3 position)   how far it lies in a cascade: at most 1 inside

#include <blend>
#include "shaders/cascade/lookups.glsl"
#include "shaders/map/layer.glsl"
uniform int layer_of_cascade[most_layers];  // in the array that is looked up; -1: in another one
uniform int last_cascade;     // it takes what lies in no other
uniform float cascade_blend;  // 0: no cascade blends into the next
uniform float cascade_seam;   // from this place on the next cascade is looked up too, for comparison; 1: nowhere

struct CascadeChoice {
  int cascade;
  float next;    // the weight of the cascade after it, 0 to 1
  bool at_seam;  // the cascade after it is looked up too
};

CascadeChoice choose_cascade(vec3 position) {
  for (int k = 0; k < last_cascade; ++k) {
    precise float place = cascade_place(k, position);
    if (place <= 1.0)
      return CascadeChoice(k, cascade_blend > 0.0 ? weight_of_next(place, cascade_blend) : 0.0, place > cascade_seam);
  }
  return CascadeChoice(last_cascade, 0.0, false);
}

Lookups lookups_of(vec3 position) {
  CascadeChoice choice = choose_cascade(position);
  bool both = choice.next > 0.0 || choice.at_seam;
  return Lookups(ivec2(layer_of_cascade[choice.cascade], both ? layer_of_cascade[choice.cascade + 1] : -1),
                 both ? 2 : 1);
}
