#version 330 core
noperspective in vec2 place;
flat in float length_px;
flat in float width_px;
flat in vec4 ink;
uniform float head;
uniform float rim;
uniform float opacity;
#ifdef IDS
out uvec2 result;  // object, triangle
#else
out vec4 result;
#endif

float box(vec2 p, vec2 low, vec2 high) {
  vec2 d = abs(p - 0.5 * (low + high)) - 0.5 * (high - low);
  return length(max(d, 0.0)) + min(max(d.x, d.y), 0.0);
}

// distance to an arrow head that ends at x = tip
float triangle(vec2 p, float tip, float size, float half_width) {
  vec2 edge = normalize(vec2(half_width, size));
  return max(dot(vec2(p.x - tip, abs(p.y)), edge), tip - size - p.x);
}

void main() {
  float d;
  if (head > 0.0) {
    float size = min(4.2 * width_px, max(length_px, 1.5 * width_px));
    float half_width = 0.5 * size * 0.8;
    float neck = max(length_px - 0.8 * size, 0.0);
    d = min(box(place, vec2(0.0, -0.5 * width_px), vec2(neck, 0.5 * width_px)), triangle(place, max(length_px, size), size, half_width));
  } else {
    d = box(place, vec2(0.0, -0.5 * width_px), vec2(length_px, 0.5 * width_px));
  }
  float body = clamp(0.5 - d, 0.0, 1.0);
  float whole = clamp(0.5 + rim - d, 0.0, 1.0);
#ifdef IDS
  if (whole < 0.3) discard;  // hardly to be seen
  uvec4 bytes = uvec4(255.0 * ink + 0.5);
  result = uvec2(bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24, 0xffffffffu);
#else
  if (whole <= 0.0) discard;
  // a line thinner than a pixel fades instead of breaking up
  float thin = min(width_px, 1.0);
  float edge = 0.75 * (whole - body);
  float alpha = body + edge;
  result = vec4(mix(vec3(0.05, 0.06, 0.08), ink.rgb, body / alpha), ink.a * alpha * opacity * thin);
#endif
}
