// One point for each VPL; vpl_maps.geom turns it into the square of the VPL's slot.
flat out uint vpl_id;

void main() {
    vpl_id = uint(gl_VertexID);
    gl_Position = vec4(0.0);
}
