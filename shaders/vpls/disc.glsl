// Light from a small disc that emits diffusely, evenly over its area.

// Tilt of a receiver against a disc: 0 where it faces the disc, 1 where it is perpendicular to it or turned away.
float tilt_of(vec3 normal, vec3 from_normal) { return 1.0 - max(-dot(normal, from_normal), 0.0); }

// π / A times the form factor of a disc of area A = π R², seen from a receiver `height` above the disc's plane;
// `to_disc` is the vector from the receiver to the disc's centre, r its length. With q = `tilt`, the disc is seen
// as if it had sunk by q R² / √(R² + r²) below its surface, and the term is cos θ cos θ' / (r'² + (1 - q) R²), r' being
// the distance to the sunk centre. Exact on the axis of a facing disc; at most 4/3 of 1/R². See README.md, "The sinking
// disc".
float sinking_disc_term(vec3 to_disc, float height, vec3 normal, float radius2, float tilt, vec3 from_normal) {
    float depth = tilt * radius2 * inversesqrt(radius2 + max(dot(to_disc, to_disc), 1e-12));
    vec3 to_sunk = to_disc - depth * normal;
    float distance2 = max(dot(to_sunk, to_sunk), 1e-12);
    float cos_receiver = max(dot(from_normal, to_sunk), 0.0);
    return cos_receiver * (height + depth) / (distance2 * (distance2 + (1.0 - tilt) * radius2));
}

// The same for a disc whose surface continues around it, so that a perpendicular receiver may touch that surface.
float disc_term(vec3 position, vec3 normal, float radius2, vec3 from, vec3 from_normal) {
    vec3 to_disc = position - from;
    float height = -dot(normal, to_disc);
    if (height < 0.0) return 0.0;
    return sinking_disc_term(to_disc, height, normal, radius2, tilt_of(normal, from_normal), from_normal);
}

// Whether a cell of that squared width is nearer than three times its width. Its points are then evaluated one by one.
bool is_near(vec3 apart, float width2) { return dot(apart, apart) < 9.0 * width2; }
