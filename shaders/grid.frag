#version 330 core
// A floor: matt, with a fine and a coarse grid, fading out well before it ends.
in vec2 meters;
in vec2 reach;
in vec3 eye_position;
uniform float cell;    // metres; every fifth line is stronger
uniform vec4 color;
uniform float pixel_scale;  // widths of lines are for pictures 720 high
#ifdef IDS
out uvec2 result;  // object, triangle
#else
out vec4 result;
#endif

float lines(vec2 p, float size, float width) {
  vec2 t = p / size, w = max(fwidth(t), 1e-6);
  vec2 d = abs(fract(t - 0.5) - 0.5) / w;  // pixels from the nearest line
  vec2 line = clamp(0.5 * width + 0.5 - d, 0.0, 1.0) * clamp(0.35 / w - 0.6, 0.0, 1.0);  // gone before they run together
  return max(line.x, line.y);
}

void main() {
  float r = length(reach);
  float fade = 1.0 - smoothstep(0.35, 1.0, r);
#ifdef IDS
  if (fade < 0.15) discard;  // hardly to be seen
  uvec4 bytes = uvec4(255.0 * color + 0.5);
  result = uvec2(bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24, 0xffffffffu);
#else
  if (fade <= 0.004) discard;
  float fine = lines(meters, cell, pixel_scale), coarse = lines(meters, 5.0 * cell, 1.4 * pixel_scale);
  vec3 c = color.rgb * (1.0 + 0.10 * (1.0 - r));
  vec3 ink = color.g > 0.5 ? vec3(0.25, 0.29, 0.35) : vec3(0.78, 0.82, 0.88);
  c = mix(c, ink, max(0.13 * fine, 0.26 * coarse));
  result = vec4(c, color.a * fade);
#endif
}
