#version 330 core
flat in vec4 ink;
uniform float opacity;
#ifdef IDS
out uvec2 result;  // object, triangle
#else
out vec4 result;
#endif
void main() {
#ifdef IDS
  uvec4 bytes = uvec4(255.0 * ink + 0.5);
  result = uvec2(bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24, 0xffffffffu);
#else
  result = vec4(ink.rgb, ink.a * opacity);
#endif
}
