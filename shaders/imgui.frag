#version 330 core
in vec2 place;
in vec4 ink;
uniform sampler2D atlas;
out vec4 result;
void main() { result = ink * texture(atlas, place); }
