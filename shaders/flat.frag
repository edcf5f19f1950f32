#version 330 core
flat in vec4 ink;
uniform float opacity;
out vec4 result;
void main() { result = vec4(ink.rgb, ink.a * opacity); }
