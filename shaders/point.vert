#version 330 core
layout(location = 0) in vec3 position;   // the eye's axes
layout(location = 1) in vec4 color;
layout(location = 2) in float diameter;  // pixels
layout(location = 3) in float edge;      // of the dark rim, pixels
uniform mat4 projection;
uniform vec2 picture;
noperspective out vec2 place;  // pixels from the middle
flat out float radius;
flat out vec4 ink;
flat out float rim;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, gl_VertexID < 2 ? -1.0 : 1.0);
  radius = 0.5 * diameter;
  ink = color;
  rim = edge;
  place = corner * (radius + rim + 1.0);
  vec4 c = projection * vec4(position * 0.9985, 1.0);
  gl_Position = vec4(c.xy + place / (0.5 * picture) * c.w, c.zw);
}
