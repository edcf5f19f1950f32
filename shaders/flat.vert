#version 330 core
layout(location = 0) in vec3 position;  // the eye's axes
layout(location = 1) in vec4 color;
uniform mat4 projection;
flat out vec4 ink;
void main() {
  ink = color;
  gl_Position = projection * vec4(position * 0.999, 1.0);  // a little before the surface it lies on
}
