#version 330 core
in vec2 place;
uniform vec3 top;
uniform vec3 bottom;
out vec4 result;
void main() {
  float t = smoothstep(0.0, 1.0, place.y);
  result = vec4(mix(bottom, top, t), 1.0);
}
