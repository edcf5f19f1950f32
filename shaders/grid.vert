#version 330 core
layout(location = 0) in vec3 position;  // the eye's axes
layout(location = 1) in vec2 in_plane;  // metres, from a line crossing of the grid
layout(location = 2) in vec2 from_center;  // 1: where it ends
uniform mat4 projection;
out vec2 meters;
out vec2 reach;
out vec3 eye_position;
void main() {
  meters = in_plane;
  reach = from_center;
  eye_position = position;
  gl_Position = projection * vec4(position, 1.0);
}
