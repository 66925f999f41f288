#version 450 core
// One sample of the visibility buffer: the patch and its parameters there, to 1/65535 of the domain; the
// resolve pass makes them exact.
flat in uint fPatch;
in vec2 fParameters;
layout(location = 0) out uvec2 visible;

void main() {
    visible = uvec2(fPatch, packUnorm2x16(fParameters));
}
