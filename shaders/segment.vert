#version 330 core
// A line or an arrow as a quad in the picture's plane, wide enough for its soft edge.
layout(location = 0) in vec3 a;       // the eye's axes
layout(location = 1) in vec3 b;
layout(location = 2) in vec4 color;
layout(location = 3) in float width;  // pixels
uniform mat4 projection;
uniform vec2 picture;    // pixels
uniform float nearest;   // metres
uniform float head;      // 1: arrow, 0: line
uniform float rim;       // pixels of dark edge
noperspective out vec2 place;  // pixels along and across
flat out float length_px;
flat out float width_px;
flat out vec4 ink;

void main() {
  // a segment that runs behind the eye is cut where it leaves the view
  vec3 p = a, q = b;
  float limit = -1.01 * nearest;
  if (p.z > limit && q.z < limit) p = mix(p, q, (limit - p.z) / (q.z - p.z));
  else if (q.z > limit && p.z < limit) q = mix(q, p, (limit - q.z) / (p.z - q.z));
  bool gone = p.z > limit && q.z > limit;
  vec4 cp = projection * vec4(p * 0.9985, 1.0), cq = projection * vec4(q * 0.9985, 1.0);  // a little before what it lies on
  vec2 sp = 0.5 * picture * cp.xy / cp.w, sq = 0.5 * picture * cq.xy / cq.w;
  vec2 along = sq - sp;
  length_px = length(along);
  along = length_px > 1e-4 ? along / length_px : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  width_px = width;
  ink = color;
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  bool far_end = gl_VertexID >= 2;
  float reach = (head > 0.0 ? 2.2 * width : 0.5 * width) + rim + 1.0;
  vec4 c = far_end ? cq : cp;
  vec2 s = (far_end ? sq + along * reach : sp - along * reach) + across * side * reach;
  place = vec2(far_end ? length_px + reach : -reach, side * reach);
  gl_Position = gone ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(s / (0.5 * picture) * c.w, c.z, c.w);
}
