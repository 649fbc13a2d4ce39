// Position of the centre of a target's pixel in a picture that has fewer pixels, in its pixels, from the centre of the
// first one. The weights of enlarge_weights.frag are of the pixels at its floor, then of that to the right, and of those
// above. `precise`, as both shaders have to find the same floor.
vec2 picture_position(vec2 pixel, vec2 target_size, vec2 picture_size) {
    precise vec2 at = pixel / target_size * picture_size - 0.5;
    return at;
}
