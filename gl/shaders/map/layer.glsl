// The map that the functions of light and map are about: its layer in the array of maps, and the index of its uniforms. The
// lookup sets it for each receiver.
int map_layer = 0;
const int most_layers = 8;  // the most maps of a point
