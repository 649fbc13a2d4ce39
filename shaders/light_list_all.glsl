// The list of all lights: every pixel evaluates every light and every VPL.

uint light_list_size(uint light_count) { return light_count; }
uint light_list_entry(uint i) { return i; }
uint vpl_list_size(uint vpl_count) { return vpl_count; }
uint vpl_list_entry(uint i) { return i; }
