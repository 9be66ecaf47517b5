// The maps that a receiver is looked up in: its own, and of several the next one too where that is blended in or compared.
struct Lookups {
  ivec2 layers;  // of both; -1: that map is in another array
  int count;     // 1 or 2
};
