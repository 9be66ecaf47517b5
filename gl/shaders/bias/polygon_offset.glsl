// glPolygonOffset has moved what the map holds; the lookup subtracts nothing.
#include "shaders/bias/none.glsl"
