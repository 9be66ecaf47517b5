// Which cascade a receiver is looked up in. Each cascade is looked up in a pass of its own, which leaves out the receivers
// of the others. The file that includes this one has defined
//   float cascade_place(int cascade, vec3 position)   how far it lies in a cascade: at most 1 inside

uniform int this_cascade;
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

bool in_this_map(vec3 position) {
  CascadeChoice choice = choose_cascade(position);
  return choice.cascade == this_cascade ||
         ((choice.next > 0.0 || choice.at_seam) && choice.cascade + 1 == this_cascade);
}
