#version 330 core
// Light from above and below, a key light over the viewer's left shoulder, a rim. No pow: its bits differ among processors.
in vec3 eye_position;
in vec3 eye_normal;
in vec3 local_position;
in float local_heat;
uniform vec4 color;      // sRGB
uniform vec3 eye_up;     // the world's up in the eye's axes
uniform vec4 stripes;    // colour and, in w, bands a metre; 0: none
uniform float outline_only;  // 1: see-through
uniform float heated;        // 1: colours show a quantity
uniform vec3 heat_colors[33];
uniform float cut;           // 1: by the clip plane
uniform vec4 clip;           // in the eye's axes: normal, and how high the eye is over the plane
uniform vec4 cut_edge;       // colour and width of the line along the cut, pixels
#ifdef IDS
out uvec2 result;  // object, triangle
#else
out vec4 result;
#endif

void main() {
  float on_edge = 0.0;
  if (cut > 0.0) {
    float height = dot(clip.xyz, eye_position) + clip.w;
    float pixel = max(length(vec2(dFdx(height), dFdy(height))), 1e-9);
    if (height > 0.0) discard;
    if (outline_only == 0.0) on_edge = clamp(cut_edge.w + 0.5 + height / pixel, 0.0, 1.0);
  }
#ifdef IDS
  uvec4 bytes = uvec4(255.0 * color + 0.5);
  result = uvec2(bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24, uint(gl_PrimitiveID));
#else
  vec3 view = normalize(-eye_position);
  vec3 n = normalize(eye_normal);
  bool inside = dot(n, view) < 0.0 && !gl_FrontFacing;
  if (!gl_FrontFacing) n = -n;
  vec3 base = color.rgb;
  if (heated > 0.0) {
    float place = clamp(local_heat, 0.0, 1.0) * 32.0;
    int below = min(int(place), 31);
    base = mix(heat_colors[below], heat_colors[below + 1], place - float(below));
  }
  base *= base;  // about linear
  if (stripes.w > 0.0) {
    float t = (local_position.x + local_position.y + local_position.z) * stripes.w;
    float w = max(fwidth(t), 1e-6);
    float band = clamp((abs(fract(t) - 0.5) - 0.34) / w + 0.5, 0.0, 1.0);
    base = mix(base, stripes.rgb * stripes.rgb, band);
  }
  vec3 key_direction = normalize(vec3(-0.42, 0.62, 0.66));
  float sky = 0.5 + 0.5 * dot(n, eye_up);
  vec3 light = mix(vec3(0.16, 0.155, 0.17), vec3(0.50, 0.53, 0.58), sky);
  float key = max(dot(n, key_direction), 0.0);
  light += vec3(0.78, 0.75, 0.70) * key;
  vec3 half_way = normalize(key_direction + view);
  float s = max(dot(n, half_way), 0.0);
  s *= s; s *= s; s *= s; s *= s; s *= s;  // to the 32nd
  float f = 1.0 - max(dot(n, view), 0.0);
  float rim = f * f * f;
  float gloss = 1.0;
  if (heated > 0.0) {  // less light and shade, so that colours can be read
    light = mix(vec3(1.0), light, 0.35);
    gloss = 0.25;
  }
  if (inside) {  // backs are duller and darker than any front
    if (heated == 0.0) base = mix(base, vec3(0.10, 0.09, 0.12), 0.55);
    light *= heated > 0.0 ? 0.85 : 0.7;
    gloss = 0.0;
  }
  vec3 c = base * light + gloss * (vec3(0.10) * s + vec3(0.10, 0.12, 0.15) * rim * sky);
  c = c / (1.0 + 0.12 * c);
  float alpha = mix(color.a, 0.05 + 0.10 * rim, outline_only);
  result = vec4(mix(sqrt(clamp(c, 0.0, 1.0)), cut_edge.rgb, on_edge), alpha);
#endif
}
