// Colours of heat maps, from the least value to the greatest, evenly spaced and interpolated in between: viridis (van
// der Walt and Smith, "A Better Default Colormap for Matplotlib", 2015). sRGB-encoded. Shared by GLSL and C++.
#define HEAT_COLOUR_COUNT 9
#define HEAT_COLOURS \
    vec3(0.267, 0.004, 0.329), vec3(0.278, 0.176, 0.482), vec3(0.231, 0.322, 0.545), \
    vec3(0.173, 0.447, 0.557), vec3(0.129, 0.569, 0.549), vec3(0.157, 0.682, 0.502), \
    vec3(0.369, 0.788, 0.384), vec3(0.678, 0.863, 0.188), vec3(0.992, 0.906, 0.145)
