#version 330 core
noperspective in vec2 place;
flat in float radius;
flat in vec4 ink;
flat in float rim;
uniform float opacity;
#ifdef IDS
out uvec2 result;  // object, triangle
#else
out vec4 result;
#endif
void main() {
  float d = length(place) - radius;
  float body = clamp(0.5 - d, 0.0, 1.0);
  float whole = clamp(0.5 + rim - d, 0.0, 1.0);
#ifdef IDS
  if (whole < 0.3) discard;  // hardly to be seen
  uvec4 bytes = uvec4(255.0 * ink + 0.5);
  result = uvec2(bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24, 0xffffffffu);
#else
  if (whole <= 0.0) discard;
  float edge = 0.9 * (whole - body);
  float alpha = body + edge;
  vec3 lit = ink.rgb * (0.92 + 0.10 * clamp((place.y - place.x) / max(radius, 1.0), -1.0, 1.0));
  result = vec4(mix(vec3(0.05, 0.06, 0.08), min(lit, 1.0), body / alpha), ink.a * alpha * opacity);
#endif
}
