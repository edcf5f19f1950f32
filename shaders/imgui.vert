#version 330 core
layout(location = 0) in vec2 position;  // pixels from the top left
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
uniform vec2 picture;
out vec2 place;
out vec4 ink;
void main() {
  place = uv;
  ink = color;
  gl_Position = vec4(2.0 * position.x / picture.x - 1.0, 1.0 - 2.0 * position.y / picture.y, 0.0, 1.0);
}
