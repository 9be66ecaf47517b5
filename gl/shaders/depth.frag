#version 450 core
// The fragment shader for flat maps. It writes nothing, because OpenGL writes the depth itself.
void main() {}
