#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float heat;
uniform mat4 model_view;   // to the eye's axes
uniform mat4 projection;
out vec3 eye_position;
out vec3 eye_normal;
out vec3 local_position;
out float local_heat;
void main() {
  vec4 p = model_view * vec4(position, 1.0);
  eye_position = p.xyz;
  eye_normal = mat3(model_view) * normal;
  local_position = position;
  local_heat = heat;
  gl_Position = projection * p;
}
