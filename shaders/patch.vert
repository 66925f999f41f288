#version 450 core
// A vertex is a piece; the tessellation stages look it up.
flat out uint vPiece;

void main() {
    vPiece = uint(gl_VertexID);
}
