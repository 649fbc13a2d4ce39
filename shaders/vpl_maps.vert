// One point for each VPL; vpl_maps.geom makes a tile of it.
flat out uint vpl_id;

void main() {
    vpl_id = uint(gl_VertexID);
    gl_Position = vec4(0.0);
}
